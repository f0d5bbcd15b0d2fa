"""A passive network from an impedance and its slope at a few real moments.

It is the Galerkin projection of the body on its fields at those moments (numerics/reduction.py). So a network of one
state a moment and port has the body's impedance there, and is passive whatever the moments are.

S: moments, N: ports, n: states.
"""

from __future__ import annotations

import numpy as np

from ..numerics import Sampled, sampled_fields
from .samples import MOMENTS

_RANKS = (1e-5, 1e-6, 1e-8)
"""Shares of the largest of the fields' Gram matrix, below which its directions are left out. The first leaves out
fields that count where large contacts are on a small block in air (.1 K of 12); with the last, the samples' errors may
come in where there are many patterns. What the network says between its moments tells which serves."""


def states(
    impedance: np.ndarray, slope: np.ndarray, weight: np.ndarray, moments: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Rates (n,) 1/s and ports (n, N) sqrt(K/J), the slowest first. impedance, slope: (S, N, N) K/W
    and K s/W at MOMENTS. weight: (S,) W/K of the impedance's errors. moments: the indices of those that count."""
    value = impedance[moments]
    gram, pencil, scale = sampled_fields(MOMENTS[moments], Sampled(value, slope[moments]))
    values, vectors = np.linalg.eigh(gram)
    columns, found = value.reshape(-1, value.shape[-1]), []
    for rank in _RANKS:
        kept = values > rank * values[-1]
        basis = scale[:, None] * vectors[:, kept] / np.sqrt(values[kept])
        rates, turn = np.linalg.eigh(basis.T @ pencil @ basis)
        # what round-off makes grow is no field of the body's
        real = rates > 0
        ports = (basis @ turn[:, real]).T @ columns
        found.append((rates[real], ports))
    return min(found, key=lambda network: _misfit(impedance, network[0], network[1], weight, moments))


def _misfit(
    impedance: np.ndarray, rates: np.ndarray, ports: np.ndarray, weight: np.ndarray, moments: np.ndarray
) -> float:
    """Largest error of the network between those of MOMENTS at which it has none, weighted (S,) W/K."""
    seen = slice(moments[0], moments[-1] + 1)
    reduced = ports.T @ (ports / (MOMENTS[seen, None, None] + rates[:, None]))
    return float(np.max(np.abs(reduced - impedance[seen]) * weight[seen, None, None]))
