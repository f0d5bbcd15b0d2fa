"""Residues of a passive network by least squares: each positive semidefinite.

Under that constraint the least squares are solved by alternating directions (Boyd et al., Found. Trends Mach. Learn. 3,
2011), in few steps whatever the body: no search, and what comes out is passive by construction.
"""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit
from thermograsp.lanes import LANES, add_products, put_sum

from .symmetric import turn_diagonal

_STEPS = 8  # at most, the first of which only cuts off what the first guess has outside the cone
_SETTLED = 4e-4  # change of any residue in a step, beside columns of unit length, up to which it is the last
_PENALTY = 0.0134  # of leaving the cone, beside columns of unit length
_RIDGE = 1e-5  # of the first guess, without constraint; with less, round-off in what is wanted counts
_CARRIED = 0.4  # of what the first guess has outside the cone
_FREE_RIDGE = 1e-6  # of residues without constraint
_RELAXED = 1.7


def passive_residues(columns: np.ndarray, wanted: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """The same as port_residues, as (K, N, N)."""
    return np.ascontiguousarray(
        port_residues(columns, np.ascontiguousarray(wanted), weight).transpose(2, 0, 1)
    )


def port_residues(columns: np.ndarray, wanted: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """(N, N, K) positive semidefinite, whose sum with the columns (S, K) is nearest to what is wanted (S, N, N) where
    errors count by weight (S,)."""
    return _residues(columns, wanted, weight, False)


def mirrored_residues(columns: np.ndarray, wanted: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """The same, to round-off, of what is wanted between ports whose two halves could change places: what both see of
    flows that are alike and of opposite flows are two problems of half the size."""
    return _residues(columns, wanted, weight, True)


@njit(cache=True, error_model="numpy")
def _residues(*told):
    return compiled_residues(*told)


@njit(cache=True, inner=True, error_model="numpy")
def compiled_residues(columns, wanted, weight, mirrored):
    """port_residues, or mirrored_residues, whose two problems end together."""
    groups, half = 1, len(wanted[0])
    if mirrored:
        groups, half = 2, half // 2
    size, solve, seen, inside = _begun(columns, wanted, weight, groups, half)
    wide = len(size)
    _in_cone(solve, seen, inside)
    found = np.empty((groups * half, groups * half, columns.shape[1]))
    for i in range(half):
        for j in range(i + 1):
            for k in range(columns.shape[1]):
                same, across = inside[i, j, k] / size[k], 0.0
                if mirrored:
                    other = inside[i, j, wide + k] / size[k]
                    same, across = (same + other) / 2, (same - other) / 2
                for m in range(groups):  # either half sees its own flows, and the other's
                    to, beside = m * half, (groups - 1 - m) * half
                    found[to + i, beside + j, k] = found[to + j, beside + i, k] = across
                    found[to + i, to + j, k] = found[to + j, to + i, k] = same
    return found


@njit(cache=True, error_model="numpy")
def passive_states(columns, wanted, weight, rates, least):
    """Rates (n,) 1/s and ports (n, N) of the states of port_residues' network: a residue's eigenvectors, as they were
    found. rates: (K,) of the columns. least: resistance of a state that is left out. Larger ones fade as they come near
    it, so that round-off decides nothing."""
    count = len(wanted[0])
    size, solve, seen, inside = _begun(columns, wanted, weight, 1, count)
    turn, turned = _in_cone(solve, seen, inside)
    kept = 0
    for k in range(len(rates)):
        for i in range(count):
            kept += turned[i, i, k] > least * rates[k] * size[k]
    fading, ports = np.empty(kept), np.empty((kept, count))
    n = 0
    for k in range(len(rates)):
        share = least * rates[k]
        for i in range(count):
            if turned[i, i, k] > share * size[k]:
                value = turned[i, i, k] / size[k]
                fading[n] = rates[k]
                for j in range(count):
                    ports[n, j] = np.sqrt(value - share * share / value) * turn[i, j, k]
                n += 1
    return fading, ports


@njit(cache=True, inner=True, error_model="numpy")
def _begun(columns, wanted, weight, groups, half):
    """The columns' sizes (K,) at unit weight; what _in_cone takes: solve (K, K), seen and the first guess inside
    (half, half, groups K). Columns of zeros fill the last lanes."""
    samples, wide = len(columns), -(-columns.shape[1] // LANES) * LANES
    mirrored = groups > 1
    scaled, size, inverse = np.zeros((samples, wide)), np.ones(wide), np.empty((2, wide, wide))
    _inverses(columns, weight, (_RIDGE, _PENALTY), scaled, size, inverse)
    rates, values = groups * wide, np.empty(samples)
    seen, inside = np.zeros((half, half, rates)), np.zeros((half, half, rates))
    for group in range(groups):
        opposite = 1.0 - 2.0 * group
        for i in range(half):
            for j in range(i + 1):
                at = (i * half + j) * rates + group * wide
                for s in range(samples):
                    value = wanted[s, i, j]
                    if mirrored:
                        same = value + wanted[s, half + i, half + j]
                        across = wanted[s, i, half + j] + wanted[s, half + i, j]
                        value = (same + opposite * across) / 2
                    values[s] = value * weight[s]
                for n in range(0, wide, LANES):
                    put_sum(seen, at + n, scaled, n, wide, values, 0, samples)
                for n in range(0, wide, LANES):
                    put_sum(inside, at + n, inverse, n, wide, seen, at, wide)
    return size, inverse[1], seen, inside


@njit(cache=True, error_model="numpy")
def free_residues(columns, weight):
    """(S, K), which turns what is wanted (S,) into residues (K,) of any sign, whose sum with the columns (S, K) is
    nearest to it, where errors count by weight (S,), but for a ridge that keeps them small."""
    samples, rates = columns.shape
    scaled, size, inverse = np.empty((samples, rates)), np.empty(rates), np.empty((1, rates, rates))
    _inverses(columns, weight, (_FREE_RIDGE,), scaled, size, inverse)
    found = np.zeros((samples, rates))
    for s in range(samples):
        for m in range(rates):
            for k in range(rates):
                found[s, k] += scaled[s, m] * inverse[0, m, k]
        for k in range(rates):
            found[s, k] *= weight[s] / size[k]
    return found


@njit(cache=True, inner=True, error_model="numpy")
def _inverses(columns, weight, ridges, scaled, size, inverse):
    """Fills scaled (S, K) with the columns (S, K) by weight (S,) at unit length, size (K,) with their lengths, and
    inverse (n, K, K) with those of the normal equations with each ridge. Columns beyond those that there are stay."""
    samples, rates = columns.shape
    normal = np.zeros((len(size), len(size)))
    for k in range(rates):
        square = 0.0
        for s in range(samples):
            scaled[s, k] = weight[s] * columns[s, k]
            square += scaled[s, k] * scaled[s, k]
        size[k] = np.sqrt(square)
        for s in range(samples):
            scaled[s, k] /= size[k]
    for s in range(samples):
        for k in range(rates):
            for m in range(rates):
                normal[k, m] += scaled[s, k] * scaled[s, m]
    for which in range(len(ridges)):  # one call of it compiles sooner than three
        _inverse(normal, ridges[which], inverse[which])


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _inverse(matrix, ridge, out):
    """Fills out with the inverse of a matrix that is symmetric and nowhere negative, plus a ridge on its diagonal."""
    count = len(matrix)
    for i in range(count):
        for j in range(count):
            out[i, j] = matrix[i, j]
        out[i, i] += ridge
    for p in range(count):
        pivot = 1 / out[p, p]
        out[p, p] = 1.0
        for j in range(count):
            out[p, j] *= pivot
        for i in range(count):
            if i != p:
                factor = out[i, p]
                out[i, p] = 0.0
                for j in range(count):
                    out[i, j] -= factor * out[p, j]


@njit(cache=True, inner=True, error_model="numpy")
def _in_cone(solve, seen, inside):
    """Turns the first guess inside (N, N, G K) into the answer; of these and of seen (N, N, G K) it looks at the lower
    half. solve: (K, K) symmetric. Returns the answer's eigenvectors (N, N, G K) in rows, and on a diagonal its
    eigenvalues, of which it has those above 0."""
    ports, rates, each = seen.shape[1], seen.shape[2], len(solve)
    dual, moved = np.zeros_like(seen), np.empty_like(seen)
    turn, half = np.zeros_like(seen), np.empty_like(seen)  # eigenvector, component
    pulled, free, room = np.empty(rates), np.empty(rates), np.empty((4, rates))
    row = ports * rates
    for i in range(ports):
        turn[i, i] = 1.0
    for step in range(_STEPS):
        for i in range(ports):
            for j in range(i + 1):
                if step == 0:
                    for k in range(rates):
                        dual[i, j, k] = dual[j, i, k] = inside[i, j, k]
                    continue
                for k in range(rates):
                    pulled[k] = seen[i, j, k] + _PENALTY * (inside[i, j, k] - dual[i, j, k])
                for first in range(0, rates, each):
                    for n in range(0, each, LANES):
                        put_sum(free, first + n, solve, n, each, pulled, first, each)
                for k in range(rates):
                    value = _RELAXED * free[k] + (1 - _RELAXED) * inside[i, j, k] + dual[i, j, k]
                    dual[i, j, k] = dual[j, i, k] = value
        # seen from the last step's eigenvectors it is nearly diagonal
        for m in range(ports):
            for i in range(ports):
                _put_products(half, m * row + i * rates, dual, i * row, turn, m * row, rates, rates, ports)
        for i in range(ports):
            for j in range(i + 1):
                _put_products(moved, i * row + j * rates, turn, i * row, half, j * row, rates, rates, ports)
        turn_diagonal(moved, turn, room)
        for m in range(ports):
            for i in range(ports):
                for k in range(rates):
                    half[m, i, k] = max(moved[m, m, k], 0.0) * turn[m, i, k]
        moving = 0.0
        for i in range(ports):
            for j in range(i + 1):
                _put_products(free, 0, turn, i * rates, half, j * rates, row, rates, ports)
                for k in range(rates):
                    pulled[k] = abs(free[k] - inside[i, j, k])
                    inside[i, j, k] = free[k]
                    outside = dual[i, j, k] - free[k]
                    dual[i, j, k] = dual[j, i, k] = _CARRIED * outside if step == 0 else outside
                if each < rates:  # of mirrored ports, what one half's changes by
                    for k in range(each):
                        pulled[k] = (pulled[k] + pulled[each + k]) / 2
                for k in range(each):
                    moving = max(moving, pulled[k])
        if moving < _SETTLED:
            break
    return turn, moved


@njit(cache=True, inner=True, borrows=True, error_model="numpy", forceinline=True)
def _put_products(out, at, first, i, second, j, spacing, rates, count):
    """out at `at` is the sum of `count` rows of first, from i on, times those of second, from j on: rows of so many
    rates, the next of either that far apart."""
    for n in range(0, rates, LANES):
        put_sum(out, at + n, first, i + n, 0, second, j + n, 0)  # zeros
        add_products(out, at + n, first, i + n, second, j + n, spacing, count)
