"""Solves (s capacity + conduction) x = b on a mesh's grid for several b at once: conjugate gradients, preconditioned by
an incomplete Cholesky factorisation without fill (Meijerink & van der Vorst, Math. Comp. 31, 1977). Moving the fill to
the diagonal (Gustafsson, BIT 18, 1978) takes three times the iterations where walls are much thinner than cells.

N: cells, P: right-hand sides.
"""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit
from thermograsp.errors import SimulationError

from .grid import MeshGrid

_MOST_ITERATIONS = 2000


def solve_shifted(
    grid: MeshGrid, s: float, right: np.ndarray, guess: np.ndarray, tolerance: float
) -> np.ndarray:
    """Temperatures (N, P) K for heat flows right (N, P) W at s (1/s, > 0), starting from a guess (N, P).

    tolerance: norm of what is left over of `right` relative to its norm. Raises SimulationError where it is not met.
    """
    diagonal = s * grid.capacity + grid.links.sum(axis=1)
    pivots = _factor(diagonal, grid.neighbours, grid.links)
    x = np.array(guess, float)
    residual = right - _product(diagonal, grid, x)
    fields, sums = (residual, *np.zeros((3, *x.shape))), tuple(np.ones((4, x.shape[1])))
    enough = tolerance**2 * np.sum(right**2, axis=0)
    count = _iterate(diagonal, pivots, grid.neighbours, grid.links, x, enough, _MOST_ITERATIONS, fields, sums)
    if count < 0:
        raise SimulationError(
            f"the temperatures of a mesh's grid of {len(diagonal)} cells did not settle in {_MOST_ITERATIONS} "
            f"iterations at {s:g} 1/s"
        )
    return x


def conduct(grid: MeshGrid, fields: np.ndarray) -> np.ndarray:
    """Heat flow (N, P) W out of each cell by conduction at temperatures (N, P)."""
    return _product(grid.links.sum(axis=1), grid, np.ascontiguousarray(fields))


def _product(diagonal: np.ndarray, grid: MeshGrid, x: np.ndarray) -> np.ndarray:
    out = np.empty(x.shape)
    _multiply(diagonal, grid.neighbours, grid.links, x, out, np.empty(x.shape[1]))
    return out


@njit(cache=True, short_loops=True)
def _multiply(diagonal, neighbours, links, x, out, products):
    """The matrix times x (N, P), and the products (P,) of x with that."""
    cells, columns = x.shape
    for p in range(columns):
        products[p] = 0.0
    for i in range(cells):
        for p in range(columns):
            out[i, p] = diagonal[i] * x[i, p]
        for n in range(6):
            j = neighbours[i, n]
            if j >= 0:
                g = links[i, n]
                for p in range(columns):
                    out[i, p] -= g * x[j, p]
        for p in range(columns):
            products[p] += x[i, p] * out[i, p]


@njit(cache=True, short_loops=True)
def _factor(diagonal, neighbours, links):
    """Inverse pivots (N,) of the incomplete factorisation, cells in their order."""
    cells = len(diagonal)
    inverse = np.empty(cells)
    for i in range(cells):
        pivot = diagonal[i]
        for n in (0, 2, 4):
            j = neighbours[i, n]
            if j >= 0:
                pivot -= links[i, n] ** 2 * inverse[j]
        inverse[i] = 1 / pivot
    return inverse


@njit(cache=True, inner=True)
def _precondition(inverse, neighbours, links, right, out, products):
    """Solves the factorisation for right (N, P), and the products (P,) of right with that."""
    cells, columns = right.shape
    for i in range(cells):
        for p in range(columns):
            out[i, p] = right[i, p]
        for n in (0, 2, 4):
            j = neighbours[i, n]
            if j >= 0:
                g = links[i, n]
                for p in range(columns):
                    out[i, p] += g * out[j, p]
        for p in range(columns):
            out[i, p] *= inverse[i]
    for p in range(columns):
        products[p] = 0.0
    for i in range(cells - 1, -1, -1):
        for n in (1, 3, 5):
            j = neighbours[i, n]
            if j >= 0:
                g = links[i, n] * inverse[i]
                for p in range(columns):
                    out[i, p] += g * out[j, p]
        for p in range(columns):
            products[p] += right[i, p] * out[i, p]


@njit(cache=True, short_loops=True)
def _iterate(diagonal, inverse, neighbours, links, x, enough, most, fields, sums):
    """Conjugate gradients on every column of x (N, P), in place, until no residual's square is above what is enough
    (P,). fields: four (N, P), the residual and room of which the last is zero. sums: four (P,) of ones, room. Returns
    the iterations taken, -1 where too many."""
    cells, columns = x.shape
    residual, product, better, direction = fields
    old, new, step, rest = sums
    for p in range(columns):
        rest[p] = 0.0
    for i in range(cells):
        for p in range(columns):
            rest[p] += residual[i, p] * residual[i, p]
    for iteration in range(most):
        done = True
        for p in range(columns):
            if rest[p] > enough[p]:
                done = False
        if done:
            return iteration
        _precondition(inverse, neighbours, links, residual, better, new)
        for p in range(columns):
            step[p] = new[p] / old[p] if old[p] > 0 else 0.0
        for i in range(cells):
            for p in range(columns):
                direction[i, p] = better[i, p] + step[p] * direction[i, p]
        _multiply(diagonal, neighbours, links, direction, product, step)
        for p in range(columns):
            old[p], rest[p] = new[p], 0.0
            step[p] = new[p] / step[p] if step[p] > 0 else 0.0
        for i in range(cells):
            for p in range(columns):
                x[i, p] += step[p] * direction[i, p]
                residual[i, p] -= step[p] * product[i, p]
                rest[p] += residual[i, p] * residual[i, p]
    return -1
