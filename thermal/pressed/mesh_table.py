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
)
from ..matter import Material, Skin, material
from .face import Seen, conducted, pressed
from .height_map import HeightMap, height_map
from .lying import end
from .rounded import corner_normals
from .springs import Ring, touching_joint

_ALL = ((0, PLACES), (0, PLACES))
_EDGED, _CROWNED = (40, 47, 20), (47, 48, 0)
"""Of places, among which those of a table are chosen, how many lie evenly, around the crown and at either end: of any
mesh, and of one that has its crown in the middle of a soft face, along which little changes at its ends."""
_DIGITS = 9  # of places m, which round-off tells apart no further
_USUAL = slice(4, 11)  # of the forces, 0.5 to 53 N
_UNFELT = 1e-3  # of the most that can be felt
_HALF_CONDUCTING = 0.4  # W/K, about
_TYPICAL = "steel"  # of what presses on a bare face
_SKINNED = 2e5  # W/K on a m2 of a skin, about
_TOP = 20e-6  # m, below the first of a mesh to touch, of what lies about as high
_NEAR_CROWN = (0.35, 0.65, 0.85, 1.0)  # of half the face, and
_GONE = 1.4  # of it, where no crown is on the face
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
    end(found[..., :4], found[..., 4:6], bordering=of.pad.sensor is None)
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
        if skin is None:
            pad = bared(pad)
        return conducted(pad, law, beneath(body, skin), self._seen(some))

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
        crown = _crown(seen, low, high - low)
        spans, bare = (high - low).tolist(), pad.face_stiffness is None
        number = _EDGED if bare or crown != (spans[0] / 2, spans[1] / 2) else _CROWNED
        fine = np.stack([_fine(pad, *each, number) for each in zip(spans, crown, strict=True)])
        places = _bent(PressedView(fine, pad, seen, low, high - low), crown, bare)
    places.flags.writeable = False
    return PressedView(places, pad, seen, low, high - low)


def _places(face: float, span: float) -> np.ndarray:
    """(PLACES,) m up to the span: close together where a crown in the mesh's middle comes to the face's edge, and those
    where a straight edge of the mesh begins and ceases to cross the face."""
    crown = [span / 2 + way * near * face / 2 for near in _NEAR_EDGE for way in (-1, 1)]
    return even_places(0.0, span, (face, span - face, *crown))


def _crown(seen: HeightMap, begin: np.ndarray, spans: np.ndarray) -> tuple[float, float]:
    """m, the middle of what of the mesh comes first, as places are counted; the mesh's own where it is there."""
    first = seen.height <= seen.height.min() + _TOP
    weight = np.where(first, seen.seen, 0.0)
    node = [
        np.average(np.arange(count), weights=weight.sum(axis=1 - n)) for n, count in enumerate(weight.shape)
    ]
    at = seen.corner + seen.pitch * np.array(node) - begin
    first_at, second_at = np.where(abs(at - spans / 2) < seen.pitch, spans / 2, at).tolist()
    return first_at, second_at


def _fine(pad: Pad, span: float, crown: float, number: tuple[int, int, int]) -> np.ndarray:
    """(n,) m up to the span: some evenly, many where the pad is over the crown and at either end, and where the face
    begins and ceases to be wholly over the mesh; symmetric where the crown is in the middle."""
    even, around, ends = number
    half = min(pad.width / 2, span / 2)
    near = np.linspace(max(crown - half, 0.0), min(crown + half, span), around + 2)[1:-1]
    first = np.linspace(0.0, min(1.5 * pad.face, span / 2), ends)
    points = np.linspace(0.0, span, even), near, first, span - first, (pad.face, span - pad.face, crown)
    return np.sort(np.round(np.concatenate(points), _DIGITS))


def _bent(view: PressedView, crown: tuple[float, float], bare: bool) -> np.ndarray:
    """(2, PLACES) m, of a view with _fine places: where the face begins and ceases to be wholly over a mesh that
    touches it there, or to touch the crown, and then where what is felt of it, along the crown, is furthest from what a
    table would tell with those that there are; in pairs about the middle if the crown is there."""
    found = np.empty((2, PLACES))
    for axis in range(2):
        fine, span, at = view.places[axis], float(view.spans[axis]), crown[axis]
        row = int(np.argmin(abs(view.places[1 - axis] - crown[1 - axis])))
        every, along = (0, len(fine)), (row, row + 1)
        some = (every, along) if axis == 0 else (along, every)
        signed = _signed(view, some, bare)
        exact = _conducting(signed)
        face, half, even = view.pad.face, view.pad.face / 2, at == span / 2
        near = [at + way * near * half for near in _NEAR_CROWN for way in (-1, 1)]
        over, gone = (
            np.array([np.interp(at + off, fine, row) for row in exact]) for off in (0.0, _GONE * half)
        )
        ends = [face, span - face, *(near if (gone < over / 2).any() else ())]
        ends = [each for each in ends if 0 < each < span]
        touching = np.max([np.interp(ends, fine, row) for row in exact], axis=0) > 0
        chosen = {float(fine[0]), at, float(fine[-1]), *np.array(ends)[touching].tolist()}
        while len(chosen) < PLACES - 1:
            known = np.sort(list(chosen))
            coarse = [_conducting(np.interp(fine, known, np.interp(known, fine, row))) for row in signed]
            off = np.abs(coarse - exact).max(axis=0)
            off = np.maximum(off, off[::-1]) if even else off
            off[np.isin(fine, known)] = 0.0  # no more than one of places that round-off tells apart
            most = int(np.argmax(off))
            if not off[most] >= _UNFELT:
                break
            chosen |= {float(fine[most]), float(span - fine[most])} if even else {float(fine[most])}
        found[axis] = even_places(0.0, span, chosen)
    return found


def _signed(view: PressedView, some: tuple[tuple[int, int], tuple[int, int]], bare: bool) -> np.ndarray:
    """(n, places): what contacts conduct over _HALF_CONDUCTING, about, as a table has it, at usual forces."""
    if bare:
        conducts = view.conducted(None, material(_TYPICAL), some)[_USUAL, ..., 6:8].sum(axis=-1)
    else:
        touched = view.touched(some=some)
        values = np.zeros((*touched.shape[:3], 6))
        values[..., 0] = touched[..., 0]
        begin_contacts(values)
        conducts = _SKINNED * values[_USUAL, ..., 0]
    return conducts.reshape(len(conducts), -1) / _HALF_CONDUCTING


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
