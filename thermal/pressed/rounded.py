"""The directions in which a mesh's surface looks at the corners of its triangles, where that is smooth.

A mesh stands for a round body by flat triangles, and a rigid face would lie on one of them. Where triangles that meet
at a corner look nearly alike, the surface is taken as smooth there and looks their way on the mean, the larger one's
more. Edges that are sharper stay edges, and so do those at the end of triangles so long that a smooth surface would
leave them by far: the straight wall of a jar below its shoulder. A triangle that goes on for much longer than its
neighbour, the way that the surface turns, is flat up to there, as a face beside its rounded edge.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from thermograsp.compiled import njit

_SMOOTH = math.cos(math.radians(30.0))
_BULGE = 0.5e-3  # m, by which a smooth surface leaves a triangle at most
_LONGER = 2.0  # times its neighbour, along the turn, from which on a triangle is flat there
_SAME = 1e-7  # m between vertices that are one


@lru_cache(maxsize=32)
def corner_normals(vertices: bytes, faces: bytes) -> np.ndarray:
    """(m, 3, 3) unit vectors of triangles (m, 3), int64, of vertices (n, 3) m, as bytes: by triangle and corner; 0 of
    those without an area."""
    points, triangles = np.frombuffer(vertices).reshape(-1, 3), np.frombuffer(faces, np.int64).reshape(-1, 3)
    _, number = np.unique(np.round(points / _SAME), axis=0, return_inverse=True)
    corner = number.reshape(-1)[triangles]
    order = np.argsort(corner.ravel(), kind="stable")
    begin = np.searchsorted(corner.ravel()[order], np.arange(corner.max() + 2))
    normals = np.zeros((len(triangles), 3, 3))
    _mean(points, triangles, corner, order // 3, begin, normals)
    normals.flags.writeable = False
    return normals


@njit(cache=True, error_model="numpy")
def _mean(points, triangles, corner, neighbours, begin, normals):
    """Fills normals. corner: (m, 3) the corners' numbers, vertices at one place having the same. neighbours: the
    triangles that meet at each, from begin to the next one's."""
    flat, weight = np.zeros((len(triangles), 3)), np.zeros((len(triangles), 3))
    for f in range(len(triangles)):
        p, q, r = points[triangles[f, 0]], points[triangles[f, 1]], points[triangles[f, 2]]
        cross = np.cross(q - p, r - p)
        size = np.sqrt((cross**2).sum())
        if size > 0.0:
            flat[f] = cross / size
        for k in range(3):
            at = points[triangles[f, k]]
            u, v = points[triangles[f, (k + 1) % 3]] - at, points[triangles[f, (k + 2) % 3]] - at
            weight[f, k] = size * math.atan2(size, (u * v).sum()) if size > 0.0 else 0.0
    for f in range(len(triangles)):
        for k in range(3):
            total = np.zeros(3)
            for n in range(begin[corner[f, k]], begin[corner[f, k] + 1]):
                other = neighbours[n]
                if other == f or _go_on(points, triangles, flat, f, other):
                    for j in range(3):
                        if corner[other, j] == corner[f, k]:
                            total += weight[other, j] * flat[other]
            size = np.sqrt((total**2).sum())
            if size > 0.0:
                normals[f, k] = total / size


@njit(cache=True, error_model="numpy")
def _go_on(points, triangles, flat, f, other):
    """Whether triangle f goes on smoothly in the other: that surface, which turns evenly from one's direction to the
    other's, leaves the longer of them by an eighth of the turn times its extent in the direction of the turn."""
    if not (flat[f] * flat[other]).sum() > _SMOOTH:
        return False
    turn, extent = flat[other] - flat[f], np.zeros(2)
    for n, each in enumerate((f, other)):
        low, high = np.inf, -np.inf
        for k in range(3):
            along = (points[triangles[each, k]] * turn).sum()
            low, high = min(low, along), max(high, along)
        extent[n] = high - low
    return max(extent[0], extent[1]) / 8 < _BULGE and extent[0] <= _LONGER * extent[1]
