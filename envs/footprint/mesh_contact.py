"""What a pad meets of a mesh: about a flat face, a cylinder or a sphere, found from how the pad is pressed by it.

The mesh is pressed on the pad's elastic foundation (foundation.py) with the force's centre in the middle of what of it
is before the pad, as pads that give way align themselves. Along each principal axis the variance of the pressure is set
against that of the covered places: where both are as wide, the face is flat that way. A parabola of half width a has
the variance a^2/5 across a cylinder's line of contact, and a paraboloid a^2/6 along each axis; the radius of curvature
then follows from the laws of thermal/contact/area.py.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Literal, NamedTuple

import numpy as np

from ...thermal import Pad
from ..bodies import MeshShape, ObjectSpec
from .foundation import pressure_map
from .surface_height import MAP_PITCH, map_heights, mesh_map

_POINTS = 80  # along the pad's side
_FULL = 0.8  # of the covered places' variance, from which a face counts as flat


class MeshContact(NamedTuple):
    """shape: what the pad meets. radius: m, of a cylinder or a sphere, the two sides' mean; of a sphere the geometric
    mean of its two radii. size: m, of a flat face over the pad, or a cylinder's (length, length) there."""

    shape: Literal["flat", "cylinder", "sphere"]
    radius: float
    size: tuple[float, float]


def mesh_contact(pad: Pad, spec: ObjectSpec, force: float) -> MeshContact:
    """What a mesh is to pads that close on it with that force, N, along x at its place and angle."""
    height = spec.grasp_height - spec.size[2] / 2
    return _found(pad, spec.geometry, spec.position, spec.yaw, height, force)


@lru_cache(maxsize=256)
def _found(
    pad: Pad, shape: MeshShape, position: tuple[float, float], yaw: float, height: float, force: float
) -> MeshContact:
    sides = [_side(pad, shape, position, yaw, height, force, side) for side in (1, -1)]
    touched = [side for side in sides if side is not None]
    if not touched:
        return MeshContact("flat", math.inf, (0.0, 0.0))
    flatter = max(touched, key=lambda side: ("sphere", "cylinder", "flat").index(side.shape))
    alike = [side for side in touched if side.shape == flatter.shape]
    curvature = sum(1 / side.radius for side in alike) / len(alike)
    return flatter._replace(radius=1 / curvature if curvature > 0 else math.inf)


def _side(
    pad: Pad,
    shape: MeshShape,
    position: tuple[float, float],
    yaw: float,
    height: float,
    force: float,
    side: int,
) -> MeshContact | None:
    """Of the pad whose normal is along x, or against it; None where it meets nothing."""
    cos, sin = math.cos(yaw), math.sin(yaw)
    x, y = position
    normal = np.array([side * cos, -side * sin, 0.0])
    across = np.array([side * sin, side * cos, 0.0])
    middle = np.array([-x * cos - y * sin, x * sin - y * cos, height])
    frame = np.stack([middle, normal, across, (0.0, 0.0, 1.0)])
    middles = (np.arange(_POINTS) + 0.5) * pad.width / _POINTS - pad.width / 2
    places = np.stack([grid.ravel() for grid in np.meshgrid(middles, middles)], axis=1)
    surface, cover, pressure = (np.zeros(len(places)) for _ in range(3))
    map_heights(*mesh_map(shape, normal), MAP_PITCH, frame, places, surface, cover)
    if not cover.any():
        return None
    area = (pad.width / _POINTS) ** 2
    stiffness = pad.foundation_modulus / pad.thickness
    centre = cover @ places / cover.sum()
    pressure_map(surface, cover, places, area, stiffness, pad.thickness, force, centre, pressure)
    pressed, axes = np.linalg.eigh(_spread(places, pressure))
    covered = np.array([axis @ _spread(places, cover) @ axis for axis in axes.T])
    full = pressed >= _FULL * covered
    if full.all():
        size = cover.reshape(_POINTS, _POINTS)
        length = float(size.any(axis=0).sum()) * pad.width / _POINTS
        return MeshContact("flat", math.inf, (length, float(cover.sum()) * area / length))
    if full.any():  # eigh puts the narrow axis first
        length = math.sqrt(12 * pressed[1])
        half = math.sqrt(5 * pressed[0])
        radius = 2 * pad.foundation_modulus * length * half**3 / (3 * force * pad.thickness)
        return MeshContact("cylinder", radius, (length, length))
    square = 6 * math.sqrt(pressed[0] * pressed[1])
    radius = math.pi * pad.foundation_modulus * square**2 / (4 * force * pad.thickness)
    return MeshContact("sphere", radius, (math.inf, math.inf))


def _spread(places: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """(2, 2) m2, variance of places (n, 2) by weight (n,)."""
    share = weight / weight.sum()
    away = places - share @ places
    return (share[:, None] * away).T @ away
