"""The kernel along an axis between the functions of one patch (patterns.py) where no end is near, of any patch: a
function of the diffusion length over the patch's half width alone, from a table.

A: axes, F: functions, E: nodes, M: combinations, T: times.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from thermograsp.compiled import njit
from thermograsp.lanes import LANES, put_sum

from .axis import free_kernels
from .patterns import EACH_FUNCTION, JUMPS, NODES

_FIRST, _LAST = -18, 14  # ln of diffusivity times time over the half width squared
_FINE = 16  # nodes a unit of it
_NEAR = 6  # nodes of an interpolation: what it leaves is 1e-8 of the value
_SEPARATION = tuple(1 / math.prod(a - b for b in range(_NEAR) if b != a) for a in range(_NEAR))


@lru_cache(maxsize=1)
def alone_table() -> np.ndarray:
    """(nodes, F (F + 1) / 2) of a patch of half width 1, one of a pair of functions; zeros fill the last lanes."""
    taus = np.exp(_FIRST + np.arange((_LAST - _FIRST) * _FINE + 1) / _FINE)
    found = free_kernels(np.ones((1, 2)), np.tile(JUMPS, (1, 2, 1, 1)), NODES, taus)[0, 0]
    pairs = found[np.tril_indices(len(JUMPS))].T
    return np.ascontiguousarray(np.pad(pairs, ((0, 0), (0, -pairs.shape[1] % LANES))))


def alone(half: np.ndarray, shares: np.ndarray, taus: np.ndarray) -> np.ndarray:
    """(A, M, M, T) m of a patch of half widths (A,) m between combinations, of shares (A, M, F) along these axes, at
    taus (T,) m2, ascending."""
    found = np.empty((len(half), shares.shape[1], shares.shape[1], len(taus)))
    if _between(alone_table(), half, shares, taus, found):
        return found
    both, jumps = np.tile(half[:, None], 2), np.tile((shares @ JUMPS)[:, None], (1, 2, 1, 1))
    return free_kernels(both, jumps, NODES, taus)[:, 0].copy()  # of no usual sensor


@lru_cache(maxsize=1024)
def each_alone(half: float, begun: float, spacing: float, count: int) -> np.ndarray:
    """(F, F, T) m between the functions along an axis of half width m, at so many times from begun m2 on, apart by
    that spacing in the logarithm."""
    return alone(np.array([half]), EACH_FUNCTION[:1], begun * np.exp(spacing * np.arange(count)))[0]


@njit(cache=True, inner=True, error_model="numpy")
def compiled_alone(table, function_jumps, nodes, half, shares, taus, found):
    """Fills found (A, M, M, T) with what alone tells. table: alone_table. function_jumps: JUMPS. nodes: NODES."""
    if _between(table, half, shares, taus, found):
        return
    both, jumps = np.empty((1, 2)), np.zeros((1, 2, shares.shape[1], len(nodes)))
    for axis in range(len(half)):
        both[:] = half[axis]
        for m in range(shares.shape[1]):
            for e in range(len(nodes)):
                jumps[0, 0, m, e] = jumps[0, 1, m, e] = np.sum(shares[axis, m] * function_jumps[:, e])
        found[axis] = free_kernels(both, jumps, nodes, taus)[0, 0]


@njit(cache=True, short_loops=True, error_model="numpy")
def _between(table, half, shares, taus, found):
    """Fills found by interpolation. Whether all is in the table."""
    functions, kept = shares.shape[2], shares.shape[1]
    weights, pairs, part = np.empty(_NEAR), np.empty(table.shape[1]), np.empty(functions)
    whole = np.empty((functions, functions))
    for w in range(len(half)):
        plain = kept == functions  # or they are the functions themselves
        for m in range(kept):
            for f in range(functions):
                plain &= shares[w, m, f] == (1.0 if m == f else 0.0)
        for t in range(len(taus)):
            place = (math.log(taus[t] / (half[w] * half[w])) - _FIRST) * _FINE
            if not _NEAR <= place < len(table) - _NEAR:
                return False
            first = int(place) - _NEAR // 2 + 1
            for a in range(_NEAR):
                weight = half[w] * _SEPARATION[a]
                for b in range(_NEAR):
                    weight *= 1.0 if b == a else place - first - b
                weights[a] = weight
            for i in range(0, len(pairs), LANES):
                put_sum(pairs, i, table, first * len(pairs) + i, len(pairs), weights, 0, _NEAR)
            i = 0
            for f in range(functions):
                for g in range(f + 1):
                    whole[f, g] = whole[g, f] = pairs[i]
                    if plain:
                        found[w, f, g, t] = found[w, g, f, t] = pairs[i]
                    i += 1
            for m in range(0 if plain else kept):
                for g in range(functions):
                    part[g] = 0.0
                for f in range(functions):
                    share = shares[w, m, f]
                    for g in range(functions if share != 0.0 else 0):
                        part[g] += share * whole[f, g]
                for n in range(m + 1):
                    value = 0.0
                    for g in range(functions):
                        value += part[g] * shares[w, n, g]
                    found[w, m, n, t] = found[w, n, m, t] = value
    return True
