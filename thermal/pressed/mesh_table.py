"""What a pad touches of a mesh that it meets along one direction, as a table over force and place.

The mesh sinks into the pad's elastic foundation (thermal/contact/area.py) along that direction, without a tilt, until
the springs under it take the force. Area counts where there is pressure and the mesh covers the face: the crests of a
thread, the teeth of a gear, a face up to its edge. Its length tells a strip from a square, in which heat is more
constricted, and so it is at the ends of the face and of the mesh, which ends where its outline does. The tables are
those of curved bodies (thermal/contact/curved_table.py): W/K, m2 and m at FORCES and at places of the pad's middle,
whose sides lie along the mesh's. Places are counted from where the face begins to meet the mesh, so that they are never
below 0."""

from __future__ import annotations

import math
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
    Pad,
    Surface,
    conductance,
    even_places,
    face_joint,
    flat_law,
    patch_ends,
    patch_offset,
    skinned,
    table_values,
)
from ..matter import Material, Skin
from .height_map import HeightMap, height_map, map_heights

_POINTS = 40  # along the pad's side, of the foundation
_FINER = 4  # times as many on the face
_STEPS = 50
_NEAR_EDGE = (0.0, 0.35, 0.65, 0.9, 1.15, 1.4)  # of half the face
_TOLERANCE = 1e-12  # of the force
_WHOLE = 0.98  # of the face: what is longer covers it, to its points
_FADED = 0.1  # of what a force five times as large touches, at least


@dataclass(frozen=True, slots=True)
class PressedMesh:
    """A fingertip on a mesh from one side. pad: its silicone; skin: over it, None for none. body: the mesh's material.
    vertices (n, 3) m and triangles (m, 3) of int64, as bytes; axes: (3, 3), as bytes, of which the first is the
    direction from outside inwards."""

    pad: Pad
    skin: Skin | None
    body: Material
    vertices: bytes
    faces: bytes
    axes: bytes

    def table(self) -> np.ndarray:
        """(CURVED_TABLE,)."""
        sheet = skinned(self.pad, self.skin)
        faces = face_joint(self.skin, Surface.of(self.body))
        view = pressed_view(sheet, self.vertices, self.faces, self.axes)
        return _conducting(view, flat_law(sheet, faces, (sheet.width, sheet.width)))


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
        self, rows: tuple[int, int] = (0, PLACES), columns: tuple[int, int] = (0, PLACES)
    ) -> np.ndarray:
        """(FORCES, rows, columns, 7) at the places from one up to another: m2 of the face in contact, its share of the
        force, m, the length along the second axis of a rectangle of that area that is as long to broad as the contact,
        and the shares by which it lies at an end of the face along both axes, and of the mesh
        (thermal/contact/patch_place.py). Only areas and shares of the force mean anything at the first and last place,
        where nothing is touched."""
        touched = np.zeros((FORCES, rows[1] - rows[0], columns[1] - columns[0], 7))
        loads = np.exp(FIRST_FORCE + FORCE_STEP * np.arange(FORCES))
        loads *= self.pad.thickness / self.pad.foundation_modulus
        some = np.array([rows, columns])
        points = _points(self.pad)
        _press(*self.seen, self.begin, self.places, some, *points, loads, self.spans, self.pad.face, touched)
        return touched


@lru_cache(maxsize=256)
def pressed_view(pad: Pad, vertices: bytes, faces: bytes, axes: bytes) -> PressedView:
    """The view of a PressedMesh, with a pad that has its skin's springs."""
    corners = np.frombuffer(vertices).reshape(-1, 3)
    seen = height_map(
        corners, np.frombuffer(faces, np.int64).reshape(-1, 3), np.frombuffer(axes).reshape(3, 3)
    )
    across = corners @ seen.axes[1:].T
    low, high = across.min(axis=0) - pad.face / 2, across.max(axis=0) + pad.face / 2
    places = np.stack([_places(pad.face, float(span)) for span in high - low])
    places.flags.writeable = False
    return PressedView(places, pad, seen, low, high - low)


def _places(face: float, span: float) -> np.ndarray:
    """(PLACES,) m up to the span: close together where a crown in the mesh's middle comes to the face's edge, and those
    where a straight edge of the mesh begins and ceases to cross the face."""
    crown = [span / 2 + way * near * face / 2 for near in _NEAR_EDGE for way in (-1, 1)]
    return even_places(0.0, span, (face, span - face, *crown))


def _points(pad: Pad) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """Of the pad's springs: places (n, 2) m, areas (n,) m2 and stiffness (n,) over that of those around the face. The
    first are on the face, so many, and closer together; the others' areas are what of them is beside it."""
    fine = square_middles(pad.face, math.ceil(_FINER * _POINTS * pad.face / pad.width))
    coarse, pitch = square_middles(pad.width, _POINTS), pad.width / _POINTS
    on_face = np.clip((pad.face / 2 - np.abs(coarse)) / pitch + 0.5, 0.0, 1.0).prod(axis=1)
    around = on_face < 1
    areas = np.full(len(fine), pad.face**2 / len(fine)), (1 - on_face[around]) * pitch**2
    stiffness = np.full(len(fine), pad.face_ratio), np.ones(len(areas[1]))
    return np.concatenate((fine, coarse[around])), np.concatenate(areas), np.concatenate(stiffness), len(fine)


def square_middles(side: float, count: int) -> np.ndarray:
    """(count^2, 2) m from a square's middle: those of so many squares each way in it."""
    middles = (np.arange(count) + 0.5) * side / count - side / 2
    return np.stack([grid.ravel() for grid in np.meshgrid(middles, middles)], axis=1)


def _conducting(view: PressedView, law: np.void) -> np.ndarray:
    """(CURVED_TABLE,) of a view. law: a CONTACT_LAW of the faces."""
    touched = view.touched()
    # where a contact vanishes it is a strip at both ends
    for end, beside in ((0, 1), (-1, -2)):
        touched[:, end, :, 2:] = touched[:, beside, :, 2:]
        touched[:, end, :, 3], touched[:, end, :, 5] = 1.0, 1.0
    for end, beside in ((0, 1), (-1, -2)):
        touched[:, :, end, 3:] = touched[:, :, beside, 3:]
        touched[:, :, end, 2], touched[:, :, end, 4], touched[:, :, end, 6] = 0.0, 1.0, 1.0
    table = np.empty(CURVED_TABLE)
    table[: 2 * PLACES] = view.places.ravel()
    forces = np.exp(FIRST_FORCE + FORCE_STEP * np.arange(FORCES))
    _conduct(law, forces, touched, *table_values(table))
    table.flags.writeable = False
    return table


@njit(cache=True, error_model="numpy")
def _press(
    axes, corner, height, pitch, begin, places, some, points, areas, stiffness, on_face, loads, spans, face, touched
):  # fmt: skip
    """Fills touched, some of the places: (2, 2) from which to before which. on_face: how many points. loads: m3, forces
    over the stiffness of springs around the face. spans: (2,) m of places, the mesh's outline and the face's side."""
    frame = np.zeros((4, 3))
    frame[1:] = axes
    heights, cover = np.zeros(len(points)), np.zeros(len(points))
    slopes, touching = np.zeros(on_face), np.zeros(on_face)
    last = places.shape[1] - 1  # nothing is touched at the ends
    for a in range(max(some[0, 0], 1), min(some[0, 1], last)):
        for b in range(max(some[1, 0], 1), min(some[1, 1], last)):
            at = touched[:, a - some[0, 0], b - some[1, 0]]
            for k in range(3):
                frame[0, k] = (begin[0] + places[0, a]) * axes[1, k] + (begin[1] + places[1, b]) * axes[2, k]
            map_heights(axes, corner, height, pitch, frame, points, heights, cover)
            cover *= areas
            # a light force's depth is little beside the heights
            least = np.inf
            for i in range(len(points)):
                if cover[i] > 0.0:
                    least = min(least, heights[i])
            heights -= least
            if cover[:on_face].max() == 0.0:
                continue
            _slope(heights, cover, slopes)
            for n in range(0, len(loads), 2):
                depth = _sunk(heights, cover, stiffness, loads[n])
                held = 0.0
                for i in range(on_face):
                    sunk = depth - heights[i]
                    touching[i] = cover[i] * _part(sunk, slopes[i])
                    held += cover[i] * stiffness[i] * max(sunk, 0.0)
                at[n, 0], at[n, 1] = touching.sum(), held / loads[n]
                _lie(points, touching, areas[0], places[0, a], places[1, b], spans, face, at[n])
            # between forces a power of them is taken, which must not begin at nothing
            for n in range(len(loads) - 4, -1, -2):
                for k, faded in enumerate((_FADED, _FADED, math.sqrt(_FADED))):
                    if at[n, k] < faded * at[n + 2, k]:
                        at[n, k] = faded * at[n + 2, k]
                        at[n, 3:] = at[n + 2, 3:]
            for n in range(1, len(loads), 2):
                above = min(n + 1, len(loads) - 2)
                at[n, 0] = math.sqrt(at[n - 1, 0] * at[above, 0])
                for k in range(1, 7):
                    at[n, k] = (at[n - 1, k] + at[above, k]) / 2


@njit(cache=True, error_model="numpy")
def _slope(heights, cover, slopes):
    """Writes by how many m the surface rises over the square of each of the face's points, the gentler of the two ways
    along both axes: a point at the edge of a crest is on it."""
    side = round(math.sqrt(len(slopes)))
    for i in range(len(slopes)):
        slopes[i] = 0.0
        for step, at in ((1, i % side), (side, i // side)):
            least = np.inf
            if at > 0 and cover[i - step] > 0.0:
                least = abs(heights[i] - heights[i - step])
            if at < side - 1 and cover[i + step] > 0.0:
                least = min(least, abs(heights[i + step] - heights[i]))
            if least < np.inf:
                slopes[i] += least


@njit(cache=True, inner=True, error_model="numpy")
def _part(sunk, slope):
    """Of a point's square, what touches where its middle has sunk in by so many m."""
    if slope == 0.0:
        return 1.0 if sunk > 0.0 else 0.0
    return min(max(0.5 + sunk / slope, 0.0), 1.0)


@njit(cache=True, error_model="numpy")
def _lie(points, touching, square, aside, along, spans, face, touched):
    """Writes a contact's length m and its shares to touched[2:], by the moments of what of each point touches, m2; a
    point counts as a square of that area m2. aside, along: m, the pad's place."""
    s, sy, sz, syy, syz, szz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(len(touching)):
        w, y, z = touching[i], points[i, 0], points[i, 1]
        s, sy, sz = s + w, sy + w * y, sz + w * z
        syy, syz, szz = syy + w * y * y, syz + w * y * z, szz + w * z * z
    if s == 0.0:
        return
    yy, zz, yz = syy / s - (sy / s) ** 2, szz / s - (sz / s) ** 2, syz / s - sy * sz / s**2
    middle, spread = (yy + zz) / 2 + square / 12, math.hypot((yy - zz) / 2, yz)
    longer = math.sqrt(s * math.sqrt((middle + spread) / max(middle - spread, square / 12)))
    touched[2] = longer if zz >= yy else s / longer
    for axis in range(2):
        length = touched[2] if axis == 1 else s / touched[2]
        pad, off = (along, sz / s) if axis == 1 else (aside, sy / s)
        pad -= spans[axis] / 2
        length = face if length > _WHOLE * face else length
        touched[3 + axis] = patch_offset(off, length, face)
        touched[5 + axis] = patch_ends(pad + off, pad, length, spans[axis] - face, face)


@njit(cache=True, error_model="numpy")
def _sunk(heights, cover, stiffness, load):
    """m at which springs take the load, m3; -inf where there are none."""
    depth, whole = load, 0.0
    for i in range(len(heights)):
        depth += cover[i] * stiffness[i] * heights[i]
        whole += cover[i] * stiffness[i]
    if whole == 0.0:
        return -np.inf
    depth /= whole  # if all pushed: at least as deep as it will be
    for _ in range(_STEPS):
        held, rate = 0.0, 0.0
        for i in range(len(heights)):
            if heights[i] < depth:
                spring = cover[i] * stiffness[i]
                held += spring * (depth - heights[i])
                rate += spring
        wrong = held - load
        if rate == 0.0 or abs(wrong) <= _TOLERANCE * load:
            break
        depth -= wrong / rate
    return depth


@njit(cache=True, error_model="numpy")
def _conduct(law, forces, touched, values, shares):
    for n in range(touched.shape[0]):
        for a in range(touched.shape[1]):
            for b in range(touched.shape[2]):
                area = touched[n, a, b, 0]
                load = touched[n, a, b, 1] * forces[n]
                values[n, a, b, 0] = conductance(law, load / area) * area if load > 0.0 else 0.0
                values[n, a, b, 1], values[n, a, b, 2] = area, touched[n, a, b, 2]
                for k in range(4):
                    shares[n, a, b, k] = touched[n, a, b, 3 + k]
