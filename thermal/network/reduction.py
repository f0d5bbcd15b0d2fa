"""Networks from impedance samples, and their reduction, both by orthogonal projection: passive by construction.

A conducting body seen through P ports is T = Z(s) q with Z(s) = B^T (s + A)^-1 B, A symmetric and non-negative.
Samples at real s_i > 0 give the Galerkin projection onto the fields (s_i + A)^-1 B without ever forming a field
(Antoulas, Approximation of Large-Scale Dynamical Systems, 2005, sections 4.5 and 7; Mayo & Antoulas, Linear Algebra
Appl. 425, 2007). The result is diagonalised: x' = -rates x + B q, T = B^T x.

S: samples, P: ports, K: states.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from ..plates import Sampled

_RANK = 1e-11  # relative size of Gram eigenvalues that round-off has not spoiled


def interpolate(
    s: np.ndarray, impedance: Sampled, outputs: dict[str, np.ndarray]
) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
    """Rates (K,), ports (K, P) and output rows (K,) of the network that interpolates the samples.

    s: (S,) distinct, > 0, 1/s. impedance: value and slope (S, P, P). outputs: name -> (S, P), the output per unit
    heat flow at each port. K <= S P: directions that round-off has spoiled are dropped.
    """
    samples, ports = impedance.value.shape[:2]
    z = impedance.value
    difference = s[None, :] - s[:, None]
    np.fill_diagonal(difference, 1.0)
    gram = (z[:, None] - z[None, :]) / difference[:, :, None, None]
    diagonal = np.arange(samples)
    gram[diagonal, diagonal] = -impedance.slope
    pencil = (z[:, None] + z[None, :]) / 2 - (s[:, None] + s[None, :])[:, :, None, None] / 2 * gram

    def flat(blocks: np.ndarray) -> np.ndarray:
        matrix = blocks.transpose(0, 2, 1, 3).reshape(samples * ports, samples * ports)
        return (matrix + matrix.T) / 2

    gram, pencil = flat(gram), flat(pencil)
    # The samples' scales differ by decades; unit columns keep the rank decision about directions.
    scale = 1 / np.sqrt(np.diag(gram))
    values, vectors = eigh(gram * np.outer(scale, scale))
    kept = values > _RANK * values[-1]
    basis = scale[:, None] * vectors[:, kept] / np.sqrt(values[kept])
    rates, rotation = eigh(basis.T @ pencil @ basis)
    basis = basis @ rotation
    projected = {name: basis.T @ row.reshape(-1) for name, row in outputs.items()}
    return rates, basis.T @ z.reshape(samples * ports, ports), projected


def hankel_values(rates: np.ndarray, ports: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Hankel singular values (K,) K/W, largest first, and the orthonormal states (K, K) they belong to; rates > 0.

    For a symmetric system both Gramians are one matrix (Liu, Sreeram & Teo, Automatica 34, 1998)."""
    gramian = (ports @ ports.T) / (rates[:, None] + rates[None, :])
    values, vectors = eigh(gramian)
    return np.maximum(values[::-1], 0.0), vectors[:, ::-1]


def truncate(
    rates: np.ndarray, ports: np.ndarray, outputs: dict[str, np.ndarray], order: int
) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray], float]:
    """The `order` states of largest Hankel value, diagonalised again, and twice the sum of the rest: an upper bound
    K/W of the impedance's error at every frequency (Glover, Int. J. Control 39, 1984)."""
    values, vectors = hankel_values(rates, ports)
    basis = vectors[:, :order]
    reduced, rotation = eigh((basis.T * rates) @ basis)
    basis = basis @ rotation
    kept = {name: basis.T @ row for name, row in outputs.items()}
    return reduced, basis.T @ ports, kept, 2 * float(np.sum(values[order:]))
