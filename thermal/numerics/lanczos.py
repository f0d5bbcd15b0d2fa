"""The largest eigenvalues of a large symmetric operator, by Lanczos' method on blocks of vectors.

Every block is made orthogonal to all before it, which costs products of matrices in place of products with vectors, and
finds eigenvalues as often as they are (Golub & Van Loan, Matrix Computations, 4th ed., 10.3.6).

N: unknowns, R: eigenvalues.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg import eigh

_BLOCK = 16
_FIRST = (
    2.6  # times the eigenvalues that are asked for, so many vectors before the first look at what is found
)
_MORE = 64  # vectors, until the next look
_DENSE = 4  # times the eigenvalues: of fewer unknowns all are found at once


def largest_eigenvalues(
    operator: Callable[[np.ndarray], np.ndarray], unknowns: int, count: int, accuracy: float
) -> tuple[np.ndarray, np.ndarray]:
    """(R,) the largest first, and eigenvectors (N, R), orthonormal. operator: symmetric and positive, of the columns of
    (N, any). accuracy: the residual of each over its eigenvalue, at most, whose square the eigenvalue errs by."""
    if unknowns <= _DENSE * count:
        whole = operator(np.eye(unknowns))
        return _largest((whole + whole.T) / 2, count)
    space, projected = np.empty((_DENSE * count, unknowns)), np.zeros((_DENSE * count, _DENSE * count))
    start = np.random.default_rng(0).standard_normal((unknowns, _BLOCK))  # the same bits each time
    space[:_BLOCK] = np.linalg.qr(start)[0].T
    size, look = _BLOCK, int(_FIRST * count)
    while True:
        last = slice(size - _BLOCK, size)
        found = np.ascontiguousarray(operator(space[last].T).T)
        couplings = np.zeros((_BLOCK, size))
        for first in (max(size - 2 * _BLOCK, 0), 0):  # all but these two blocks differ from 0 by round-off
            within = found @ space[first:size].T
            found -= within @ space[first:size]
            couplings[:, first:] += within
        projected[last, :size], projected[:size, last] = couplings, couplings.T
        following, rest = np.linalg.qr(found.T)
        if size >= look:
            look = size + _MORE
            # the smallest is the last to be exact, and one takes a third of the time of all
            least, vector = eigh(projected[:size, :size], subset_by_index=(size - count, size - count))
            if np.linalg.norm(rest @ vector[last]) <= accuracy * least[0]:
                values, vectors = _largest(projected[:size, :size], count)
                if np.all(np.linalg.norm(rest @ vectors[last], axis=0) <= accuracy * values):
                    return values, space[:size].T @ vectors
        if size + _BLOCK > len(space):
            space = np.concatenate((space, np.empty_like(space)))
            projected = np.pad(projected, (0, len(projected)))
        ahead = slice(size, size + _BLOCK)
        projected[ahead, last], projected[last, ahead] = rest, rest.T
        space[ahead] = following.T
        size += _BLOCK


def _largest(matrix: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    values, vectors = np.linalg.eigh(matrix)
    return values[: -count - 1 : -1], vectors[:, : -count - 1 : -1]
