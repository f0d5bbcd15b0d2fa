"""Which of several closed surfaces lie in which: a core in its sleeve, a layer in a layer, a shaft beside a grip.

Places just beneath each surface are looked for in the others, by how often a line from them crosses those outwards
more than inwards.

F: faces, S: surfaces.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .rays import crossed_above

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
        outside = (within[i, :i] <= 1 - NEARLY_ALL) & (within[:i, i] <= 1 - NEARLY_ALL)
        if not np.all(inside | outside):
            return None
        found.append(int(np.flatnonzero(inside)[-1]) if inside.any() else None)
    return tuple(found)


def net_volumes(volumes: Sequence[np.ndarray], within: Sequence[int | None]) -> list[np.ndarray]:
    """What each surface encloses less what lies in it. volumes: of each, numbers or arrays of one shape. within: hosts
    of these."""
    remaining = [np.array(volume, float) for volume in volumes]
    for volume, host in zip(volumes, within, strict=True):
        if host is not None:
            remaining[host] -= volume
    return remaining


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


def _enclosed(places: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(n,) whether triangles (F, 3, 3) enclose places (n, 3): a line upwards leaves more often than it enters."""
    leaves, enters = crossed_above(places, triangles, 0.0).T
    return leaves > enters
