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
    FOOTPRINT_LAW,
    FORCE_STEP,
    FORCES,
    PLACES,
    Joint,
    Pad,
    Surface,
    bared,
    begin_contacts,
    beneath,
    conductance,
    even_places,
    face_footprint,
    flat_law,
    skinned,
    table_values,
    touching,
)
from ..matter import Material, Skin, material
from .face import Seen, conducted, pressed
from .height_map import HeightMap, height_map
from .lying import end
from .rounded import corner_normals
from .springs import Ring, touching_joint

_ALL = ((0, PLACES), (0, PLACES))
_FINE = 97  # places, among which those of a table are chosen
_USUAL = slice(4, 11)  # of the forces, 0.5 to 53 N
_UNFELT = 1e-3  # of the most that can be felt
_HALF_CONDUCTING = 0.4  # W/K, about
_TYPICAL = "steel"  # of what presses on a bare face
_BARE, _GAS = 0.09, 8e3  # W/K of a bare face on a newton of force and on a m2, about, and
_SKINNED = 2e5  # on a m2 of a skin
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
        """(CURVED_TABLE,), read-only."""
        return _table(self)


@lru_cache(maxsize=128)
def _table(of: PressedMesh) -> np.ndarray:
    """Made once for all touches of a process, as those of round bodies are."""
    view = pressed_view(skinned(of.pad, of.skin), of.vertices, of.faces, of.axes)
    if of.ring is not None:
        touched = view.touched(of.ring, bare=of.body if of.skin is None else None)
        return conducting(view.pad, touching_joint(of.skin, of.body, of.ring), view.places, touched)
    found = view.conducted(of.skin, of.body)
    end(found[..., :4], found[..., 4:6])
    return filled(view.places, np.concatenate((found[..., 6:], found[..., 4:6]), axis=-1), found[..., :4])


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
        ring: Ring | None = None,
        some: tuple[tuple[int, int], tuple[int, int]] = _ALL,
        *,
        bare: Material | None = None,
    ) -> np.ndarray:
        """(FORCES, rows, columns, 2) at some of the places: m2 that touch of the face, or of a ring around it, and
        their share of the force. bare: the mesh's material, if the fingertip has no skin and its face is rigid."""
        pad, law = self.pad, np.zeros(1, FOOTPRINT_LAW)[0]
        if bare is not None:
            pad, law = bared(pad), face_footprint(pad, None, Surface.of(bare))
        return pressed(pad, ring, law, self._seen(some))

    def conducted(
        self, skin: Skin | None, body: Material, some: tuple[tuple[int, int], tuple[int, int]] = _ALL
    ) -> np.ndarray:
        """(FORCES, rows, columns, 10) at some of the places: what a mesh of that material conducts, as face.conducted
        tells it. skin: of which the pad has the springs; None for a bare face, which is rigid. Only W/K and m2 mean
        anything at the first and last place, where nothing is touched."""
        pad, law = self.pad, face_footprint(self.pad, skin, Surface.of(body))
        return conducted(
            bared(pad) if skin is None else pad, law, beneath(body, touching(skin)), self._seen(some)
        )

    def _seen(self, some: tuple[tuple[int, int], tuple[int, int]]) -> Seen:
        return Seen(self.seen, self.begin, self.places, self.spans, np.array(some))


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
        bare = pad.face_stiffness is None
        places = _bent(PressedView(fine, pad, seen, low, high - low), bare)
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


def _bent(view: PressedView, bare: bool) -> np.ndarray:
    """(2, PLACES) m, in pairs about the middle, of a view with _FINE places: where the face begins and ceases to be
    wholly over a mesh that touches it there, or to touch a crown in the middle, and then where what is felt of it,
    along the middle, is furthest from what a table would tell with those that there are."""
    found, middle = np.empty((2, PLACES)), (_FINE // 2, _FINE // 2 + 1)
    for axis in range(2):
        fine, span, every = view.places[axis], float(view.spans[axis]), (0, _FINE)
        some = (every, middle) if axis == 0 else (middle, every)
        signed = _signed(view.touched(some=some, bare=material(_TYPICAL) if bare else None), bare)
        exact = _conducting(signed)
        face, half = view.pad.face, view.pad.face / 2
        crown = [span / 2 + way * near * half for near in _NEAR_CROWN for way in (-1, 1)]
        ends = [each for each in (face, span - face, *crown) if 0 < each < span]
        touching = np.max([np.interp(ends, fine, row) for row in exact], axis=0) > 0
        chosen = {0.0, span / 2, span, *np.array(ends)[touching].tolist()}
        while len(chosen) < PLACES - 1:
            at = np.sort(list(chosen))
            coarse = [_conducting(np.interp(fine, at, np.interp(at, fine, row))) for row in signed]
            off = np.abs(coarse - exact).max(axis=0)
            both = np.maximum(off, off[::-1])
            most = int(np.argmax(both))
            if both[most] < _UNFELT:
                break
            chosen |= {float(fine[most]), float(span - fine[most])}
        found[axis] = even_places(0.0, span, chosen)
    return found


def _signed(touched: np.ndarray, bare: bool) -> np.ndarray:
    """(usual forces, places): about what contacts conduct over _HALF_CONDUCTING, W/K, as a table has it."""
    forces = np.exp(FIRST_FORCE + FORCE_STEP * np.arange(FORCES))[:, None, None]
    values = np.zeros((*touched.shape[:3], 6))
    area, load = touched[..., 0], touched[..., 1] * forces
    values[..., 0] = load * _BARE + area * _GAS if bare else area * _SKINNED
    begin_contacts(values)
    return values[_USUAL, ..., 0].reshape(-1, _FINE) / _HALF_CONDUCTING


def _conducting(conducts: np.ndarray) -> np.ndarray:
    """The share of the most that can be felt."""
    return np.maximum(conducts, 0.0) / (1.0 + np.maximum(conducts, 0.0))


def conducting(pad: Pad, faces: Joint, places: np.ndarray, touched: np.ndarray) -> np.ndarray:
    """(CURVED_TABLE,) of what is touched of a ring (FORCES, PLACES, PLACES, 2), as PressedView tells it, at places
    (2, PLACES) m, but for where it lies. pad: with its skin's springs."""
    forces = np.exp(FIRST_FORCE + FORCE_STEP * np.arange(FORCES))
    values = np.zeros((*touched.shape[:3], 6))
    _conduct(flat_law(pad, faces, (pad.width, pad.width)), forces, touched, values)
    return filled(places, values, np.zeros((*touched.shape[:3], 4)))


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
def _conduct(law, forces, touched, values):
    for n in range(touched.shape[0]):
        for a in range(touched.shape[1]):
            for b in range(touched.shape[2]):
                area, load, at = touched[n, a, b, 0], touched[n, a, b, 1] * forces[n], values[n, a, b]
                at[0] = conductance(law, load / area) * area if load > 0.0 else 0.0
                at[2] = area
