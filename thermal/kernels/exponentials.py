"""A passive network of fixed rates from an impedance at real moments.

Z(s) of a conducting body is a sum of R_k / (s + rate_k) with positive semidefinite residues. Put on rates that are the
same for every body, equally spaced in the logarithm, it is found by least squares under that constraint (alternating
directions: Boyd et al., Found. Trends Mach. Learn. 3, 2011), in the same few steps whatever the body: no search and no
eigenproblem of its size, and what comes out is passive by construction.

S: moments, K: rates, N: ports.
"""

from __future__ import annotations

import numpy as np

from ..numerics import passive_residues
from .samples import GRASP


def residues(impedance: np.ndarray, rates: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """(K, N, N) positive semidefinite. impedance: (S, N, N) K/W at GRASP. weight: (S,) of its errors, W/K."""
    return passive_residues(fades(rates), impedance, weight)


def fades(rates: np.ndarray) -> np.ndarray:
    """(S, K) s of a unit residue at each rate, at GRASP."""
    return 1 / (GRASP[:, None] + rates)


def states(found: np.ndarray, rates: np.ndarray, least: float) -> tuple[np.ndarray, np.ndarray]:
    """Rates (n,) 1/s and ports (n, N) sqrt(K/J) of the sum's states. least: K/W, resistance of a state that is left
    out. Larger ones fade as they come near it, so that round-off decides nothing."""
    values, vectors = np.linalg.eigh(found)
    kept = values > least * rates[:, None]
    left = np.where(kept, values - (least * rates[:, None]) ** 2 / np.where(kept, values, 1.0), 0.0)
    ports = (vectors * np.sqrt(left)[:, None, :]).transpose(0, 2, 1)
    return np.broadcast_to(rates[:, None], values.shape)[kept], ports[kept]
