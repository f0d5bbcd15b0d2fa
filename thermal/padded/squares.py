"""What a pad around an element changes, by finite volumes on concentric squares.

Fields that depend on depth and on max(|x|, |y|) alone are a subspace of those of the square element in its square pad:
volumes, the area of the element's sides and heat are exact, isotherms are squares. What the bond between element and
pad changes is the difference between two such bodies, bonded and cut apart, in which what the subspace leaves out of
either one nearly cancels; each apart is known exactly (fingertip.py). studies/pad_square.py compares with
three-dimensional finite elements.

S: moments, X: cells from the middle outward, Z: cells from the thermostat to the front, Q: flows (PORTS).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.linalg import solveh_banded

from ..kernels import EXPONENTS, FUNCTIONS, MOMENTS, NODES
from ..matter import SensorStack, Surround

PORTS = 2 + len(EXPONENTS)
"""Of the front: an even flow into the element's face, flows crowded toward its edges by each exponent, and an even flow
into what of the pad around it touches."""
_WIDTH, _DEPTH, _BETWEEN, _GROWTH = 2e-5, 1.5e-5, 6e-5, 1.25
"""m of the cells at the element's sides, at the front and at other interfaces, and of each by the next one's. Cells of
half this size and growth change the drop by .001 K of 12 K at most, under a skin by .003 K."""


@dataclass(frozen=True, slots=True, eq=False)
class Bonded:
    """What the bond changes. impedance, slope: (S, Q, Q) K/W and its derivative by the moment. drop: (S, Q) K/W over
    the sensed layer. heat: (S, Q) J/W in element and pad."""

    impedance: np.ndarray
    slope: np.ndarray
    drop: np.ndarray
    heat: np.ndarray


@lru_cache(maxsize=64)
def bonded(stack: SensorStack, surround: Surround, touched: float) -> Bonded:
    """stack: the element with its skin. surround: with its depth. touched: m, the side of the square of the front that
    touches. A few hundredths of a second, once."""
    squares = _Squares(stack, surround, touched)
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

    def __init__(self, stack: SensorStack, surround: Surround, touched: float) -> None:
        face, depth = stack.width / 2, surround.layer.thickness
        levels = np.concatenate(([0.0], np.cumsum([layer.thickness for layer in stack.layers])))
        edges = self._outward(face, touched / 2, surround.width / 2)
        height = self._upward(np.unique(np.concatenate((levels, [depth]))))
        inside = edges[1:] <= face * (1 + 1e-9)
        middles = (height[1:] + height[:-1]) / 2
        at = np.searchsorted(levels, middles) - 1
        own = np.array([[each.conductivity, each.volumetric_heat_capacity] for each in stack.layers])[at].T
        pad = surround.layer
        beside = np.where(middles < depth, [[pad.conductivity], [pad.volumetric_heat_capacity]], own)
        conductivity, capacity = np.where(inside[:, None], own[:, None], beside[:, None])
        area, thick, wide = 4 * np.diff(edges**2), np.diff(height), np.diff(edges)
        self._capacity = capacity * area[:, None] * thick
        self._half = half = thick / 2 / conductivity
        self._up = area[:, None] / (half[:, :-1] + half[:, 1:])
        self._back = area / half[:, 0]
        across = wide[:, None] / 2 / conductivity
        self._out = 8 * edges[1:-1, None] * thick / (across[:-1] + across[1:])
        self._inside, self._shares = inside, area[inside] / area[inside].sum()
        touches = edges[1:] <= touched / 2 * (1 + 1e-9)
        # the links outward from the element's sides, and from where the front touches no more
        ends = [np.flatnonzero(kept)[-1] for kept in (inside, touches)]
        self._cuts = np.array([end for end in ends if end < len(self._out)])
        self._density = self._densities(edges / face, inside, touches & ~inside, area)
        self._flow = self._density * area[:, None]
        self._sensed = [int(np.argmin(abs(height - levels[stack.sensed + n]))) for n in (0, 1)]

    @staticmethod
    def _outward(face: float, touched: float, end: float) -> np.ndarray:
        parts = [_graded(0.0, face, np.inf, _WIDTH)]
        marks = [face, *([touched] if face * (1 + 1e-9) < touched < end * (1 - 1e-9) else []), end]
        for low, high in zip(marks[:-1], marks[1:], strict=True):
            parts.append(_graded(low, high, _WIDTH, _WIDTH if high < end else np.inf)[1:])
        return np.concatenate(parts)

    @staticmethod
    def _upward(levels: np.ndarray) -> np.ndarray:
        parts, last = [levels[:1]], len(levels) - 2
        for n, (low, high) in enumerate(zip(levels[:-1], levels[1:], strict=True)):
            parts.append(_graded(low, high, _BETWEEN, _DEPTH if n == last else _BETWEEN)[1:])
        return np.concatenate(parts)

    @staticmethod
    def _densities(edges: np.ndarray, inside: np.ndarray, ring: np.ndarray, area: np.ndarray) -> np.ndarray:
        """(X, Q) 1/m2 of unit flows. edges: over half the element's width."""
        density = np.zeros((len(area), PORTS))
        density[:, 0], density[:, -1] = inside, ring
        half = NODES[len(NODES) // 2 :]
        u = np.minimum(edges, 1.0)
        for n in range(len(EXPONENTS)):
            # the mean of the four patterns that are crowded toward one edge each, and its integral over a square
            along = FUNCTIONS[1 + 2 * n : 3 + 2 * n].mean(axis=0)[len(NODES) // 2 :]
            grown = np.concatenate(([0.0], np.cumsum(along * np.diff(half))))
            within = 4 * u * np.interp(u, half, grown)
            ring_area = np.where(inside, np.diff(4 * u**2), 1.0)
            density[:, 1 + n] = np.where(inside, np.diff(within) / ring_area, 0.0)
        of = np.full(PORTS, area[inside].sum())
        of[-1] = area[ring].sum()
        return density / np.where(of > 0, of, 1.0)

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
        heat = np.zeros((cells, deep, PORTS))
        heat[:, -1] = self._flow
        warm = solveh_banded(
            banded.reshape(deep + 1, -1),
            heat.reshape(-1, PORTS),
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
            return np.zeros(PORTS)
        inside = warm[self._inside]
        if n == warm.shape[1]:
            return self._shares @ (inside[:, -1] + (self._density * self._half[:, -1:])[self._inside])
        below, above = 1 / self._half[self._inside, n - 1], 1 / self._half[self._inside, n]
        mean = below[:, None] * inside[:, n - 1] + above[:, None] * inside[:, n]
        return self._shares @ (mean / (below + above)[:, None])


def _graded(low: float, high: float, first: float, last: float) -> np.ndarray:
    """Boundaries from low to high of cells about so long at either end, which grow away from it; inf: as it comes."""
    if np.isinf(first):
        return low + (high - _graded(low, high, last, first)[::-1])
    if not np.isinf(last):
        # where cells that grow from either end are equally long
        middle = (low + high) / 2 + (last - first) / (2 * (_GROWTH - 1))
        middle = min(max(middle, low + (high - low) / 4), high - (high - low) / 4)
        one, other = _graded(low, middle, first, np.inf), _graded(middle, high, np.inf, last)
        return np.concatenate((one, other[1:]))
    count = max(2, int(np.ceil(np.log1p((high - low) / first * (_GROWTH - 1)) / np.log(_GROWTH))))
    sizes = _GROWTH ** np.arange(count)
    return low + (high - low) * np.concatenate(([0.0], np.cumsum(sizes))) / sizes.sum()
