"""Where straight lines meet triangles.

F: triangles.
"""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit

FACING = 0.2  # cosine of the angle to a direction, below which a face does not look that way


def crossings(triangles: np.ndarray, origin: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Distances m along a line at which it leaves through faces that look its way (Moller & Trumbore, J. Graph. Tools
    2, 1997)."""
    a = triangles[:, 0]
    first, second = triangles[:, 1] - a, triangles[:, 2] - a
    normal = np.cross(first, second)
    facing = normal @ direction > FACING * np.linalg.norm(normal, axis=1)
    a, first, second = a[facing], first[facing], second[facing]
    p = np.cross(direction, second)
    scale = np.einsum("fi,fi->f", first, p)
    to = origin - a
    u = np.einsum("fi,fi->f", to, p) / scale
    q = np.cross(to, first)
    v = q @ direction / scale
    inside = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9)
    return np.einsum("fi,fi->f", second, q)[inside] / scale[inside]


@njit(cache=True, short_loops=True)
def crossed_above(places, triangles, margin):
    """How often triangles (F, 3, 3) lie more than margin m above places (n, 3), along the third axis: (n, 2), those
    that a line upwards leaves through, and those that it enters through."""
    counts = np.zeros((len(places), 2), np.int64)
    for n in range(len(places)):
        x, y, z = places[n]
        for f in range(len(triangles)):
            # most are beside the place
            one, two, three = triangles[f, 0, 0], triangles[f, 1, 0], triangles[f, 2, 0]
            if min(one, two, three) > x or max(one, two, three) < x:
                continue
            a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
            if max(a[2], b[2], c[2]) <= z + margin:
                continue
            u = (b[0] - x) * (c[1] - y) - (b[1] - y) * (c[0] - x)
            v = (c[0] - x) * (a[1] - y) - (c[1] - y) * (a[0] - x)
            w = (a[0] - x) * (b[1] - y) - (a[1] - y) * (b[0] - x)
            total = u + v + w
            inside = (u >= 0 and v >= 0 and w >= 0) or (u <= 0 and v <= 0 and w <= 0)
            if inside and total != 0 and (u * a[2] + v * b[2] + w * c[2]) / total > z + margin:
                counts[n, 0 if total > 0 else 1] += 1
    return counts
