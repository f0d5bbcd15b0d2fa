"""Residues of a passive network by least squares: each positive semidefinite.

Under that constraint the least squares are solved by alternating directions (Boyd et al., Found. Trends Mach. Learn. 3,
2011), in the same few steps whatever the body: no search, and what comes out is passive by construction.
"""

from __future__ import annotations

import math

import numpy as np

from thermograsp.compiled import njit

_STEPS = 20
_PENALTY = 5e-3  # of leaving the cone, beside columns of unit length
_RIDGE = 1e-4  # of the first guess, without constraint
_RELAXED = 1.6
_ROUND_OFF = 1e-24  # of squares off the diagonal beside those on it


def passive_residues(columns: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """(K, N, N) positive semidefinite, whose sum with the columns (S, K) is nearest to what is wanted (S, N, N)."""
    size = np.sqrt(np.sum(columns**2, axis=0))
    columns = columns / size
    normal = columns.T @ columns
    seen = np.tensordot(columns.T, wanted, axes=1)
    eye = np.eye(columns.shape[1])
    solve = np.linalg.inv(normal + _PENALTY * eye)
    inside = np.tensordot(np.linalg.inv(normal + _RIDGE * eye), seen, axes=1)
    _in_cone(solve, seen, inside)
    return inside / size[:, None, None]


@njit(cache=True, error_model="numpy")
def _in_cone(solve, seen, inside):
    """Turns the first guess inside (K, N, N) into the answer. solve: (K, K). seen: (K, N, N)."""
    rates, ports = len(seen), seen.shape[1]
    dual = np.zeros_like(seen)
    pulled, placed = np.empty_like(seen), np.empty_like(seen)
    one, turn = np.empty((ports, ports)), np.empty((ports, ports))
    for _ in range(_STEPS):
        pulled[:] = seen + _PENALTY * (inside - dual)
        for k in range(rates):
            for i in range(ports):
                for j in range(i + 1):
                    free = 0.0
                    for m in range(rates):
                        free += solve[k, m] * pulled[m, i, j]
                    one[i, j] = _RELAXED * free + (1 - _RELAXED) * inside[k, i, j] + dual[k, i, j]
                    one[j, i] = one[i, j]
            dual[k] = one
            _turn(one, turn)
            for i in range(ports):
                for j in range(ports):
                    value = 0.0
                    for m in range(ports):
                        if one[m, m] > 0:
                            value += turn[i, m] * one[m, m] * turn[j, m]
                    placed[k, i, j] = value
        inside[:] = placed
        dual -= inside


@njit(cache=True, error_model="numpy")
def _turn(matrix, turn):
    """Diagonalises a symmetric matrix in place by Jacobi's rotations; turn: its eigenvectors in columns."""
    n = len(matrix)
    for i in range(n):
        for j in range(n):
            turn[i, j] = 1.0 if i == j else 0.0
    for _ in range(30):
        off, on = 0.0, 0.0
        for i in range(n):
            on += matrix[i, i] * matrix[i, i]
            for j in range(i):
                off += matrix[i, j] * matrix[i, j]
        if off <= _ROUND_OFF * on:
            return
        for p in range(n - 1):
            for q in range(p + 1, n):
                if matrix[p, q] == 0.0:
                    continue
                ratio = (matrix[q, q] - matrix[p, p]) / (2 * matrix[p, q])
                tangent = 1 / (abs(ratio) + math.sqrt(ratio * ratio + 1))
                if ratio < 0:
                    tangent = -tangent
                cosine = 1 / math.sqrt(tangent * tangent + 1)
                sine = tangent * cosine
                for k in range(n):
                    a, b = matrix[k, p], matrix[k, q]
                    matrix[k, p], matrix[k, q] = cosine * a - sine * b, sine * a + cosine * b
                for k in range(n):
                    a, b = matrix[p, k], matrix[q, k]
                    matrix[p, k], matrix[q, k] = cosine * a - sine * b, sine * a + cosine * b
                for k in range(n):
                    a, b = turn[k, p], turn[k, q]
                    turn[k, p], turn[k, q] = cosine * a - sine * b, sine * a + cosine * b
