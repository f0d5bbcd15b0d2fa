"""Outputs of networks as rows on their states."""

from __future__ import annotations

import numpy as np


def output_row(
    moments: np.ndarray,
    transfer: np.ndarray,
    rates: np.ndarray,
    ports: np.ndarray,
    weight: np.ndarray,
    total: np.ndarray | None = None,
) -> np.ndarray:
    """(n,) on states (n,) with ports (n, N), by least squares of an output's transfer (S, N) from the ports at moments
    (S,) 1/s, weighted (S,); such that its jump with a unit heat at each port is exactly total (N,), where given."""
    columns = weight[:, None, None] * ports / (moments[:, None, None] + rates[:, None])
    matrix = columns.transpose(0, 2, 1).reshape(-1, len(rates))
    wanted = (weight[:, None] * transfer).reshape(-1)
    if total is None:
        return np.linalg.lstsq(matrix, wanted, rcond=1e-7)[0]
    least = np.linalg.lstsq(ports.T, total, rcond=1e-12)[0]
    _, values, vectors = np.linalg.svd(ports.T)
    free = vectors[np.count_nonzero(values > 1e-12 * values[0]) :].T
    added = np.linalg.lstsq(matrix @ free, wanted - matrix @ least, rcond=1e-7)[0]
    return least + free @ added
