"""What conducts where a pad meets a geom: the contact law or the table of every pair, and the resistance of a small
contact."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import mujoco
import numpy as np

from ...thermal import (
    CONTACT_LAW,
    Joint,
    Pad,
    Surface,
    cylinder_law,
    flat_law,
    joint,
    material,
    sphere_law,
)
from ...thermal.contact import (
    CURVED_TABLE,
    Beneath,
    beneath,
    curved_table,
    face_joint,
    in_series,
    mean_gap,
    narrowing,
    pad_joint,
    skinned,
)
from ...thermal.padded import RINGS, ring_sides
from ...thermal.pressed import PressedMesh, Ring, RoundRing
from ..scene import BodyShape, PadPlace, has_edge, mesh_of
from .tilt import TILT, tilt_row
from .views import ellipsoid_radii, stacked_views

SQUARE = 0.473  # a square source's mean temperature on a half-space over q/(k side): Carslaw & Jaeger, section 10.5
_WIDE = 10.0  # m, a face that no pad reaches the end of


Pressed = PressedMesh | RoundRing
"""What makes the table of a contact that takes a while to tell."""


class PairLaws(NamedTuple):
    """laws: (F, N, 3) CONTACT_LAW records, and beside: those of the pads around the sensors, zeros without. curved: (F,
    N, A) numbers of the tables of what is curved, by axis, of ellipsoids by radius, and of meshes by view; -1 for what
    is flat. around: (F, N, A, RINGS) those of the rings of the pads around the sensors, -1 without. tables: K,
    (CURVED_TABLE,) each. pressed: of the numbers behind them. tilts: (F, N, 3, TILT) of rods, 0 of others. views: (N,
    A, VIEW) of meshes, and viewed: (N,) how many. radii: (N, A) m of ellipsoids, 0 of others."""

    laws: np.ndarray
    beside: np.ndarray
    curved: np.ndarray
    around: np.ndarray
    tables: tuple[np.ndarray, ...]
    pressed: tuple[Pressed, ...]
    tilts: np.ndarray
    views: np.ndarray
    viewed: np.ndarray
    radii: np.ndarray

    @property
    def all_tables(self) -> np.ndarray:
        """(K + pressed, CURVED_TABLE), one of zeros where there are none."""
        with ThreadPoolExecutor() as threads:
            return stacked([*self.tables, *threads.map(lambda each: each.table(), self.pressed)])


def pair_laws(model: mujoco.MjModel, pads: Sequence[PadPlace], shapes: Sequence[BodyShape]) -> PairLaws:
    """Of each pad on each geom of the objects, in their order, by the axis of the geom's frame that the pad looks
    along; and on each other pad, whose sides are taken as parallel to its own."""
    geoms = [(shape, geom) for shape in shapes for geom in shape.geoms]
    laws = np.zeros((len(pads), len(geoms) + len(pads), 3), CONTACT_LAW)
    beside = np.zeros_like(laws)
    views, viewed, radii = stacked_views(model, [geom for _, geom in geoms], len(pads))
    numbers = np.full((*laws.shape[:2], views.shape[1], 1 + RINGS), -1, np.int64)
    tables: list[np.ndarray] = []
    tilts, made = np.zeros((*laws.shape, TILT)), dict[Pressed, list[tuple[int, int, int, int]]]()
    for f, pad in enumerate(pads):
        silicone = pad.silicone
        sheet = skinned(silicone, pad.skin)
        # a round geom under a rod has no edge on which the rod could come to lie
        flat, rings = any(has_edge(model, geom, pad.axes[:, 0]) for geom in pad.geoms), _rings(pad)
        for g, (shape, geom) in enumerate(geoms):
            other, around = Surface.of(shape.material), None
            faces = face_joint(pad.skin, other)
            if pad.surround is not None:
                around = pad_joint(pad.skin, material(pad.surround.material), other)
            if viewed[g] and not sum(pad.curvature) > 0:
                for k, pressed in enumerate(
                    _pressed(model, geom, views[g, : viewed[g]], pad, silicone, shape)
                ):
                    for n, ring in enumerate((None, *rings)):
                        made.setdefault(replace(pressed, ring=ring), []).append((f, g, k, n))
            for axis in range(3):
                laws[f, g, axis] = _law(model, geom, axis, sheet, faces)
                if pad.skin is None:
                    laws["narrowing"][f, g, axis] = narrowing(other, pad.face)
                if sum(pad.curvature) > 0:
                    _tell_beside(laws[f, g, axis], faces, beneath(shape.material, pad.skin))
                if around is not None:
                    beside[f, g, axis] = _law(model, geom, axis, sheet, around)
            for side, size in enumerate(_sides(model, geom)):
                if size is None or sum(pad.curvature) > 0:
                    continue
                table = curved_table(silicone, pad.skin, shape.material, *size)
                if size[1] is not None and flat:
                    tilts[f, g, side] = tilt_row(pad, silicone, shape, size[0], size[1])
                known = [n for n, each in enumerate(tables) if each is table]
                numbers[f, g, side, 0] = known[0] if known else len(tables)
                if not known:
                    tables.append(table)
                for n, ring in enumerate(rings, 1):
                    of_ring = RoundRing(silicone, pad.skin, shape.material, *size, ring)
                    made.setdefault(of_ring, []).append((f, g, side, n))
        for g, other in enumerate(pads, len(geoms)):
            faces = joint(pad.face, other.face, full_contact=(pad.skin or other.skin) is not None)
            side = max(silicone.face, other.silicone.face)
            both = in_series(sheet, skinned(other.silicone, other.skin))
            laws[f, g] = flat_law(both, faces, (side, side), (1, 2))
            if pad.skin is None and other.skin is None:
                laws["narrowing"][f, g] = narrowing(other.face, pad.face)
            if sum(pad.curvature) + sum(other.curvature) > 0:
                below = beneath(material("alumina"), pad.skin)
                if other.skin is not None:
                    more, thicker = other.skin.resistance, other.skin.thickness
                    below = below._replace(sheet=below.sheet + more, thick=below.thick + thicker)
                for axis in range(3):
                    _tell_beside(laws[f, g, axis], faces, below)
    for number, pairs in enumerate(made.values(), len(tables)):
        for pair in pairs:
            numbers[pair] = number
    return PairLaws(
        laws,
        beside,
        numbers[..., 0],
        numbers[..., 1:],
        tuple(tables),
        tuple(made),
        tilts,
        views,
        viewed,
        radii,
    )


def _tell_beside(law: np.void, faces: Joint, below: Beneath) -> None:
    """Tells a law of round bodies what is beside their contact."""
    law["mean_gap"] = mean_gap(faces)
    for name, value in below._asdict().items():
        law[name] = value


def _rings(pad: PadPlace) -> tuple[Ring, ...]:
    """Of a pad that exchanges heat around its sensor."""
    if pad.surround is None:
        return ()
    made, sides = material(pad.surround.material), ring_sides(pad.stack.width, pad.surround)
    return tuple(Ring(made, *each) for each in pairwise((pad.stack.width, *sides)))


def _pressed(
    model: mujoco.MjModel, geom: int, views: np.ndarray, pad: PadPlace, silicone: Pad, shape: BodyShape
) -> Iterator[PressedMesh]:
    """What the pad is on the mesh from each of its views."""
    vertices, faces = (part.tobytes() for part in mesh_of(model, geom))
    for view in views:
        yield PressedMesh(silicone, pad.skin, shape.material, vertices, faces, view[:9].tobytes())


def stacked(tables: Sequence[np.ndarray]) -> np.ndarray:
    """(K, CURVED_TABLE), one of zeros where there are none."""
    return np.array(tables) if tables else np.zeros((1, CURVED_TABLE))


_Size = tuple[float, float | None] | None
"""Radius and length m of the cylinder that a pad meets, no length of a ball, None where it is flat."""


def _sides(model: mujoco.MjModel, geom: int) -> list[_Size]:
    """By axis, of an ellipsoid by radius."""
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_ELLIPSOID:
        return [(radius, None) for radius in ellipsoid_radii(model.geom_size[geom].tolist())]
    return [_curved(model, geom, axis) for axis in range(3)]


def _curved(model: mujoco.MjModel, geom: int, axis: int) -> _Size:
    """Along that axis."""
    kind, (a, b, c) = mujoco.mjtGeom(int(model.geom_type[geom])), (float(s) for s in model.geom_size[geom])
    shapes = mujoco.mjtGeom
    if kind == shapes.mjGEOM_ELLIPSOID:
        return ellipsoid_radii((a, b, c))[axis], None
    if kind in (shapes.mjGEOM_CYLINDER, shapes.mjGEOM_CAPSULE) and axis < 2:
        return a, 2 * b
    if kind in (shapes.mjGEOM_SPHERE, shapes.mjGEOM_CAPSULE):
        return a, None
    return None


def _law(model: mujoco.MjModel, geom: int, axis: int, pad: Pad, faces: Joint) -> np.void:
    kind, shapes, size = (
        mujoco.mjtGeom(int(model.geom_type[geom])),
        mujoco.mjtGeom,
        _curved(model, geom, axis),
    )
    if size is not None:
        radius, length = size
        return sphere_law(pad, faces, radius) if length is None else cylinder_law(pad, faces, radius, length)
    if kind == shapes.mjGEOM_CYLINDER:
        side = math.sqrt(math.pi) * float(model.geom_size[geom][0])
        return flat_law(pad, faces, (side, side), (0, 1))
    if kind == shapes.mjGEOM_BOX:
        first, second = (i for i in range(3) if i != axis)
        sizes = 2 * model.geom_size[geom]
        return flat_law(pad, faces, (float(sizes[first]), float(sizes[second])), (first, second))
    return flat_law(pad, faces, (_WIDE, _WIDE))
