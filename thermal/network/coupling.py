"""Bodies joined by contacts, stepped exactly while the conductances stand still.

x' = -rates x + B q,  q = H (u - B^T x): a diagonal plus a matrix of rank M, the number of contact ports. Each step
evaluates (exp(-dt A) - 1) / (-dt A), A = diag(rates) + B H B^T, by a rational function with three pairs of complex
poles that is within 3e-6 of the exponential on the whole negative axis, whatever dt and H are; every pole costs a
diagonal scaling and a solve of size M. Two constraints on the weights make heat balance to round-off (the function is
1 at 0) and remove stiff transients at once (the propagator is 0 at infinity), so that neither a jump of the
conductance nor a long step can ring, leave the range of temperatures, or blow up.

Poles: Caratheodory-Fejer approximation of exp on the negative axis (Trefethen, Weideman & Schmelzer, BIT 46, 2006),
moved by 1/2; weights: minimax fit (Lawson) under the two constraints of the error relative to min(1, dt rate), so
that slow rates are kept to 3e-6 too. Conductances that vary are taken by their mean over the step: second order
(Magnus).

B: rows (independent systems), n: states, M: contact ports, Q: pole pairs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

POLES = np.array(
    [
        2.9006029389319967 + 1.1931293084021029j,
        1.6585525717180862 + 3.6147726008197267j,
        -1.2819882759221513 + 6.196512467347284j,
    ]
)
WEIGHTS = np.array(
    [
        -1.1388255505599398 - 1.9682591684251973j,
        0.6615791179629316 + 0.0011527224381956414j,
        -0.02275356740299206 + 0.026918194123891903j,
    ]
)


@dataclass(frozen=True, slots=True)
class Propagator:
    """A system's matrices for one step length. dt: s. rates: (n,) 1/s. ports: (n, M) sqrt(K/J). scale: (Q, n) and
    gram: (Q, M, M), the diagonal scalings 1/(pole + dt rates) and ports^T scale ports."""

    dt: float
    rates: np.ndarray
    ports: np.ndarray
    scale: np.ndarray
    gram: np.ndarray


def propagator(rates: np.ndarray, ports: np.ndarray, dt: float) -> Propagator:
    """The matrices of one system for steps of dt s."""
    scale = 1 / (POLES[:, None] + dt * rates)
    gram = np.einsum("nm,qn,nk->qmk", ports, scale, ports)
    return Propagator(dt, np.asarray(rates, float), np.asarray(ports, float), scale, gram)


def step(
    system: Propagator, state: np.ndarray, conductance: np.ndarray, difference: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """State (B, n) after dt and the mean heat flow (B, M) W through the ports during the step.

    state: (B, n). conductance: (B, M) W/K of each port, >= 0. difference: (B, M) K, the first body's initial
    temperature less the second's, as seen by each port's pattern.
    """
    dt, ports = system.dt, system.ports
    # The flow at each pole is solved for, not its difference from the flow at the start, which large conductances and
    # steps would make a difference of large numbers: states and flows then balance to round-off.
    decay = -system.rates * state
    start = conductance * (difference - state @ ports)
    at_ports = np.einsum("nm,qn,bn->bqm", ports, system.scale, decay)
    matrix = dt * conductance[:, None, :, None] * system.gram + np.eye(ports.shape[1])
    drive = start[:, None] - (dt * conductance)[:, None] * at_ports
    flows = np.linalg.solve(matrix, drive[..., None])[..., 0]
    solved = system.scale * (decay[:, None] + np.einsum("nm,bqm->bqn", ports, flows))
    change = -2 * dt * np.einsum("q,bqn->bn", WEIGHTS, solved).real
    return state + change, -2 * np.einsum("q,bqm->bm", WEIGHTS / POLES, flows).real
