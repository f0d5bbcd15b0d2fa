"""The step of coupling.py compiled row by row: a row's result does not depend on how many rows there are."""

from __future__ import annotations

import numpy as np
from numba import njit

from .coupling import POLES, WEIGHTS

_PAIRS = len(POLES)
_LAGS = WEIGHTS / POLES


@njit(cache=True, fastmath=False, error_model="numpy")
def advance(
    rates: np.ndarray,
    ports: np.ndarray,
    scale: np.ndarray,
    gram: np.ndarray,
    dt: float,
    state: np.ndarray,
    conductance: np.ndarray,
    difference: np.ndarray,
    flow: np.ndarray,
    watched: int,
) -> float:
    """One step of one system, in place. rates (n,), ports (n, M), scale (Q, n), gram (Q, M, M), state (n,), conductance
    and difference (M,), flow (M,): filled with the mean heat flow W during the step. Returns the mean during the step of
    the state of index `watched`."""
    n, m = ports.shape
    rate = np.empty(n)
    seen = np.empty(m)
    gathered = np.empty(m, np.complex128)
    matrix = np.empty((m, m), np.complex128)
    change = np.empty(n)
    lagged = np.empty(m)
    watched_lag = 0.0
    seen[:] = 0.0
    for i in range(n):
        for j in range(m):
            seen[j] += ports[i, j] * state[i]
    for i in range(n):
        total = -rates[i] * state[i]
        for j in range(m):
            total += ports[i, j] * conductance[j] * (difference[j] - seen[j])
        rate[i] = total
        change[i] = 0.0
    lagged[:] = 0.0
    for q in range(_PAIRS):
        gathered[:] = 0.0
        for i in range(n):
            scaled = scale[q, i] * rate[i]
            for j in range(m):
                gathered[j] += ports[i, j] * scaled
        for j in range(m):
            weight = dt * conductance[j]
            for k in range(m):
                matrix[j, k] = weight * gram[q, j, k]
            matrix[j, j] += 1.0
            lagged[j] += (_LAGS[q] * gathered[j]).real
            gathered[j] *= weight
        _solve(matrix, gathered)
        for i in range(n):
            pulled = 0.0 + 0.0j
            for j in range(m):
                pulled += ports[i, j] * gathered[j]
            solved = scale[q, i] * (rate[i] - pulled)
            change[i] += (WEIGHTS[q] * solved).real
            if i == watched:
                watched_lag += (_LAGS[q] * solved).real
        for j in range(m):
            back = 0.0 + 0.0j
            for k in range(m):
                back += gram[q, j, k] * gathered[k]
            lagged[j] -= (_LAGS[q] * back).real
    for j in range(m):
        flow[j] = conductance[j] * (difference[j] - seen[j] + 2 * dt * lagged[j])
    mean = state[watched] - 2 * dt * watched_lag
    for i in range(n):
        state[i] -= 2 * dt * change[i]
    return mean


@njit(cache=True, error_model="numpy")
def _solve(matrix: np.ndarray, vector: np.ndarray) -> None:
    """Solves matrix x = vector in place by elimination with row pivoting."""
    m = vector.shape[0]
    for c in range(m):
        pivot, largest = c, -1.0
        for r in range(c, m):
            size = abs(matrix[r, c].real) + abs(matrix[r, c].imag)
            if size > largest:
                pivot, largest = r, size
        if pivot != c:
            for k in range(c, m):
                matrix[c, k], matrix[pivot, k] = matrix[pivot, k], matrix[c, k]
            vector[c], vector[pivot] = vector[pivot], vector[c]
        inverse = 1.0 / matrix[c, c]
        for r in range(c + 1, m):
            factor = matrix[r, c] * inverse
            for k in range(c + 1, m):
                matrix[r, k] -= factor * matrix[c, k]
            vector[r] -= factor * vector[c]
    for c in range(m - 1, -1, -1):
        total = vector[c]
        for k in range(c + 1, m):
            total -= matrix[c, k] * vector[k]
        vector[c] = total / matrix[c, c]
