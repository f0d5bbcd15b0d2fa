"""Networks from impedance samples, and their reduction, both by orthogonal projection: passive by construction.

A conducting body seen through P ports is T = Z(s) q with Z(s) = B^T (s + A)^-1 B, A symmetric and non-negative.
Samples at real s_i > 0 give the Galerkin projection onto the fields (s_i + A)^-1 B without ever forming a field
(Antoulas, Approximation of Large-Scale Dynamical Systems, 2005, sections 4.5 and 7; Mayo & Antoulas, Linear Algebra
Appl. 425, 2007). The result is diagonalised: x' = -rates x + B q, T = B^T x.

S: samples, P: ports, K: states.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

_RANK = 1e-11  # relative size of Gram eigenvalues that round-off has not spoiled


@dataclass(frozen=True, slots=True)
class Sampled:
    """A symmetric matrix function of s at real samples. value, slope: (S, P, P), slope the derivative by s."""

    value: np.ndarray
    slope: np.ndarray

    def __add__(self, other: Sampled) -> Sampled:
        return Sampled(self.value + other.value, self.slope + other.slope)


def sampled_fields(s: np.ndarray, impedance: Sampled) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of the fields (s_i + A)^-1 B: products of those of unit size (S P, S P), products of all with A between them,
    and what each is multiplied by to be of unit size (S P,)."""
    value = impedance.value
    difference = s[None, :] - s[:, None]
    np.fill_diagonal(difference, 1.0)
    gram = (value[:, None] - value[None, :]) / difference[:, :, None, None]
    diagonal = np.arange(len(s))
    gram[diagonal, diagonal] = -impedance.slope
    pencil = (value[:, None] + value[None, :]) / 2 - (s[:, None] + s[None, :])[:, :, None, None] / 2 * gram
    gram, pencil = _flat(gram), _flat(pencil)
    # The samples' scales differ by decades; fields of unit size leave the rank to their directions.
    size = np.sqrt(np.maximum(np.diag(gram), 0.0))
    scale = np.divide(1.0, size, out=np.zeros_like(size), where=size > 0)
    return gram * np.outer(scale, scale), pencil, scale


def _flat(blocks: np.ndarray) -> np.ndarray:
    count, _, ports, _ = blocks.shape
    matrix = blocks.transpose(0, 2, 1, 3).reshape(count * ports, count * ports)
    return (matrix + matrix.T) / 2


def interpolate(
    s: np.ndarray, impedance: Sampled, outputs: dict[str, np.ndarray]
) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
    """Rates (K,), ports (K, P) and output rows (K,) of the network that interpolates the samples.

    s: (S,) distinct, > 0, 1/s. impedance: value and slope (S, P, P). outputs: name -> (S, P), the output per unit
    heat flow at each port. K <= S P: directions that round-off has spoiled are dropped.
    """
    samples, ports = impedance.value.shape[:2]
    gram, pencil, scale = sampled_fields(s, impedance)
    values, vectors = eigh(gram)
    kept = values > _RANK * values[-1]
    basis = scale[:, None] * vectors[:, kept] / np.sqrt(values[kept])
    rates, rotation = eigh(basis.T @ pencil @ basis)
    basis = basis @ rotation
    projected = {name: basis.T @ row.reshape(-1) for name, row in outputs.items()}
    return rates, basis.T @ impedance.value.reshape(samples * ports, ports), projected


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
