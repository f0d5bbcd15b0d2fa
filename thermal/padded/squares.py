"""What a pad around an element changes, by finite volumes on concentric squares.

Fields that depend on depth and on max(|x|, |y|) alone are a subspace of those of the square element in its square pad:
volumes, the area of the element's sides and heat are exact, isotherms are squares. What the bond between element and
pad changes is the difference between two such bodies, bonded and cut apart, in which what the subspace leaves out of
either one nearly cancels; each apart is known exactly (fingertip.py). studies/surround/pad_square.py compares with
three-dimensional finite elements.

S: moments, X: cells from the middle outward, Z: cells from the thermostat to the front, R: rings of the pad's front
around the element's face, Q = FACE + R: flows.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
from scipy.linalg import solveh_banded

from ..kernels import EXPONENTS, FUNCTIONS, MOMENTS, NODES
from ..matter import SensorStack, Surround
from ..numerics import graded_cells

FACE = 1 + len(EXPONENTS)
"""Flows into the element's face: an even one, and those crowded toward its edges by each exponent. Behind them are even
ones into each ring of the pad around it that touches."""
_WIDTH, _DEPTH, _BETWEEN, _GROWTH = 2e-5, 1.5e-5, 6e-5, 0.25
"""m of the cells at the element's sides and where the front touches no more, at the front, and at other interfaces and
between rings; and how many m longer a cell is for each m away from there. Cells of half this size and growth change the
drop by .001 K of 12 K at most, under a skin by .003 K."""


@dataclass(frozen=True, slots=True, eq=False)
class Bonded:
    """What the bond changes. impedance, slope: (S, Q, Q) K/W and its derivative by the moment. drop: (S, Q) K/W over
    the sensed layer. heat: (S, Q) J/W in element and pad."""

    impedance: np.ndarray
    slope: np.ndarray
    drop: np.ndarray
    heat: np.ndarray


@lru_cache(maxsize=64)
def bonded(stack: SensorStack, surround: Surround, rings: tuple[float, ...]) -> Bonded:
    """stack: the element with its skin. surround: with its depth. rings: m, the outer sides of the squares around the
    face that touch, ascending; the last one's may be the face's. A few hundredths of a second, once."""
    squares = _Squares(stack, surround, rings)
    found = [
        [one - other for one, other in zip(squares.solved(s, False), squares.solved(s, True), strict=True)]
        for s in MOMENTS
    ]
    arrays = [np.array(each) for each in zip(*found, strict=True)]
    for array in arrays:
        array.setflags(write=False)
    return Bonded(*arrays)


class _Squares:
    """The fingertip's cells: heat capacity (X, Z) J/K and conductances W/K in depth, to the thermostat and outward."""

    def __init__(self, stack: SensorStack, surround: Surround, rings: tuple[float, ...]) -> None:
        face, depth, end = stack.width / 2, surround.layer.thickness, surround.width / 2
        levels = np.concatenate(([0.0], np.cumsum([layer.thickness for layer in stack.layers])))
        outer = [min(side / 2, end) for side in rings]
        fine = {side: _BETWEEN for side in outer if side < end * (1 - 1e-9)}
        fine |= {side: _WIDTH for side in (face, outer[-1]) if side < end * (1 - 1e-9)}
        edges = graded_cells((0.0, *sorted({*fine, end})), fine, _GROWTH, np.inf)
        marks = np.unique(np.concatenate((levels, [depth])))
        fine = dict.fromkeys(marks.tolist(), _BETWEEN) | {float(marks[-1]): _DEPTH}
        height = graded_cells(marks.tolist(), fine, _GROWTH, np.inf)
        inside = edges[1:] <= face * (1 + 1e-9)
        middles = (height[1:] + height[:-1]) / 2
        at = np.searchsorted(levels, middles) - 1
        layered = np.array([[each.conductivity, each.volumetric_heat_capacity] for each in stack.layers])[
            at
        ].T
        pad = surround.layer
        beside = np.where(middles < depth, [[pad.conductivity], [pad.volumetric_heat_capacity]], layered)
        conductivity, capacity = np.where(inside[:, None], layered[:, None], beside[:, None])
        area, thick, wide = 4 * np.diff(edges**2), np.diff(height), np.diff(edges)
        self._capacity = capacity * area[:, None] * thick
        self._half = half = thick / 2 / conductivity
        self._up = area[:, None] / (half[:, :-1] + half[:, 1:])
        self._back = area / half[:, 0]
        across = wide[:, None] / 2 / conductivity
        self._out = 8 * edges[1:-1, None] * thick / (across[:-1] + across[1:])
        self._inside, self._shares = inside, area[inside] / area[inside].sum()
        within = [edges[1:] <= side * (1 + 1e-9) for side in (face, *outer)]
        # the links outward from the element's sides, from each ring, and from where the front touches no more
        ends = {int(np.flatnonzero(kept)[-1]) for kept in within}
        self._cuts = np.array(sorted(end for end in ends if end < len(self._out)), int)
        parts = [kept & ~before for before, kept in pairwise(within)]
        self._density = self._densities(edges / face, inside, parts, area)
        self._flow = self._density * area[:, None]
        self._sensed = [int(np.argmin(abs(height - levels[stack.sensed + n]))) for n in (0, 1)]

    @staticmethod
    def _densities(
        edges: np.ndarray, inside: np.ndarray, rings: list[np.ndarray], area: np.ndarray
    ) -> np.ndarray:
        """(X, Q) 1/m2 of unit flows. edges: over half the element's width."""
        density = np.zeros((len(area), FACE + len(rings)))
        density[:, 0] = inside / area[inside].sum()
        half = NODES[len(NODES) // 2 :]
        u = np.minimum(edges, 1.0)
        for n in range(len(EXPONENTS)):
            # the mean of the four patterns that are crowded toward one edge each, and its integral over a square
            along = FUNCTIONS[1 + 2 * n : 3 + 2 * n].mean(axis=0)[len(NODES) // 2 :]
            grown = np.concatenate(([0.0], np.cumsum(along * np.diff(half))))
            within = 4 * u * np.interp(u, half, grown)
            ring_area = np.where(inside, np.diff(4 * u**2), 1.0)
            density[:, 1 + n] = np.where(inside, np.diff(within) / ring_area, 0.0) / area[inside].sum()
        for ring, kept in enumerate(rings, FACE):
            if kept.any():
                density[:, ring] = kept / area[kept].sum()
        return density

    def solved(self, s: float, cut: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Impedance (Q, Q), its slope, drop (Q,) and heat (Q,) at s 1/s."""
        cells, deep = self._capacity.shape
        out = self._out.copy()
        if cut:
            out[self._cuts] = 0.0
        banded = np.zeros((deep + 1, cells, deep))
        banded[0] = s * self._capacity
        banded[0, :, :-1] += self._up
        banded[0, :, 1:] += self._up
        banded[0, :, 0] += self._back
        banded[0, :-1] += out
        banded[0, 1:] += out
        banded[1, :, :-1], banded[deep, :-1] = -self._up, -out
        heat = np.zeros((cells, deep, self._flow.shape[1]))
        heat[:, -1] = self._flow
        warm = solveh_banded(
            banded.reshape(deep + 1, -1),
            heat.reshape(cells * deep, -1),
            lower=True,
            overwrite_ab=True,
            check_finite=False,
        )
        warm = warm.reshape(heat.shape)
        surface = warm[:, -1] + self._density * self._half[:, -1:]
        impedance = self._flow.T @ surface
        slope = -np.einsum("xzp,xz,xzq->pq", warm, self._capacity, warm, optimize=True)
        low, high = (self._level(warm, n) for n in self._sensed)
        return (impedance + impedance.T) / 2, slope, low - high, np.tensordot(self._capacity, warm, axes=2)

    def _level(self, warm: np.ndarray, n: int) -> np.ndarray:
        """(Q,) K, the element's mean between the cells n - 1 and n; the thermostat's where n is 0."""
        if n == 0:
            return np.zeros(warm.shape[2])
        inside = warm[self._inside]
        if n == warm.shape[1]:
            return self._shares @ (inside[:, -1] + (self._density * self._half[:, -1:])[self._inside])
        below, above = 1 / self._half[self._inside, n - 1], 1 / self._half[self._inside, n]
        mean = below[:, None] * inside[:, n - 1] + above[:, None] * inside[:, n]
        return self._shares @ (mean / (below + above)[:, None])
