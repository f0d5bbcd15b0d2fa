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
_FACING = 0.3  # cosine, of a corner that looks the way that the surface is seen from
_MOST_NODES = 2000  # each way: half a metre at that pitch, and 32 MB


class HeightMap(NamedTuple):
    """A surface seen along one direction. axes (3, 3): the direction and the two across it. height (n, m): m along the
    direction of what is hit first, on nodes `pitch` m apart from `corner` (2,) m on; inf where nothing is. Nodes are
    .25 mm apart, and further where the surface is wider than half a metre."""

    axes: np.ndarray
    corner: np.ndarray
    height: np.ndarray
    pitch: float


def height_map(
    vertices: np.ndarray, faces: np.ndarray, axes: np.ndarray, normals: np.ndarray | None = None
) -> HeightMap:
    """Triangles (m, 3) of vertices (n, 3) m seen along axes[0]. normals: (m, 3, 3) unit vectors at their corners, by
    which they are curved (corner_normals); None for flat ones."""
    seen = np.ascontiguousarray(np.stack([(vertices * axis).sum(axis=1) for axis in axes], axis=1))
    low, high = seen.min(axis=0)[1:], seen.max(axis=0)[1:]
    pitch = max(_PITCH, float((high - low).max()) / _MOST_NODES)
    size = np.ceil((high - low) / pitch).astype(int) + 2
    # nodes symmetric about the middle, so that symmetric objects are seen so
    corner = (low + high) / 2 - pitch * (size - 1) / 2
    height = np.full(tuple(size), np.inf)
    triangles = np.asarray(faces, np.int64)
    bulges = np.zeros((len(triangles), 3)) if normals is None else _bulges(seen, triangles, normals @ axes.T)
    _rasterise(seen, triangles, bulges, corner, pitch, height)
    return HeightMap(axes, corner, height, pitch)


def _bulges(seen: np.ndarray, faces: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(m, 3) m by which a surface that follows the corners' slopes leaves the middles of the triangles' edges (from the
    first corner, the second, the third), times 4: of a quadratic, half the change of its slope along the edge. 0 where
    a corner hardly looks this way. seen, normals: along the map's axes."""
    facing = -normals[..., 0]
    slopes = normals[..., 1:] / np.maximum(facing, _FACING)[..., None]
    along = np.roll(seen[faces][..., 1:], -1, axis=1) - seen[faces][..., 1:]
    change = slopes - np.roll(slopes, -1, axis=1)
    bulges = 0.5 * (change * along).sum(axis=2)
    return np.where(np.all(facing > _FACING, axis=1)[:, None], bulges, 0.0)


@njit(cache=True, short_loops=True, error_model="numpy")
def _rasterise(vertices, faces, bulges, corner, pitch, height):
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
                    at = p[0] + b * (q[0] - p[0]) + c * (r[0] - p[0])
                    a = 1 - b - c
                    at += a * b * bulges[f, 0] + b * c * bulges[f, 1] + c * a * bulges[f, 2]
                    height[i, j] = min(height[i, j], at)


@njit(cache=True, short_loops=True, error_model="numpy")
def map_heights(axes, corner, mapped, pitch, frame, places, height, cover):
    """Writes heights and coverage (n,) at places (n, 2) m of the pad, from a map of pitch m."""
    across = np.zeros((2, 3))  # of the pad's middle and of its two axes, along the map's, in nodes
    for axis in range(2):
        for k in range(3):
            for row, vector in enumerate((frame[0], frame[2], frame[3])):
                across[axis, row] += vector[k] * axes[1 + axis, k] / pitch
        across[axis, 0] -= corner[axis] / pitch
    for i in range(len(places)):
        u = across[0, 0] + places[i, 0] * across[0, 1] + places[i, 1] * across[0, 2]
        v = across[1, 0] + places[i, 0] * across[1, 1] + places[i, 1] * across[1, 2]
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
