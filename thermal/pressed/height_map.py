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
_STRAIGHT = 0.05  # of the turn along a triangle's most bent edge, below which another is straight
_MOST_NODES = 2000  # each way: half a metre at that pitch, and 64 MB
_PARTS = 8  # of a node's square along either side, which are seen or not: as many as bits tell
_WHOLE = np.uint64(2**64 - 1)
_ON_EDGE = 1e-9  # of a triangle, by which a spot on its edge may be outside


class HeightMap(NamedTuple):
    """A surface seen along one direction. axes (3, 3): the direction and the two across it. height (n, m): m along the
    direction of what is hit first, on nodes `pitch` m apart from `corner` (2,) m on; inf where nothing is. seen (n, m):
    over which share of a node's square there is something. Nodes are .25 mm apart, and further where the surface is
    wider than half a metre."""

    axes: np.ndarray
    corner: np.ndarray
    height: np.ndarray
    seen: np.ndarray
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
    spots = np.zeros(height.shape, np.uint64)
    _rasterise(seen, triangles, bulges, corner, pitch, height, spots)
    return HeightMap(axes, corner, height, np.bitwise_count(spots) / _PARTS**2, pitch)


def _bulges(seen: np.ndarray, faces: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(m, 3) m by which a surface that follows the corners' slopes leaves the middles of the triangles' edges (from the
    first corner, the second, the third), times 4: of a quadratic, half the change of its slope along the edge. 0 where
    a corner hardly looks this way, and along edges that are bent far less than another of the triangle: those of long
    strips, whose ends other triangles turn a little. seen, normals: along the map's axes."""
    facing = -normals[..., 0]
    slopes = normals[..., 1:] / np.maximum(facing, _FACING)[..., None]
    along = np.roll(seen[faces][..., 1:], -1, axis=1) - seen[faces][..., 1:]
    change = slopes - np.roll(slopes, -1, axis=1)
    bulges = 0.5 * (change * along).sum(axis=2)
    turned = (change**2).sum(axis=2)
    bulges[turned < _STRAIGHT**2 * turned.max(axis=1, keepdims=True)] = 0.0
    return np.where(np.all(facing > _FACING, axis=1)[:, None], bulges, 0.0)


@njit(cache=True, short_loops=True, error_model="numpy")
def _rasterise(vertices, faces, bulges, corner, pitch, height, seen):
    """Keeps in height the least first coordinate of triangles over each node of their other two, or where there are
    some beside the node alone, over its square; and in seen which of the square's _PARTS x _PARTS spots are under
    them."""
    beside, step = np.full(height.shape, np.inf), pitch / _PARTS
    for f in range(len(faces)):
        p, q, r = vertices[faces[f, 0]], vertices[faces[f, 1]], vertices[faces[f, 2]]
        area = (q[1] - p[1]) * (r[2] - p[2]) - (q[2] - p[2]) * (r[1] - p[1])
        if area == 0.0:
            continue
        # shares of the second and of the third corner: of the first node, and what they gain along both ways
        b_u, b_v = (r[2] - p[2]) / area, -(r[1] - p[1]) / area
        c_u, c_v = -(q[2] - p[2]) / area, (q[1] - p[1]) / area
        b_0 = b_u * (corner[0] - p[1]) + b_v * (corner[1] - p[2])
        c_0 = c_u * (corner[0] - p[1]) + c_v * (corner[1] - p[2])
        b_reach, c_reach = (abs(b_u) + abs(b_v)) * pitch / 2, (abs(c_u) + abs(c_v)) * pitch / 2
        a_reach = (abs(b_u + c_u) + abs(b_v + c_v)) * pitch / 2
        first = max(math.ceil((min(p[1], q[1], r[1]) - corner[0]) / pitch - 0.5), 0)
        last = min(math.floor((max(p[1], q[1], r[1]) - corner[0]) / pitch + 0.5), height.shape[0] - 1)
        low = max(math.ceil((min(p[2], q[2], r[2]) - corner[1]) / pitch - 0.5), 0)
        high = min(math.floor((max(p[2], q[2], r[2]) - corner[1]) / pitch + 0.5), height.shape[1] - 1)
        for i in range(first, last + 1):
            for j in range(low, high + 1):
                b = b_0 + (i * b_u + j * b_v) * pitch
                c = c_0 + (i * c_u + j * c_v) * pitch
                a = 1 - b - c
                if b < -b_reach or c < -c_reach or a < -a_reach:
                    continue
                inside = b >= -_ON_EDGE and c >= -_ON_EDGE and a >= -_ON_EDGE
                if inside:
                    height[i, j] = min(height[i, j], _over(p, q, r, bulges[f], b, c))
                if seen[i, j] == _WHOLE:
                    continue
                if b >= b_reach and c >= c_reach and a >= a_reach:
                    seen[i, j] = _WHOLE
                    continue
                for n in range(_PARTS * _PARTS):
                    u = (n // _PARTS - (_PARTS - 1) / 2) * step
                    v = (n % _PARTS - (_PARTS - 1) / 2) * step
                    there_b, there_c = b + u * b_u + v * b_v, c + u * c_u + v * c_v
                    if there_b >= -_ON_EDGE and there_c >= -_ON_EDGE and there_b + there_c <= 1 + _ON_EDGE:
                        seen[i, j] |= np.uint64(1) << np.uint64(n)
                        if not inside:
                            at = _over(p, q, r, bulges[f], there_b, there_c)
                            beside[i, j] = min(beside[i, j], at)
    for i in range(height.shape[0]):
        for j in range(height.shape[1]):
            if height[i, j] == np.inf:
                height[i, j] = beside[i, j]


@njit(cache=True, error_model="numpy", inline="always")
def _over(p, q, r, bulge, b, c):
    """m along the direction of a triangle's surface, b and c its second and third corner's shares."""
    a = 1 - b - c
    flat = p[0] + b * (q[0] - p[0]) + c * (r[0] - p[0])
    return flat + a * b * bulge[0] + b * c * bulge[1] + c * a * bulge[2]


@njit(cache=True, short_loops=True, error_model="numpy")
def map_heights(axes, corner, mapped, shares, pitch, frame, places, height, cover):
    """Writes heights and coverage (n,) at places (n, 2) m of the pad, from a map of pitch m and its shares."""
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
                    weight *= shares[a + s, b + t]
                    if weight > 0.0:
                        total, seen = total + weight * mapped[a + s, b + t], seen + weight
        cover[i], height[i] = seen, total / seen if seen > 0.0 else 0.0
