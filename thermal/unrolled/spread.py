"""Heat that spreads beneath one patch, as another patch on the same body feels it.

M: patterns, N: points of a patch, T: times, n: cells along the surface.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..kernels import Tip
from ..surfaces import FACING
from .box import functions, means
from .fading import spread
from .local import LocalCells
from .rays import Face, cast

_POINTS = 24  # along a patch's side
_WITHIN = 0.1e-3, 0.3e-3, -0.1e-3  # m below the surface, where the cell of a point is looked for
_NEAR = 3e-3  # m
_FOUND = 0.9  # of a patch's flow among cells, that these hold at least


class SensedPatch(NamedTuple):
    """A patch as points (N, 3) m on the surface. inward: (3,), into the body. shares: (N, M) of each pattern's flow
    through these, that of the even one in all 1."""

    points: np.ndarray
    inward: np.ndarray
    shares: np.ndarray


def sensed_patch(triangles: np.ndarray, face: Face, half: float, tip: Tip) -> SensedPatch | None:
    """A square of half a side m in the middle of a flat face, on the nearest surface that looks its way, of triangles
    (F, 3, 3) m. None where there is nothing."""
    edges = np.linspace(-1.0, 1.0, _POINTS + 1)
    at = half * (edges[1:] + edges[:-1]) / 2
    local = face.local(triangles)
    hits = cast(face, local, np.ones(len(local), int), at, at, 2 * half, half)
    found = hits.surfaces[..., 0] > 0
    tops, slopes = np.where(found, hits.heights[..., 0], np.inf), hits.slopes[..., 0]
    touched = (np.abs(tops) < half) & (slopes > FACING)
    if not touched.any():
        return None
    x, y = (means(values, edges) for values in functions(tip))
    values = (x[:, :, None] + y[:, None, :])[:, touched]
    values[0] = 1.0
    values[1:] -= values[1:].mean(axis=1, keepdims=True)
    i, j = np.nonzero(touched)
    local = np.stack((at[i], at[j], tops[touched]), axis=1)
    return SensedPatch(face.centre + local @ face.axes, -face.axes[2], values.T / len(local))


class Between(NamedTuple):
    """kernel: (T, M, M) K/J of another patch's patterns by the one's beneath which cells are, without the cells' error.
    far: how much of the other is near the end of these or beyond."""

    kernel: np.ndarray
    far: float

    @property
    def turned_round(self) -> Between:
        """Of the one's patterns by the other's."""
        return self._replace(kernel=self.kernel.transpose(0, 2, 1))


class Spread(NamedTuple):
    """On the cells beneath a patch, at times (T,) s. seen: (n,) cells along the surface, and number: (I, J, K) of each
    of these, -1 elsewhere. fields: (T, n, M) K/J in these after a joule through each pattern of the patch. turn: (T, M,
    M), a LocalKernel's."""

    local: LocalCells
    times: np.ndarray
    seen: np.ndarray
    number: np.ndarray
    fields: np.ndarray
    turn: np.ndarray

    @property
    def edges(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """m, of the cells along u, v and w."""
        u, v = (each.edges for each in self.local.along)
        return u, v, self.local.cells.w

    def sensed_by(self, other: SensedPatch, turn: np.ndarray | None = None) -> Between | None:
        """What of another patch lies beyond the cells feels nothing. turn: (T, M, M) of the other's own cells, if they
        are known; else as these have it. None where cells do not hold what of it lies among them."""
        cells, far = np.full(len(other.points), -1), 0.0
        for within in _WITHIN:
            left = np.flatnonzero(cells == -1)
            if not len(left):
                break
            at = self._located(other.points[left] + within * other.inward)
            if len(left) == len(cells):
                far = float(self._beyond(at, _NEAR).mean())
            numbers = [
                np.clip(np.searchsorted(edges, along) - 1, 0, len(edges) - 2)
                for edges, along in zip(self.edges, at.T, strict=True)
            ]
            cells[left] = np.where(self._beyond(at, 0.0), -2, self.number[tuple(numbers)])
        if np.count_nonzero(cells == -1) > (1 - _FOUND) * np.count_nonzero(cells != -2):
            return None
        some, where = np.unique(cells, return_inverse=True)
        shares = np.zeros((len(some), other.shares.shape[1]))
        np.add.at(shares, where, other.shares)
        shares, some = shares[some >= 0], some[some >= 0]
        kernel = np.einsum("nj,tni->tji", shares, self.fields[:, some], optimize=True)
        turn = self.turn if turn is None else turn
        return Between(turn @ kernel @ self.turn.transpose(0, 2, 1), far)

    def _located(self, points: np.ndarray) -> np.ndarray:
        """(N, 3) m of u, v and w."""
        face = self.local.place.face
        return face.located((points - face.centre) @ face.axes.T)

    def _beyond(self, at: np.ndarray, near: float) -> np.ndarray:
        """(N,) whether places (N, 3) m of u, v and w are that near to the cells' ends, or beyond."""
        low, high = (np.array([edges[end] for edges in self.edges]) for end in (0, -1))
        high[2] = np.inf  # above the face they go on as far as the body does
        inside: np.ndarray = (at >= low + near) & (at <= high - near)
        return np.logical_not(inside.all(axis=1))


def spread_beneath(local: LocalCells, times: np.ndarray) -> Spread:
    """Of a patch, at times s, the last the longest."""
    cells = local.cells
    open_ = (cells.links == 0).any(axis=1)
    seen = np.flatnonzero(open_)
    number = np.append(np.where(open_, np.cumsum(open_) - 1, -1), -1)[cells.numbers]
    fields = spread(cells.capacity, cells.neighbours, cells.links, cells.sink, local.ports, times, seen)
    return Spread(local, times, seen, number, fields, local.beside.turn(local.diffusivity * times))
