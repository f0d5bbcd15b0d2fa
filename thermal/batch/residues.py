"""Any passive network on rates that all networks share: residues by least squares, positive semidefinite.

The residues are found under that constraint by alternating directions (Boyd et al., Found. Trends Mach. Learn. 3,
2011), in the same few steps whatever the network, so that what comes out is passive by construction.

S: moments, K: rates, N: ports, C: columns.
"""

from __future__ import annotations

import numpy as np

from ..numerics import passive_residues

MOMENTS = np.geomspace(1 / 100, 300, 24)  # 1/s
_ROWS_RIDGE = 1e-9


def residues(rates: np.ndarray, ports: np.ndarray, shared: np.ndarray, contact: float) -> np.ndarray:
    """(K, N, N) K/J on the shared rates (K,) 1/s of a network's states (n,) with ports (n, N). contact: K/W beside
    which errors are weighed."""
    answer = 1 / (MOMENTS[:, None] + rates)
    impedance = np.einsum("sn,ni,nj->sij", answer, ports, ports)
    weight = 1 / (impedance.trace(axis1=1, axis2=2) / ports.shape[1] + contact)
    return passive_residues(weight[:, None] / (MOMENTS[:, None] + shared), weight[:, None, None] * impedance)


def rows(rates: np.ndarray, columns: np.ndarray, shared: np.ndarray) -> np.ndarray:
    """(K, C): sums of columns (n, C) over the states (n,) that fade at rates 1/s, on the shared rates (K,), with the
    same totals."""
    transfer = (1 / (MOMENTS[:, None] + rates)) @ columns
    weight = np.sqrt(MOMENTS)
    basis = weight[:, None] / (MOMENTS[:, None] + shared)
    size, count = np.sqrt(np.sum(basis**2, axis=0)), len(shared)
    basis = basis / size
    matrix = np.zeros((count + 1, count + 1))
    matrix[:count, :count] = basis.T @ basis + _ROWS_RIDGE * np.eye(count)
    matrix[:count, count] = matrix[count, :count] = 1 / size
    wanted = np.concatenate((basis.T @ (weight[:, None] * transfer), columns.sum(axis=0)[None]))
    return np.linalg.solve(matrix, wanted)[:count] / size[:, None]
