"""Outputs of networks as rows on their states."""

from __future__ import annotations

import numpy as np

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
    seen = weight[:, None] / (moments[:, None] + rates)
    square = (ports @ ports.T) * (seen.T @ seen)
    wanted = ((seen.T @ (weight[:, None] * transfer)) * ports).sum(axis=1)
    square[np.diag_indices_from(square)] += _RIDGE * np.trace(square)
    if total is None:
        return np.linalg.solve(square, wanted)
    both = np.linalg.solve(square, np.column_stack((wanted, ports)))
    row, pushed = both[:, 0], both[:, 1:]
    row = row - pushed @ np.linalg.lstsq(ports.T @ pushed, ports.T @ row - total, rcond=1e-12)[0]
    # what rounding has left of the jump
    return row - np.linalg.lstsq(ports.T, ports.T @ row - total, rcond=1e-12)[0]
