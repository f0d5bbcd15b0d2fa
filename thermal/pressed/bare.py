"""What a bare sensor's face, which is rigid, and the pad around it touch of a mesh.

Faces of lapped alumina do not sink in. A mesh's crests lie on it: what of them is within the faces' roughness of the
highest touches, on springs as stiff as a column of alumina. Spots conduct there and constrict the heat where they are
small; gas conducts beside them over the gap, place by place. One patch of even conductance stands for both, as it does
under a ball (thermal/contact/spread.py).

Under a crest the rigid face bears nearly all of the force. A flat face meets it flush with the pad, whose springs are
then taken as the same all over, as they are for boxes (thermal/contact/area.py). In between, the share that touches of
what the mesh covers of the face tells how flat that is.
"""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit

from ..contact import (
    FIRST_FORCE,
    FORCE_STEP,
    FORCES,
    PLACES,
    Pad,
    Surface,
    bared,
    beneath,
    rigid_face,
    solid_conduction,
    touching,
)
from ..matter import Material
from .height_map import HeightMap, map_heights
from .lying import lie
from .springs import Ring, between_forces, borne, loads, lowered, on_face, rises, springs


def pressed_bare(
    pad: Pad,
    body: Material,
    seen: HeightMap,
    begin: np.ndarray,
    places: np.ndarray,
    spans: np.ndarray,
    ring: Ring | None,
) -> np.ndarray:
    """(FORCES, PLACES, PLACES, 7) of a pad without a skin. Of the sensor's face: W/K, m2 of the patch that stands for
    what conducts, its length m and its shares, as PressedView.touched tells them; of a ring around it: m2 that touch,
    and their share of the force. seen, begin, places, spans: as PressedView has them."""
    touched = np.zeros((FORCES, PLACES, PLACES, 7))
    law = rigid_face(pad, Surface.of(body))
    spots, resistance = law.copy(), beneath(body, touching(None))
    spots["constriction"] = 0.0
    forces = np.exp(FIRST_FORCE + FORCE_STEP * np.arange(FORCES))
    laws = law, spots, resistance, ring is None
    some = springs(bared(pad), ring), on_face(pad, ring), loads(pad), forces
    _press(*seen, begin, places, spans, pad.face, *some[0], *some[1:], *laws, touched)
    return touched


@njit(cache=True, error_model="numpy")
def _press(
    axes, corner, height, pitch, begin, places, spans, face, points, areas, stiffness, counted, span, loads, forces,
    law, spots, resistance, of_face, touched,
):  # fmt: skip
    """Fills touched. span: from which of the points up to which are on the face; of_face: whether they are looked
    at, or those of a ring. loads: m3, forces N over the stiffness of springs around the face. law, spots: of rigid_face
    with its constriction and without. resistance: m2 K/W of both bodies."""
    frame = np.zeros((4, 3))
    frame[1:] = axes
    heights, cover = np.zeros(len(points)), np.zeros(len(points))
    slopes, touching, even = np.zeros(counted), np.zeros(counted), np.ones(len(points))
    begun = 1 if of_face else 0  # a face touches nothing at the ends
    for a in range(begun, places.shape[1] - begun):
        for b in range(begun, places.shape[1] - begun):
            at = touched[:, a, b]
            for k in range(3):
                frame[0, k] = (begin[0] + places[0, a]) * axes[1, k] + (begin[1] + places[1, b]) * axes[2, k]
            map_heights(axes, corner, height, pitch, frame, points, heights, cover)
            cover *= areas
            if cover[:counted].max() == 0.0:
                continue
            lowered(heights, cover)
            for i in range(len(points)):
                heights[i] = max(heights[i] - law.roughness, 0.0)
            rises(heights, cover, slopes)
            for n in range(0, len(loads), 2):
                _, _, soft = borne(heights, cover, even, slopes, loads[n], touching)
                depth, area, share = borne(heights, cover, stiffness, slopes, loads[n], touching)
                share += _flat(heights, cover, depth, span) * (soft - share)
                if of_face:
                    row = at[n]
                    lie(points, touching, areas[0], places[0, a], places[1, b], spans, face, row)
                    _conduct(
                        heights,
                        cover,
                        depth,
                        area,
                        share * forces[n],
                        face,
                        law,
                        spots,
                        resistance,
                        touching,
                        row,
                    )
                    lie(points, touching, areas[0], places[0, a], places[1, b], spans, face, row)
                else:
                    at[n, 0], at[n, 1] = area, share
            between_forces(at)


@njit(cache=True, error_model="numpy")
def _flat(heights, cover, depth, span):
    """The share that touches of what the mesh covers of the face."""
    touches, covered = 0.0, 0.0
    for i in range(span[0], span[1]):
        covered += cover[i]
        if heights[i] < depth:
            touches += cover[i]
    return touches / covered if covered > 0.0 else 0.0


@njit(cache=True, error_model="numpy")
def _conduct(heights, cover, depth, area, load, face, law, spots, resistance, touching, row):
    """Writes W/K and m2 of the patch that stands for what conducts to row[:2]; makes of touching (C,), m2, what of the
    patch lies at each point. row[2]: m, the contact's length. load: N on the face."""
    solid = solid_conduction(spots, area, load)
    if area > 0.0:
        slim = min(area / row[2] ** 2, row[2] ** 2 / area)  # a line does not constrict as a disc does
        solid += slim * (solid_conduction(law, area, load) - solid)
    gas, less = 0.0, 0.0
    for i in range(len(touching)):
        gap, beside = law.mean_gap + max(heights[i] - depth, 0.0), max(cover[i] - touching[i], 0.0)
        conducts = law.gas * beside / gap if law.mean_gap > 0.0 else 0.0
        less += law.gas * beside / (gap + law.gas * resistance) if law.mean_gap > 0.0 else 0.0
        gas += conducts
        touching[i] = conducts + (solid / area * touching[i] if area > 0.0 else 0.0)
    total, patch = solid + gas, area
    if gas > 0.0:
        rest = max(face * face - area, 0.0)
        spread = min(gas * less * resistance / (gas - less), rest) if gas > less else rest
        around = gas + law.gas / law.mean_gap * area  # what would flow there without force is spread as wide
        patch += spread * min(around / total, 1.0)
    row[0], row[1] = total, patch
    for i in range(len(touching)):
        touching[i] *= patch / total if total > 0.0 else 0.0
