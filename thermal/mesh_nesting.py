"""Which of several closed surfaces lie in which: a core in its sleeve, a layer in a layer, a shaft beside a grip.

Places just beneath each surface are looked for in the others, by how often a line from them crosses those outwards
more than inwards.

F: faces, S: surfaces.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numba import njit

_PLACES = 512  # on each surface
BENEATH = 20e-6  # m, at most: faces that nearly coincide are as good as one
NEARLY_ALL = 0.99  # of the places
_TURN = np.linalg.qr(np.array([[0.9, 0.3, 0.1], [-0.2, 0.8, 0.5], [0.4, -0.6, 0.7]]))[0]
"""A turn that no object's edges are along."""
_STEPS = 0.7548776662466927, 0.5698402909980532
"""Of evenly spread places in a square (Roberts' sequence; inverses of the plastic number and of its square)."""


def shares_within(surfaces: Sequence[np.ndarray]) -> np.ndarray:
    """(S, S) 0 .. 1: how much of each surface, the row, lies in what each other one encloses. surfaces: triangles
    (F, 3, 3) m of each, closed, outward counter-clockwise."""
    turned = [np.ascontiguousarray(surface @ _TURN) for surface in surfaces]
    places = [_places(surface) for surface in turned]
    count = len(surfaces)
    within = np.eye(count)
    for i, j in np.argwhere(within == 0.0).tolist():
        within[i, j] = np.mean(_enclosed(places[i], turned[j]))
    return within


def hosts(within: np.ndarray) -> tuple[int | None, ...] | None:
    """For each of the surfaces of shares_within the last of the earlier ones that it lies in, None for what lies in
    none. None in all where one lies partly in an earlier one, or encloses it."""
    found: list[int | None] = []
    for i in range(len(within)):
        inside = within[i, :i] >= NEARLY_ALL
        apart = (within[i, :i] <= 1 - NEARLY_ALL) & (within[:i, i] <= 1 - NEARLY_ALL)
        if not np.all(inside | apart):
            return None
        found.append(int(np.flatnonzero(inside)[-1]) if inside.any() else None)
    return tuple(found)


def own_volumes(volumes: Sequence[np.ndarray], within: Sequence[int | None]) -> list[np.ndarray]:
    """What each surface encloses less what lies in it. volumes: of each, numbers or arrays of one shape. within: hosts
    of these."""
    own = [np.array(volume, float) for volume in volumes]
    for volume, host in zip(volumes, within, strict=True):
        if host is not None:
            own[host] -= volume
    return own


def _places(triangles: np.ndarray) -> np.ndarray:
    """(n, 3) spread evenly over a surface, a little beneath it."""
    a, first, second = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    normals = np.cross(first, second)
    twice = np.linalg.norm(normals, axis=1)
    volume = float(np.einsum("fi,fi->", a - a.mean(axis=0), normals)) / 6
    # a quarter of a sheet's thickness at most
    beneath = min(BENEATH, volume / twice.sum())
    upto = np.cumsum(twice)
    face = np.searchsorted(upto, (np.arange(_PLACES) + 0.5) / _PLACES * upto[-1])
    u, v = (np.mod(0.5 + step * np.arange(_PLACES), 1.0) for step in _STEPS)
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    on = a[face] + u[:, None] * first[face] + v[:, None] * second[face]
    return on - beneath * normals[face] / twice[face, None]


@njit(cache=True)
def _enclosed(places, triangles):
    """(n,) whether triangles (F, 3, 3) enclose places (n, 3): a line along the third axis leaves more often than it
    enters."""
    enclosed = np.zeros(len(places), np.bool_)
    for n in range(len(places)):
        x, y, z = places[n]
        turns = 0
        for f in range(len(triangles)):
            a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
            u = (b[0] - x) * (c[1] - y) - (b[1] - y) * (c[0] - x)
            v = (c[0] - x) * (a[1] - y) - (c[1] - y) * (a[0] - x)
            w = (a[0] - x) * (b[1] - y) - (a[1] - y) * (b[0] - x)
            total = u + v + w
            inside = (u >= 0 and v >= 0 and w >= 0) or (u <= 0 and v <= 0 and w <= 0)
            if inside and total != 0 and (u * a[2] + v * b[2] + w * c[2]) / total > z:
                turns += 1 if total > 0 else -1
        enclosed[n] = turns > 0
    return enclosed
