"""A passive network of fixed rates from an impedance at real moments.

Z(s) of a conducting body is a sum of R_k / (s + rate_k) with positive semidefinite residues. Put on rates that are the
same for every body, equally spaced in the logarithm, it is found by least squares under that constraint (alternating
directions: Boyd et al., Found. Trends Mach. Learn. 3, 2011), in the same few steps whatever the body: no search and no
eigenproblem of its size, and what comes out is passive by construction.

S: moments, K: rates, N: ports.
"""

from __future__ import annotations

import math

import numpy as np

from thermograsp.compiled import njit

from ..numerics import passive_residues, port_residues, turn_diagonal
from .samples import GRASP


def residues(impedance: np.ndarray, rates: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """(K, N, N) positive semidefinite. impedance: (S, N, N) K/W at GRASP. weight: (S,) of its errors, W/K."""
    return passive_residues(fades(rates), impedance, weight)


def fades(rates: np.ndarray) -> np.ndarray:
    """(S, K) s of a unit residue at each rate, at GRASP."""
    return 1 / (GRASP[:, None] + rates)


def states(
    impedance: np.ndarray, rates: np.ndarray, weight: np.ndarray, least: float
) -> tuple[np.ndarray, np.ndarray]:
    """Rates (n,) 1/s and ports (n, N) sqrt(K/J) of the states of such a network. least: K/W, resistance of a state that
    is left out. Larger ones fade as they come near it, so that round-off decides nothing."""
    return rate_states(port_residues(fades(rates), np.ascontiguousarray(impedance), weight), rates, least)


@njit(cache=True, short_loops=True, error_model="numpy")
def rate_states(found, rates, least):
    """The same of residues found (N, N, K), which it writes over."""
    count, all_rates = len(found), len(rates)
    turn, room = np.zeros_like(found), np.empty((4, all_rates))
    fading, ports = np.empty(count * all_rates), np.empty((count * all_rates, count))
    for i in range(count):
        turn[i, i] = 1.0
    turn_diagonal(found, turn, room)
    kept = 0
    for k in range(all_rates):
        share = least * rates[k]
        for i in range(count):
            value = found[i, i, k]
            if value <= share:
                continue
            size = math.sqrt(value - share * share / value)
            fading[kept] = rates[k]
            for j in range(count):
                ports[kept, j] = size * turn[i, j, k]
            kept += 1
    return fading[:kept], ports[:kept]
