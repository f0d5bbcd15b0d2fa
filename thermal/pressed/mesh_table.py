"""What a pad touches of a mesh that it meets along one direction, as a table over force and place.

The mesh sinks into the pad's elastic foundation (thermal/contact/area.py) along that direction, without a tilt, until
the springs under it take the force. Area counts where there is pressure and the mesh covers the face: the crests of a
thread, the teeth of a gear, a face up to its edge. Its length tells a strip from a square, in which heat is more
constricted, and so it is at the ends of the face and of the mesh, which ends where its outline does. The tables are
those of curved bodies (thermal/contact/curved_table.py): W/K, m2 and m at FORCES and at places of the pad's middle,
whose sides lie along the mesh's. Places are counted from where the face begins to meet the mesh, so that they are never
below 0."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from thermograsp.compiled import njit

from ..contact import (
    CURVED_TABLE,
    FIRST_FORCE,
    FORCE_STEP,
    FORCES,
    PLACES,
    Joint,
    Pad,
    bared,
    begin_contacts,
    conductance,
    even_places,
    flat_law,
    skinned,
    table_values,
)
from ..matter import Material, Skin
from .bare import pressed_bare
from .height_map import HeightMap, height_map, map_heights
from .lying import end, lie
from .rounded import corner_normals
from .springs import Ring, borne, loads, lowered, rises, springs, touching_joint

_FINE = 97  # places, among which those of a table are chosen
_USUAL = slice(4, 11)  # of the forces, 0.5 to 53 N
_UNFELT = 1e-3  # of the most that can be felt
_HALF_FELT = 0.4  # W/K, about
_BARE = 0.09  # W/K on a newton of force on the face, and
_SKINNED = 2e5  # on a m2, about
_NEAR_CROWN = (0.35, 0.65, 0.85, 1.0)  # of half the face, and
_NEAR_EDGE = (0.0, 0.35, 0.65, 0.9, 1.15, 1.4)  # of half the face


@dataclass(frozen=True, slots=True)
class PressedMesh:
    """A fingertip on a mesh from one side. pad: its silicone; skin: over it, None for none. body: the mesh's material.
    vertices (n, 3) m and triangles (m, 3) of int64, as bytes; axes: (3, 3), as bytes, of which the first is the
    direction from outside inwards. ring: of the pad, whose contact it is then, without a place in it; None for the
    sensor's face."""

    pad: Pad
    skin: Skin | None
    body: Material
    vertices: bytes
    faces: bytes
    axes: bytes
    ring: Ring | None = None

    def table(self) -> np.ndarray:
        """(CURVED_TABLE,)."""
        sheet = skinned(self.pad, self.skin)
        view = pressed_view(sheet, self.vertices, self.faces, self.axes)
        if self.skin is None:
            touched = view.touched_bare(self.body, self.ring)
        else:
            touched = view.touched(ring=self.ring)
        if self.ring is None:
            end(touched[..., :4], touched[..., 4 : 5 if self.skin else 6])
            if self.skin is None:
                values = np.concatenate((touched[..., 6:], touched[..., 4:6]), axis=-1)
                return filled(view.places, values, touched[..., :4])
        return conducting(sheet, touching_joint(self.skin, self.body, self.ring), view.places, touched)


@dataclass(frozen=True, slots=True, eq=False)
class PressedView:
    """What a pad touches of a mesh along one direction. places: (2, PLACES) m of the pad's middle along the two axes
    across the direction, from where the face begins to meet the mesh. pad: with its skin's springs. seen: the mesh in
    that direction. begin: (2,) m, of the places. spans: (2,) m, of the places."""

    places: np.ndarray
    pad: Pad
    seen: HeightMap
    begin: np.ndarray
    spans: np.ndarray

    def touched(
        self,
        rows: tuple[int, int] = (0, PLACES),
        columns: tuple[int, int] = (0, PLACES),
        ring: Ring | None = None,
    ) -> np.ndarray:
        """(FORCES, rows, columns, 7) at the places from one up to another: the shares by which the contact lies at an
        end of the face along both axes, and of the mesh (thermal/contact/patch_place.py), m, the length along the
        second axis of a rectangle of the contact's area that is as long to broad as the contact, m2 of the face in
        contact, and its share of the force. Only areas and shares of the force mean anything at the first and last
        place, where nothing is touched. ring: what lies around the face in its place, whose areas and shares of the
        force alone are told, also where the face touches nothing."""
        touched = np.zeros((FORCES, rows[1] - rows[0], columns[1] - columns[0], 7))
        where = *self.seen, self.begin, self.places, np.array([rows, columns])
        lies = self.spans, self.pad.face, ring is None
        _press(*where, *springs(self.pad, ring), loads(self.pad), *lies, touched)
        return touched

    def touched_bare(
        self,
        body: Material,
        ring: Ring | None = None,
        rows: tuple[int, int] = (0, PLACES),
        columns: tuple[int, int] = (0, PLACES),
    ) -> np.ndarray:
        """(..., 10) of a pad without a skin, whose face is rigid, on a mesh of that material: the same shares, and what
        tables of curved bodies tell of the contact and the gas. Of a ring as `touched` tells it."""
        where = self.seen, self.begin, self.places, self.spans
        return pressed_bare(self.pad, body, *where, ring, rows, columns)


@lru_cache(maxsize=256)
def pressed_view(
    pad: Pad, vertices: bytes, faces: bytes, axes: bytes, *, rounded: bool = True
) -> PressedView:
    """The view of a PressedMesh, with a pad that has its skin's springs. rounded: where triangles that meet look nearly
    alike the surface is smooth, and not made of flat ones."""
    corners = np.frombuffer(vertices).reshape(-1, 3)
    triangles, normals = np.frombuffer(faces, np.int64).reshape(-1, 3), None
    if rounded:
        normals = corner_normals(vertices, faces)
    seen = height_map(corners, triangles, np.frombuffer(axes).reshape(3, 3), normals)
    across = corners @ seen.axes[1:].T
    low, high = across.min(axis=0) - pad.face / 2, across.max(axis=0) + pad.face / 2
    if not rounded:
        places = np.stack([_places(pad.face, float(span)) for span in high - low])
    else:
        fine = np.stack([_fine(pad, span) for span in (high - low).tolist()])
        sheet = bared(pad) if pad.face_stiffness is None else pad
        places = _bent(PressedView(fine, sheet, seen, low, high - low))
    places.flags.writeable = False
    return PressedView(places, pad, seen, low, high - low)


def _places(face: float, span: float) -> np.ndarray:
    """(PLACES,) m up to the span: close together where a crown in the mesh's middle comes to the face's edge, and those
    where a straight edge of the mesh begins and ceases to cross the face."""
    crown = [span / 2 + way * near * face / 2 for near in _NEAR_EDGE for way in (-1, 1)]
    return even_places(0.0, span, (face, span - face, *crown))


def _fine(pad: Pad, span: float) -> np.ndarray:
    """(_FINE,) m up to the span, symmetric: half of them where a crown in the mesh's middle is under the pad, and where
    the face begins and ceases to be wholly over the mesh among them."""
    half = min(pad.width / 2, span / 2)
    near = span / 2 + np.linspace(-half, half, _FINE // 2 + 2)[1:-1]
    return np.sort(
        np.concatenate((np.linspace(0.0, span, _FINE // 2 - 1), near, (pad.face, span - pad.face)))
    )


def _bent(view: PressedView) -> np.ndarray:
    """(2, PLACES) m, in pairs about the middle, of a view with _FINE places: where the face begins and ceases to be
    wholly over a mesh that touches it there, or to touch a crown in the middle, and then where what is felt of it, along
    the middle, is furthest from what a table would tell with those that there are."""
    found, middle = np.empty((2, PLACES)), (_FINE // 2, _FINE // 2 + 1)
    for axis in range(2):
        fine, span, every = view.places[axis], float(view.spans[axis]), (0, _FINE)
        some = (every, middle) if axis == 0 else (middle, every)
        signed = _signed(view, view.touched(*some))
        felt = _felt(signed)
        face, half = view.pad.face, view.pad.face / 2
        crown = [span / 2 + way * near * half for near in _NEAR_CROWN for way in (-1, 1)]
        ends = [each for each in (face, span - face, *crown) if 0 < each < span]
        touching = np.max([np.interp(ends, fine, row) for row in felt], axis=0) > 0
        chosen = {0.0, span / 2, span, *np.array(ends)[touching].tolist()}
        while len(chosen) < PLACES - 1:
            at = np.sort(list(chosen))
            told = [_felt(np.interp(fine, at, np.interp(at, fine, row))) for row in signed]
            off = np.abs(told - felt).max(axis=0)
            both = np.maximum(off, off[::-1])
            most = int(np.argmax(both))
            if both[most] < _UNFELT:
                break
            chosen |= {float(fine[most]), float(span - fine[most])}
        found[axis] = even_places(0.0, span, chosen)
    return found


def _signed(view: PressedView, touched: np.ndarray) -> np.ndarray:
    """(usual forces, places): about what contacts conduct over _HALF_FELT, W/K, as a table has it."""
    forces = np.exp(FIRST_FORCE + FORCE_STEP * np.arange(FORCES))[:, None, None]
    values = np.zeros((*touched.shape[:3], 6))
    bare = view.pad.face_stiffness == bared(view.pad).face_stiffness
    values[..., 0] = touched[..., 6] * forces * _BARE if bare else touched[..., 5] * _SKINNED
    begin_contacts(values)
    return values[_USUAL, ..., 0].reshape(-1, _FINE) / _HALF_FELT


def _felt(conducts: np.ndarray) -> np.ndarray:
    """The share of the most that can be felt."""
    return np.maximum(conducts, 0.0) / (1.0 + np.maximum(conducts, 0.0))


def conducting(pad: Pad, faces: Joint, places: np.ndarray, touched: np.ndarray) -> np.ndarray:
    """(CURVED_TABLE,) of what is touched (FORCES, PLACES, PLACES, 7), as PressedView tells it, at places (2, PLACES) m.
    pad: with its skin's springs."""
    forces = np.exp(FIRST_FORCE + FORCE_STEP * np.arange(FORCES))
    values = np.zeros((*touched.shape[:3], 6))
    _conduct(flat_law(pad, faces, (pad.width, pad.width)), forces, touched, values)
    return filled(places, values, touched[..., :4])


def filled(places: np.ndarray, values: np.ndarray, shares: np.ndarray) -> np.ndarray:
    """(CURVED_TABLE,) of these places (2, PLACES) m, and by force and place values and shares, as table_values tells
    them."""
    table = np.empty(CURVED_TABLE)
    table[: 2 * PLACES] = places.ravel()
    of_values, of_shares = table_values(table)
    of_values[:], of_shares[:] = values, shares
    table[-1] = begin_contacts(of_values)
    table.flags.writeable = False
    return table


@njit(cache=True, error_model="numpy")
def _press(
    axes, corner, height, pitch, begin, places, some, points, areas, stiffness, counted, loads, spans, face, on_face,
    touched,
):  # fmt: skip
    """Fills touched, some of the places: (2, 2) from which to before which. counted: how many points are looked at, and
    on_face: whether they are the face's. loads: m3, forces over the stiffness of springs around the face. spans: (2,) m
    of places, the mesh's outline and the face's side."""
    frame = np.zeros((4, 3))
    frame[1:] = axes
    heights, cover = np.zeros(len(points)), np.zeros(len(points))
    slopes, touching = np.zeros(counted), np.zeros(counted)
    begun = 1 if on_face else 0  # a face touches nothing at the ends
    last = places.shape[1] - begun
    for a in range(max(some[0, 0], begun), min(some[0, 1], last)):
        for b in range(max(some[1, 0], begun), min(some[1, 1], last)):
            at = touched[:, a - some[0, 0], b - some[1, 0]]
            for k in range(3):
                frame[0, k] = (begin[0] + places[0, a]) * axes[1, k] + (begin[1] + places[1, b]) * axes[2, k]
            map_heights(axes, corner, height, pitch, frame, points, heights, cover)
            cover *= areas
            lowered(heights, cover)
            if cover[:counted].max() == 0.0:
                continue
            rises(heights, cover, slopes)
            depth = np.inf
            for n in range(len(loads) - 1, -1, -1):
                depth, at[n, 5], at[n, 6] = borne(
                    heights, cover, stiffness, slopes, loads[n], depth, touching
                )
                if on_face:
                    lie(points, touching, areas[0], places[0, a], places[1, b], spans, face, 0.0, at[n])


@njit(cache=True, error_model="numpy")
def _conduct(law, forces, touched, values):
    for n in range(touched.shape[0]):
        for a in range(touched.shape[1]):
            for b in range(touched.shape[2]):
                long, area = touched[n, a, b, 4], touched[n, a, b, 5]
                load, at = touched[n, a, b, 6] * forces[n], values[n, a, b]
                at[0] = conductance(law, load / area) * area if load > 0.0 else 0.0
                at[2], at[4] = area, long
