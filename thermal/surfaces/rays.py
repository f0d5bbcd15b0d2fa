"""Where straight lines meet triangles.

F: triangles.
"""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit

FACING = 0.2  # cosine of the angle to a direction, below which a face does not look that way


def twice_areas(triangles: np.ndarray) -> np.ndarray:
    """(F, 3) m2, normals of triangles (F, 3, 3) m, as long as twice their areas."""
    return cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])


def cross(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """np.cross of vectors (F, 3), in a fifth of the time where they are few."""
    (a, b, c), (u, v, w) = first.T, second.T
    return np.stack((b * w - c * v, c * u - a * w, a * v - b * u), axis=1)


def crossings(triangles: np.ndarray, origin: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Distances m along a line at which it leaves through faces that look its way (Moller & Trumbore, J. Graph. Tools
    2, 1997)."""
    found = np.empty(len(triangles))
    line = np.asarray(origin, float), np.asarray(direction, float)
    return found[: _crossings(np.ascontiguousarray(triangles, float), *line, found)]


def depths(triangles: np.ndarray, places: np.ndarray, outward: np.ndarray, reach: float) -> np.ndarray:
    """(m,) m from the surface that looks outward within reach of places (n, 3) m, of those that have any, down to the
    next that looks the other way: inf where there is none."""
    found = np.empty(len(places))
    told = np.ascontiguousarray(triangles, float), np.ascontiguousarray(places), np.asarray(outward, float)
    return found[: _depths(*told, reach, found)]


@njit(cache=True, error_model="numpy", short_loops=True)
def _depths(triangles, places, outward, reach, found):
    """Writes them down, and returns how many there are."""
    crossed, count = np.empty(len(triangles)), 0
    for n in range(len(places)):
        face = np.inf
        for k in range(_crossings(triangles, places[n], outward, crossed)):
            if abs(crossed[k]) < abs(face):
                face = crossed[k]
        if not abs(face) < reach:
            continue
        found[count] = np.inf
        for k in range(_crossings(triangles, places[n], -outward, crossed)):
            if 0 < crossed[k] + face < found[count]:
                found[count] = crossed[k] + face
        count += 1
    return count


@njit(cache=True, error_model="numpy", short_loops=True)
def _crossings(triangles, origin, direction, found):
    """Writes them down, and returns how many there are."""
    d0, d1, d2 = direction
    count = 0
    for f in range(len(triangles)):
        a = triangles[f, 0]
        e0, e1, e2 = triangles[f, 1, 0] - a[0], triangles[f, 1, 1] - a[1], triangles[f, 1, 2] - a[2]
        g0, g1, g2 = triangles[f, 2, 0] - a[0], triangles[f, 2, 1] - a[1], triangles[f, 2, 2] - a[2]
        n0, n1, n2 = e1 * g2 - e2 * g1, e2 * g0 - e0 * g2, e0 * g1 - e1 * g0
        facing = n0 * d0 + n1 * d1 + n2 * d2
        if not facing > FACING * np.sqrt(n0 * n0 + n1 * n1 + n2 * n2):
            continue
        t0, t1, t2 = origin[0] - a[0], origin[1] - a[1], origin[2] - a[2]
        u = t0 * (d1 * g2 - d2 * g1) + t1 * (d2 * g0 - d0 * g2) + t2 * (d0 * g1 - d1 * g0)
        q0, q1, q2 = t1 * e2 - t2 * e1, t2 * e0 - t0 * e2, t0 * e1 - t1 * e0
        v = d0 * q0 + d1 * q1 + d2 * q2
        scale = -facing
        u, v = u / scale, v / scale
        if u >= -1e-9 and v >= -1e-9 and u + v <= 1 + 1e-9:
            found[count] = (g0 * q0 + g1 * q1 + g2 * q2) / scale
            count += 1
    return count


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
