"""How far a surface of triangles is from a pad, at points of the pad: from a map of it along one direction.

All is in the body's frame. A pad is given as a frame (4, 3): its middle, m, its normal, out of the pad, and its two
tangential axes. Heights are along the normal, m, up to what is linear over the pad, which the foundation under the
pad takes up (see foundation.py). Coverage is the share of a point's little square over which there is a surface.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

_PITCH = 0.25e-3  # m
_MOST_NODES = 2000  # each way: half a metre at that pitch, and 32 MB


class HeightMap(NamedTuple):
    """A surface seen along one direction. axes (3, 3): the direction and the two across it. height (n, m): m along the
    direction of what is hit first, on nodes `pitch` m apart from `corner` (2,) m on; inf where nothing is. Nodes are
    .25 mm apart, and further where the surface is wider than half a metre."""

    axes: np.ndarray
    corner: np.ndarray
    height: np.ndarray
    pitch: float


def height_map(vertices: np.ndarray, faces: np.ndarray, axes: np.ndarray) -> HeightMap:
    """Triangles (m, 3) of vertices (n, 3) m seen along axes[0]."""
    seen = np.ascontiguousarray(np.stack([(vertices * axis).sum(axis=1) for axis in axes], axis=1))
    low, high = seen.min(axis=0)[1:], seen.max(axis=0)[1:]
    pitch = max(_PITCH, float((high - low).max()) / _MOST_NODES)
    size = np.ceil((high - low) / pitch).astype(int) + 2
    # nodes symmetric about the middle, so that symmetric objects are seen so
    corner = (low + high) / 2 - pitch * (size - 1) / 2
    height = np.full(tuple(size), np.inf)
    _rasterise(seen, np.asarray(faces, np.int64), corner, pitch, height)
    return HeightMap(axes, corner, height, pitch)


@njit(cache=True, short_loops=True, error_model="numpy")
def _rasterise(vertices, faces, corner, pitch, height):
    """Keeps in height the least first coordinate of triangles over each node of their other two."""
    for f in range(len(faces)):
        p, q, r = vertices[faces[f, 0]], vertices[faces[f, 1]], vertices[faces[f, 2]]
        area = (q[1] - p[1]) * (r[2] - p[2]) - (q[2] - p[2]) * (r[1] - p[1])
        if area == 0.0:
            continue
        first = max(math.ceil((min(p[1], q[1], r[1]) - corner[0]) / pitch - 1e-6), 0)
        last = min(math.floor((max(p[1], q[1], r[1]) - corner[0]) / pitch + 1e-6), height.shape[0] - 1)
        low = max(math.ceil((min(p[2], q[2], r[2]) - corner[1]) / pitch - 1e-6), 0)
        high = min(math.floor((max(p[2], q[2], r[2]) - corner[1]) / pitch + 1e-6), height.shape[1] - 1)
        for i in range(first, last + 1):
            u = corner[0] + i * pitch
            for j in range(low, high + 1):
                v = corner[1] + j * pitch
                b = ((r[2] - p[2]) * (u - p[1]) - (r[1] - p[1]) * (v - p[2])) / area
                c = ((q[1] - p[1]) * (v - p[2]) - (q[2] - p[2]) * (u - p[1])) / area
                if b >= -1e-9 and c >= -1e-9 and b + c <= 1 + 1e-9:
                    height[i, j] = min(height[i, j], p[0] + b * (q[0] - p[0]) + c * (r[0] - p[0]))


@njit(cache=True, short_loops=True, error_model="numpy")
def map_heights(axes, corner, mapped, pitch, frame, places, height, cover):
    """Writes heights and coverage (n,) at places (n, 2) m of the pad, from a map of pitch m."""
    for i in range(len(places)):
        u, v = 0.0, 0.0
        for k in range(3):
            at = frame[0, k] + places[i, 0] * frame[2, k] + places[i, 1] * frame[3, k]
            u, v = u + at * axes[1, k], v + at * axes[2, k]
        u, v = (u - corner[0]) / pitch, (v - corner[1]) / pitch
        a, b = math.floor(u), math.floor(v)
        u, v = u - a, v - b
        total, seen = 0.0, 0.0
        if 0 <= a < mapped.shape[0] - 1 and 0 <= b < mapped.shape[1] - 1:
            for s in range(2):
                for t in range(2):
                    weight = (u if s else 1 - u) * (v if t else 1 - v)
                    if weight > 0.0 and mapped[a + s, b + t] < np.inf:
                        total, seen = total + weight * mapped[a + s, b + t], seen + weight
        cover[i], height[i] = seen, total / seen if seen > 0.0 else 0.0
