"""A passive network from an impedance and its slope at a few real moments.

Z(s) = B^T (s + A)^-1 B of a conducting body, A symmetric and non-negative, tells by its samples at s_i > 0 the Galerkin
projection of the body on its fields (s_i + A)^-1 B, without one of them being formed (Antoulas, Approximation of
Large-Scale Dynamical Systems, 2005, sections 4.5 and 7; Mayo & Antoulas, Linear Algebra Appl. 425, 2007). So a network
of one state a moment and port has the body's impedance at those moments, and is passive whatever they are.

S: moments, N: ports, n: states.
"""

from __future__ import annotations

import numpy as np

from .samples import MOMENTS

_RANKS = (1e-5, 1e-6, 1e-8)
"""Shares of the largest of the fields' Gram matrix, below which its directions are left out. The first leaves out
fields that count where large contacts are on a small block in air (.1 K of 12); with the last, the samples' errors may
come in where there are many patterns. What the network says between its moments tells which serves."""


def states(
    impedance: np.ndarray, slope: np.ndarray, weight: np.ndarray, moments: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """Rates (n,) 1/s and ports (n, N) sqrt(K/J), the slowest first, and their misfit. impedance, slope: (S, N, N) K/W
    and K s/W at MOMENTS. weight: (S,) W/K of the impedance's errors. moments: the indices of those that count."""
    s, value = MOMENTS[moments], impedance[moments]
    distance = s[None, :] - s[:, None]
    np.fill_diagonal(distance, 1.0)
    gram = (value[:, None] - value[None, :]) / distance[:, :, None, None]
    diagonal = np.arange(len(s))
    gram[diagonal, diagonal] = -slope[moments]
    pencil = (value[:, None] + value[None, :]) / 2 - (s[:, None] + s[None, :])[:, :, None, None] / 2 * gram
    gram, pencil = _flat(gram), _flat(pencil)
    # the moments' scales differ by decades; fields of unit size leave the rank to their directions
    size = np.sqrt(np.maximum(np.diag(gram), 0.0))
    scale = np.divide(1.0, size, out=np.zeros_like(size), where=size > 0)
    values, vectors = np.linalg.eigh(gram * np.outer(scale, scale))
    columns, found = value.reshape(-1, value.shape[-1]), []
    for rank in _RANKS:
        kept = values > rank * values[-1]
        basis = scale[:, None] * vectors[:, kept] / np.sqrt(values[kept])
        rates, turn = np.linalg.eigh(basis.T @ pencil @ basis)
        # what round-off makes grow is no field of the body's
        real = rates > 0
        ports = (basis @ turn[:, real]).T @ columns
        found.append((rates[real], ports, _misfit(impedance, rates[real], ports, weight, moments)))
    return min(found, key=lambda network: network[2])


def _flat(blocks: np.ndarray) -> np.ndarray:
    count, _, ports, _ = blocks.shape
    matrix = blocks.transpose(0, 2, 1, 3).reshape(count * ports, count * ports)
    return (matrix + matrix.T) / 2


def _misfit(
    impedance: np.ndarray, rates: np.ndarray, ports: np.ndarray, weight: np.ndarray, moments: np.ndarray
) -> float:
    """Largest error of the network between those of MOMENTS at which it has none, weighted (S,) W/K."""
    seen = slice(moments[0], moments[-1] + 1)
    reduced = ports.T @ (ports / (MOMENTS[seen, None, None] + rates[:, None]))
    return float(np.max(np.abs(reduced - impedance[seen]) * weight[seen, None, None]))
