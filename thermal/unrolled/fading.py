"""How heat in a few patterns fades on cells: Chebyshev moments of their operator, of which the kernel at any time is a
sum (Tal-Ezer & Kosloff, J. Chem. Phys. 81, 1984, in imaginary time).

N: cells, P: ports, D: moments, T: times.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.special import ive

from thermograsp.compiled import njit
from thermograsp.lanes import LANES, put_next

_ERROR = 14.0  # minus its logarithm, of what is left out
_PORTS = 3
_NOTHING = 1e-15  # weight of a polynomial beside 1


class Fading(NamedTuple):
    """fastest: 1/s. moments: (D, P, P) K/J."""

    fastest: float
    moments: np.ndarray

    def kernel(self, times: np.ndarray) -> np.ndarray:
        """(T, P, P) K/J at times s."""
        return np.tensordot(_weights(len(self.moments), self.fastest, times), self.moments, axes=1)


def fading(
    capacity: np.ndarray,
    neighbours: np.ndarray,
    links: np.ndarray,
    sink: np.ndarray,
    ports: np.ndarray,
    last: float,
) -> Fading:
    """capacity: (N,) J/K. neighbours: (N, 6), and links: (N, 6) W/K to them. sink: (N,) W/K. ports: (N, P), how each
    port's flow enters the cells, of three ports at most. last: s, until when."""
    scaled = _scaled(capacity, neighbours, links, sink, ports, last)
    flat = np.zeros((2 * scaled.half + 1, 6))
    _moments(scaled.diagonal, scaled.off, scaled.neighbours, scaled.x, scaled.half, flat)
    count = ports.shape[1]
    rows, columns = np.tril_indices(_PORTS)
    moments = np.zeros((len(flat), _PORTS, _PORTS))
    moments[:, rows, columns] = moments[:, columns, rows] = flat
    return Fading(scaled.fastest, moments[:, :count, :count])


def spread(
    capacity: np.ndarray,
    neighbours: np.ndarray,
    links: np.ndarray,
    sink: np.ndarray,
    ports: np.ndarray,
    times: np.ndarray,
    seen: np.ndarray,
) -> np.ndarray:
    """(T, n, P) K/J of cells seen (n,) at times s, the last the longest, after a joule through each port. Others as
    fading's."""
    scaled = _scaled(capacity, neighbours, links, sink, ports, float(times[-1]))
    weights = _weights(2 * scaled.half + 1, scaled.fastest, times)
    found = np.zeros((len(times), len(seen), _PORTS))
    itself = np.arange(len(capacity), dtype=np.int32)[:, None]
    _fields(
        np.hstack((itself, scaled.neighbours)),
        np.hstack((scaled.diagonal[:, None], scaled.off)),
        np.pad(scaled.x, ((0, 0), (0, LANES - _PORTS))),
        seen,
        weights,
        found,
    )
    return found[:, :, : ports.shape[1]] / np.sqrt(capacity[seen])[:, None]


class _Scaled(NamedTuple):
    """diagonal: (N,) and off: (N, 6) of twice the operator, scaled to -1 .. 1. x: (N, 3), what flows in at first. half:
    of the moments that are needed."""

    fastest: float
    diagonal: np.ndarray
    off: np.ndarray
    neighbours: np.ndarray
    x: np.ndarray
    half: int


def _scaled(
    capacity: np.ndarray,
    neighbours: np.ndarray,
    links: np.ndarray,
    sink: np.ndarray,
    ports: np.ndarray,
    last: float,
) -> _Scaled:
    root = 1 / np.sqrt(capacity)
    diagonal = (links.sum(axis=1) + sink) / capacity
    beside = links * root[:, None] * root[neighbours]
    fastest = float((diagonal + beside.sum(axis=1)).max())  # Gershgorin's bound
    half = math.ceil(math.sqrt(_ERROR * fastest * last) / 2) + 2
    scale = 4 / fastest
    x = np.zeros((len(capacity), _PORTS))
    x[:, : ports.shape[1]] = root[:, None] * ports
    return _Scaled(fastest, scale * diagonal - 2, -scale * beside, neighbours.astype(np.int32), x, half)


def _weights(count: int, fastest: float, times: np.ndarray) -> np.ndarray:
    """(T, D) of Chebyshev polynomials of x, whose sum is exp(-z (1 + x))."""
    orders = np.arange(count)
    signs = np.where(orders == 0, 1.0, np.where(orders % 2 == 0, 2.0, -2.0))
    return signs * ive(orders, times[:, None] * fastest / 2)


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _add_to_each(found, weights, m, now):
    """Adds to found (T, n, 3) what there is now (3 n,), by the m-th of weights (T, D)."""
    for t in range(len(found)):
        weight, total = weights[t, m], found[t].reshape(len(now))
        if abs(weight) > _NOTHING:  # soon few polynomials say all
            for i in range(len(now)):
                total[i] += weight * now[i]


@njit(cache=True, error_model="numpy", short_loops=True)
def _fields(rows, factors, x, seen, weights, found):
    """Adds to found (T, n, 3) Chebyshev polynomials of the operator on x (N, LANES), the last of which is nothing, by
    weights (T, D), in cells seen (n,). rows, factors: (N, 7), of a cell itself and its neighbours in twice the scaled
    operator."""
    old, new, now = np.zeros(x.shape), x.copy(), np.empty(3 * len(seen))
    for m in range(weights.shape[1]):
        for c in range(len(seen)):
            for p in range(3):
                now[3 * c + p] = new[seen[c], p]
        _add_to_each(found, weights, m, now)
        for i in range(len(x)):
            put_next(
                old, LANES * i, new, rows, rows.shape[1] * i, factors, factors.shape[1] * i, rows.shape[1]
            )
        if m == 0:  # the first one is half of that
            for i in range(len(x)):
                for p in range(3):
                    old[i, p] /= 2
        old, new = new, old


@njit(cache=True, error_model="numpy", short_loops=True)
def _moments(diagonal, off, neighbours, x, half, moments):
    """diagonal (N,), off (N, 6): of twice the scaled operator. x: (N, 3). moments: (2 half + 1, 6), of the six products
    of three ports."""
    n = len(x)
    old, new = x.copy(), np.empty(x.shape)
    for i in range(n):
        d = diagonal[i] / 2
        s0, s1, s2 = d * x[i, 0], d * x[i, 1], d * x[i, 2]
        for k in range(6):
            j, g = neighbours[i, k], off[i, k] / 2
            s0 += g * x[j, 0]
            s1 += g * x[j, 1]
            s2 += g * x[j, 2]
        new[i, 0], new[i, 1], new[i, 2] = s0, s1, s2
    for i in range(n):
        c = 0
        for p in range(3):
            for q in range(p + 1):
                moments[0, c] += x[i, p] * x[i, q]
                moments[1, c] += new[i, p] * x[i, q]
                c += 1
    for m in range(1, half + 1):
        a0, a1, a2, a3, a4, a5 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        b0, b1, b2, b3, b4, b5 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for i in range(n):
            d = diagonal[i]
            x0, x1, x2 = new[i, 0], new[i, 1], new[i, 2]
            s0, s1, s2 = d * x0 - old[i, 0], d * x1 - old[i, 1], d * x2 - old[i, 2]
            for k in range(6):
                j, g = neighbours[i, k], off[i, k]
                s0 += g * new[j, 0]
                s1 += g * new[j, 1]
                s2 += g * new[j, 2]
            old[i, 0], old[i, 1], old[i, 2] = s0, s1, s2
            a0 += x0 * x0
            a1 += x1 * x0
            a2 += x1 * x1
            a3 += x2 * x0
            a4 += x2 * x1
            a5 += x2 * x2
            b0 += s0 * x0
            b1 += s1 * x0
            b2 += s1 * x1
            b3 += s2 * x0
            b4 += s2 * x1
            b5 += s2 * x2
        old, new = new, old
        even, odd = (a0, a1, a2, a3, a4, a5), (b0, b1, b2, b3, b4, b5)
        for c in range(6):
            moments[2 * m, c] = 2 * even[c] - moments[0, c]
            if m < half:
                moments[2 * m + 1, c] = 2 * odd[c] - moments[1, c]
