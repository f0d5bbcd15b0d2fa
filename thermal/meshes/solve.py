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
    fields, sums = tuple(np.empty((4, *x.shape))), tuple(np.empty((5, x.shape[1])))
    count = _iterate(
        *(diagonal, pivots, grid.neighbours, grid.links, right, x, tolerance, _MOST_ITERATIONS, fields, sums)
    )
    if count < 0:
        raise SimulationError(
            f"the temperatures of a mesh's grid of {len(diagonal)} cells did not settle in {_MOST_ITERATIONS} "
            f"iterations at {s:g} 1/s"
        )
    return x


def conduct(grid: MeshGrid, fields: np.ndarray) -> np.ndarray:
    """Heat flow (N, P) W out of each cell by conduction at temperatures (N, P)."""
    out = np.empty(fields.shape)
    _multiply(grid.links.sum(axis=1), grid.neighbours, grid.links, np.ascontiguousarray(fields), out)
    return out


@njit(cache=True)
def _multiply(diagonal, neighbours, links, x, out):
    cells, columns = x.shape
    for i in range(cells):
        for p in range(columns):
            out[i, p] = diagonal[i] * x[i, p]
        for n in range(6):
            j = neighbours[i, n]
            if j >= 0:
                g = links[i, n]
                for p in range(columns):
                    out[i, p] -= g * x[j, p]


@njit(cache=True)
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
def _precondition(inverse, neighbours, links, right, out):
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
    for i in range(cells - 1, -1, -1):
        for n in (1, 3, 5):
            j = neighbours[i, n]
            if j >= 0:
                g = links[i, n] * inverse[i]
                for p in range(columns):
                    out[i, p] += g * out[j, p]


@njit(cache=True, inner=True)
def _dots(a, b, out):
    for p in range(a.shape[1]):
        out[p] = 0.0
    for i in range(a.shape[0]):
        for p in range(a.shape[1]):
            out[p] += a[i, p] * b[i, p]


@njit(cache=True)
def _iterate(diagonal, inverse, neighbours, links, right, x, tolerance, most, fields, sums):
    """Conjugate gradients on every column; x (N, P) in place. fields: four (N, P) and sums: five (P,), room. Returns
    the iterations taken, -1 where too many."""
    columns = x.shape[1]
    residual, product, better, direction = fields
    _multiply(diagonal, neighbours, links, x, product)
    for i in range(x.shape[0]):  # written out: it takes a second less to compile
        for p in range(columns):
            residual[i, p] = right[i, p] - product[i, p]
            direction[i, p] = 0.0
    whole, rest, old, new, curve = sums
    _dots(right, right, whole)
    for p in range(columns):
        old[p] = 1.0
    for iteration in range(most):
        _dots(residual, residual, rest)
        done = True
        for p in range(columns):
            if rest[p] > tolerance**2 * whole[p]:
                done = False
        if done:
            return iteration
        _precondition(inverse, neighbours, links, residual, better)
        _dots(residual, better, new)
        for i in range(x.shape[0]):
            for p in range(columns):
                ratio = new[p] / old[p] if iteration and old[p] > 0 else 0.0
                direction[i, p] = better[i, p] + ratio * direction[i, p]
        _multiply(diagonal, neighbours, links, direction, product)
        _dots(direction, product, curve)
        for p in range(columns):
            old[p] = new[p]
            new[p] = new[p] / curve[p] if curve[p] > 0 else 0.0
        for i in range(x.shape[0]):
            for p in range(columns):
                x[i, p] += new[p] * direction[i, p]
                residual[i, p] -= new[p] * product[i, p]
    return -1
