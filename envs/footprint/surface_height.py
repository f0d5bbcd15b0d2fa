"""How far an object's surface is from a pad, at points of the pad: boxes, cylinders, spheres and, by a map, meshes.

All is in the object's frame. A pad is given as a frame (4, 3): its middle, m, its normal, out of the pad, and its two
tangential axes. Heights are along the normal, m, up to what is linear over the pad, which the foundation under the
pad takes up (see thermal/pressed). Coverage is the share of a point's little square over which there is a surface; flat
faces' edges run through squares.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from thermograsp.compiled import njit

from ...thermal.pressed import HeightMap, corner_normals, height_map
from ..bodies import MeshShape

BOX, CYLINDER, SPHERE = range(3)
_TURN = math.radians(
    4.0
)  # of directions in which a mesh is mapped; half of it is neglected beyond first order
_STEEP = 0.3  # sine of the angle to the pad above which a face takes part in more than the contact's edge


def mesh_map(shape: MeshShape, normal: np.ndarray) -> HeightMap:
    """The mesh seen about along the normal (3,), in one of the directions 4 degrees apart."""
    return _mapped(
        shape,
        round(math.atan2(normal[1], normal[0]) / _TURN),
        round(math.asin(min(max(normal[2], -1.0), 1.0)) / _TURN),
    )


@lru_cache(maxsize=64)
def _mapped(shape: MeshShape, azimuth: int, elevation: int) -> HeightMap:
    a, e = azimuth * _TURN, elevation * _TURN
    along = np.array([math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)])
    across = np.array([-math.sin(a), math.cos(a), 0.0])
    axes = np.stack([along, across, np.cross(along, across)])
    vertices, faces = np.ascontiguousarray(shape.surface[0], float), shape.surface[1].astype(np.int64)
    return height_map(vertices, faces, axes, corner_normals(vertices.tobytes(), faces.tobytes()))


@njit(cache=True, error_model="numpy")
def shape_heights(shape, half, frame, places, pitch, height, cover):
    """Writes heights and coverage (n,) at places (n, 2) m of the pad, little squares of side pitch m, of a shape with
    these half extents (3,) m."""
    origin, along = np.zeros(3), frame[1]
    for i in range(len(places)):
        for k in range(3):
            origin[k] = frame[0, k] + places[i, 0] * frame[2, k] + places[i, 1] * frame[3, k]
        if shape == BOX:
            height[i], cover[i] = _box(half, origin, along, pitch)
        elif shape == CYLINDER:
            height[i], cover[i] = _cylinder(half, origin, along, pitch)
        else:
            height[i], cover[i] = _sphere(half[0], origin, along)


@njit(cache=True, error_model="numpy", inline="always")
def _inside(inset, pitch):
    """Share of a square of side pitch that lies within an edge, its middle by inset within."""
    return min(max(0.5 + inset / pitch, 0.0), 1.0)


@njit(cache=True, inner=True, error_model="numpy")
def _box(half, origin, along, pitch):
    entry, face = -np.inf, 0
    for k in range(3):
        if abs(along[k]) > _STEEP:
            distance = (-math.copysign(half[k], along[k]) - origin[k]) / along[k]
            if distance > entry:
                entry, face = distance, k
    cover = 1.0
    for k in range(3):
        if k != face:
            hit = origin[k] + entry * along[k]
            # where the other faces are steep as well the near one has been passed: only the far one bounds
            reach = math.copysign(1.0, along[k]) * hit if abs(along[k]) > _STEEP else abs(hit)
            cover *= _inside(half[k] - reach, pitch)
    return entry, cover


@njit(cache=True, inner=True, error_model="numpy")
def _cylinder(half, origin, along, pitch):
    """Upright: its axis is z."""
    square = along[0] ** 2 + along[1] ** 2
    side, end = -np.inf, -np.inf
    if square > _STEEP**2:
        middle = origin[0] * along[0] + origin[1] * along[1]
        inner = middle**2 - square * (origin[0] ** 2 + origin[1] ** 2 - half[0] ** 2)
        if inner <= 0.0:
            return 0.0, 0.0
        side = -(middle + math.sqrt(inner)) / square
    if abs(along[2]) > _STEEP:
        end = (-math.copysign(half[2], along[2]) - origin[2]) / along[2]
    entry = max(side, end)
    x, y, z = origin[0] + entry * along[0], origin[1] + entry * along[1], origin[2] + entry * along[2]
    if side >= end:
        reach = math.copysign(1.0, along[2]) * z if abs(along[2]) > _STEEP else abs(z)
        return entry, _inside(half[2] - reach, pitch)
    if square > _STEEP**2 and x * along[0] + y * along[1] < 0.0:  # over the near half of the end
        return entry, 1.0
    return entry, _inside(half[0] - math.sqrt(x * x + y * y), pitch)


@njit(cache=True, inner=True, error_model="numpy")
def _sphere(radius, origin, along):
    middle = origin[0] * along[0] + origin[1] * along[1] + origin[2] * along[2]
    inner = middle**2 - (origin[0] ** 2 + origin[1] ** 2 + origin[2] ** 2 - radius**2)
    if inner <= 0.0:
        return 0.0, 0.0
    return -middle - math.sqrt(inner), 1.0
