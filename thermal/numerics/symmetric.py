"""Small symmetric matrices: triangular factors, eigenvectors, many at once or one.

N: rows, K: matrices.
"""

from __future__ import annotations

import math

import numpy as np

from thermograsp.compiled import njit
from thermograsp.lanes import LANES, rotate, take_products

from .fastmath import FAST

_ROUND_OFF = 1e-24
"""Of squares off the diagonal beside those on it, in every step. With more left on the way, round-off decided how much:
of 1e-15 in what is wanted came 9e-6 in what is found."""
_TINY = 1e-300  # beside a zero
_UNSEEN = 1e-12  # of the largest eigenvalue, up to which one counts as none


@njit(cache=True, inner=True, borrows=True, error_model="numpy", fastmath=FAST, forceinline=True)
def dot(first, second):
    """The sum of two rows' products."""
    total = 0.0
    for k in range(len(first)):
        total += first[k] * second[k]
    return total


@njit(cache=True, inner=True, borrows=True, error_model="numpy", fastmath=FAST, forceinline=True)
def factor(matrix):
    """Turns the lower half of a positive definite matrix into its triangular factor, with 1 / its diagonal."""
    count = len(matrix)
    for p in range(count):
        for j in range(p + 1):
            left = matrix[p, j]
            for k in range(j):
                left -= matrix[p, k] * matrix[j, k]
            matrix[p, j] = 1 / math.sqrt(left) if j == p else left * matrix[j, j]


@njit(cache=True, inner=True, borrows=True, error_model="numpy", fastmath=FAST, forceinline=True)
def solve_factored(lower, column):
    """Turns a column (N,) into the solution. lower: factor's."""
    count = len(column)
    for i in range(count):
        left = column[i]
        for k in range(i):
            left -= lower[i, k] * column[k]
        column[i] = left * lower[i, i]
    for i in range(count - 1, -1, -1):
        column[i] *= lower[i, i]
        for k in range(i):
            column[k] -= lower[i, k] * column[i]


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def solve_many(matrices, columns):
    """Turns columns (N, K) into the solutions of positive definite matrices (N, N, K), of which it uses up the lower
    half. K: whole lanes."""
    count, many = columns.shape
    row = count * many
    for p in range(count):
        for j in range(p + 1):
            at = p * row + j * many
            for k in range(0, many, LANES):
                take_products(matrices, at + k, matrices, p * row + k, matrices, j * row + k, many, j)
            for k in range(many):
                left = matrices[p, j, k]
                matrices[p, j, k] = 1 / math.sqrt(left) if j == p else left * matrices[j, j, k]
    for i in range(count):
        for k in range(0, many, LANES):
            take_products(columns, i * many + k, matrices, i * row + k, columns, k, many, i)
        for k in range(many):
            columns[i, k] *= matrices[i, i, k]
    for i in range(count - 1, -1, -1):
        for k in range(many):
            columns[i, k] *= matrices[i, i, k]
        for j in range(i):
            for k in range(many):
                columns[j, k] -= matrices[i, j, k] * columns[i, k]


@njit(cache=True, inner=True, error_model="numpy")
def solve_singular(matrix, column):
    """Turns a column (N,) into the shortest solution of a symmetric matrix's equations that is nowhere negative."""
    count = len(column)
    turned, turn = np.zeros((count, count, LANES)), np.zeros((count, count, LANES))
    along = np.zeros(count)
    for i in range(count):
        turn[i, i, 0] = 1.0
        for j in range(count):
            turned[i, j, 0] = matrix[i, j]
    turn_diagonal(turned, turn, np.empty((4, LANES)))
    largest = 0.0
    for i in range(count):
        largest = max(largest, turned[i, i, 0])
    for i in range(count):
        if turned[i, i, 0] > _UNSEEN * largest:
            for j in range(count):
                along[i] += turn[i, j, 0] * column[j]
            along[i] /= turned[i, i, 0]
    for j in range(count):
        column[j] = 0.0
        for i in range(count):
            column[j] += turn[i, j, 0] * along[i]


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def turn_diagonal(matrix, turn, room):
    """Diagonalises symmetric matrices (N, N, K), of which it reads and writes the lower half, by Jacobi's rotations,
    which it adds to turn's rows. K: whole lanes. room: (4, K)."""
    ports, rates = matrix.shape[1], matrix.shape[2]
    cosine, sine, off, on = room[0], room[1], room[2], room[3]
    row = ports * rates
    for _ in range(30):
        for k in range(rates):
            off[k] = on[k] = 0.0
        for i in range(ports):
            for k in range(rates):
                on[k] += matrix[i, i, k] * matrix[i, i, k]
            for j in range(i):
                for k in range(rates):
                    off[k] += matrix[i, j, k] * matrix[i, j, k]
        done = True
        for k in range(rates):
            done &= off[k] <= _ROUND_OFF * on[k]
            on[k] *= _ROUND_OFF / (ports * ports)
        if done:
            return
        for q in range(1, ports):
            for p in range(q):
                small = True
                for k in range(rates):
                    small &= matrix[q, p, k] * matrix[q, p, k] <= on[k]
                if small:
                    continue
                _angle(matrix[p, p], matrix[q, q], matrix[q, p], cosine, sine)
                between, behind = q - p - 1, ports - q - 1
                for k in range(0, rates, LANES):
                    first, last = p * row + k, q * row + k
                    at, beside = first + row + p * rates, last + (p + 1) * rates
                    rotate(matrix, first, rates, last, rates, cosine, k, sine, k, p)
                    rotate(matrix, at, row, beside, rates, cosine, k, sine, k, between)
                    below = last + row
                    rotate(matrix, below + p * rates, row, below + q * rates, row, cosine, k, sine, k, behind)
                    rotate(turn, first, rates, last, rates, cosine, k, sine, k, ports)


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _angle(first, second, between, cosine, sine):
    """Cosines and sines of the rotations that make between (K,) 0, and the diagonal after them; all in place."""
    for k in range(len(between)):
        twice, gap = 2 * between[k], second[k] - first[k]
        size = abs(gap) + np.sqrt(gap * gap + twice * twice) + _TINY
        tangent = math.copysign(twice / size, gap * twice)
        cosine[k] = 1 / np.sqrt(tangent * tangent + 1)
        sine[k] = tangent * cosine[k]
        first[k] -= tangent * between[k]
        second[k] += tangent * between[k]
        between[k] = 0.0
