"""Outputs of networks as rows on their states."""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit

from .symmetric import factor, solve_factored, solve_singular

_RIDGE = 1e-13  # of the largest square: what is that small is not known


def output_row(
    moments: np.ndarray,
    transfer: np.ndarray,
    rates: np.ndarray,
    ports: np.ndarray,
    weight: np.ndarray,
    total: np.ndarray | None = None,
) -> np.ndarray:
    """(n,) on states (n,) with ports (n, N), by least squares of an output's transfer (S, N) from the ports at moments
    (S,) 1/s, weighted (S,), and a
    little by its size; such that its jump with a unit heat at each port is exactly total (N,), where given."""
    exact = total is not None
    jump = total if exact else np.zeros(ports.shape[1])
    return least_row(
        moments, np.ascontiguousarray(transfer), rates, np.ascontiguousarray(ports), weight, jump, exact
    )


@njit(cache=True, error_model="numpy")
def least_row(moments, transfer, rates, ports, weight, total, exact):
    """The same as output_row, for compiled callers. exact: whether the jump is."""
    samples, (states, count) = len(moments), ports.shape
    # states that fade alike are seen alike
    rate, alike = 0, np.zeros(states, np.int64)
    for n in range(1, states):
        rate += rates[n] != rates[n - 1]
        alike[n] = rate
    seen, along = np.empty((rate + 1, samples)), np.zeros((count, rate + 1))
    for n in range(states):
        for s in range(samples):
            seen[alike[n], s] = weight[s] / (moments[s] + rates[n])
    for p in range(count):
        for k in range(rate + 1):
            for s in range(samples):
                along[p, k] += weight[s] * transfer[s, p] * seen[k, s]
    together = np.zeros((rate + 1, rate + 1))
    for k in range(rate + 1):
        for m in range(k + 1):
            for s in range(samples):
                together[k, m] += seen[k, s] * seen[m, s]
    # what is wanted, and what heat at each port pushes
    both, square, size = np.zeros((1 + count, states)), np.empty((states, states)), 0.0
    for n in range(states):
        k = alike[n]
        for m in range(n + 1):
            shared = 0.0
            for p in range(count):
                shared += ports[n, p] * ports[m, p]
            square[n, m] = shared * together[k, alike[m]]
        size += square[n, n]
        for p in range(count):
            both[0, n] += along[p, k] * ports[n, p]
            both[1 + p, n] = ports[n, p]
    for n in range(states):
        square[n, n] += _RIDGE * size
    factor(square)
    for c in range(1 + count if exact else 1):
        solve_factored(square, both[c])
    row = both[0]
    if not exact:
        return row
    # the second time it is what rounding has left of the jump
    for again in range(2):
        normal, left = np.zeros((count, count)), np.empty(count)
        for p in range(count):
            left[p] = -total[p]
            for n in range(states):
                left[p] += ports[n, p] * row[n]
            for q in range(count):
                for n in range(states):
                    normal[p, q] += ports[n, p] * (both[1 + q, n] if again == 0 else ports[n, q])
        solve_singular(normal, left)
        for p in range(count):
            for n in range(states):
                row[n] -= left[p] * (both[1 + p, n] if again == 0 else ports[n, p])
    return row
