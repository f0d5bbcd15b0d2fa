"""The states that are a body's own, wherever it is touched: its slowest modes, and when these tell the heat kernel.

M: ports, R: modes, K: states, T: times, S: moments.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..kernels import GRASP, TIMES
from ..meshes import BodyModes, Film, body_modes, film_of, held_apart
from ..network import ThermalNetwork
from ..surfaces import Solid
from .ports import LEVEL

_SLOW = 60  # modes that are states
_SWITCH = 1e-5  # m2, diffusivity times time in the middle of going over from the local kernel to the modes, at least
_RESOLVED = 3.0  # over the last mode's rate above the first one's, likewise
_LAYERED = 100.0  # s, the same where there are several materials, whose cells tell layers late
_TAKEN = 0.2  # the slowest rate behind a film over heat's along a cell, from which on modes tell no places


class SlowStates(NamedTuple):
    """The states that are a body's own. network: by its ports. fades: (K,) 1/s and held: (K, M), its rates and ports
    while contents are held at one temperature; without any just those."""

    network: ThermalNetwork
    fades: np.ndarray
    held: np.ndarray


def slow_states(modes: BodyModes, seen: np.ndarray, film: Film | None, others: int = 0) -> SlowStates:
    """seen: (M, R) of the modes by the ports, of which the last `others` have one pattern."""
    even = np.tile(
        np.eye(LEVEL.patterns)[0], (len(seen) - others) // LEVEL.patterns
    )  # the mean of the first pattern alone is not 0
    even = np.concatenate((even, np.ones(others)))
    network = modes.network(seen[:, : state_count(modes)], even, 0.0 if film is None else film.conductance)
    if film is None:
        return SlowStates(network, network.rates, network.ports)
    fades, turn = held_apart(network, film.conductance)
    return SlowStates(network, fades, turn.T @ network.ports)


def own_network(body: Solid, film: float, *, cache: bool = True) -> ThermalNetwork:
    """The states of placed_network that are the body's own wherever it is touched, with its outputs and without ports.
    Arguments and errors as its."""
    inside = film_of(body, film)
    modes = body_modes(body, inside, cache=cache)
    return slow_states(modes, np.zeros((0, len(modes.rates))), inside).network


@lru_cache(maxsize=64)
def state_count(modes: BodyModes) -> int:
    """How many modes are states. Where contents take the heat before it has gone a cell along, modes tell cells apart
    and no places, and the first alone is one."""
    cell = max(float(np.median(np.diff(edges))) for edges in modes.grid.edges)
    return 1 if modes.sink.any() and modes.rates[0] * cell**2 > _TAKEN else _SLOW


def crossover_time(modes: BodyModes, parts: int = 1) -> float:
    """s, in the middle of going over from the local kernel to the modes of a body of so many parts."""
    if parts > 1:
        return _LAYERED
    return max(_SWITCH, _RESOLVED / (modes.rates[-1] - modes.rates[0])) / modes.diffusivity


def modal_share(crossover: float) -> np.ndarray:
    """(T,) how far the kernel at TIMES is the modes', from 0 to 1 within a factor of four around told, s."""
    over = np.clip((np.log2(TIMES / crossover) + 1) / 2, 0.0, 1.0)
    return over * over * (3 - 2 * over)


def modal_kernel(
    seen: np.ndarray, rates: np.ndarray, taus: np.ndarray, others: np.ndarray | None = None
) -> np.ndarray:
    """(T, M, M) of ports (M, R) whose states fade at these rates, or between these and others."""
    others = seen if others is None else others
    return (seen * np.exp(-np.outer(taus, rates))[:, None]) @ others.T


def modal_impedance(seen: np.ndarray, rates: np.ndarray, others: np.ndarray | None = None) -> np.ndarray:
    """(S, M, M) K/W at GRASP of ports (M, R), or between these and others."""
    others = seen if others is None else others
    return (seen * (1 / (GRASP[:, None] + rates))[:, None]) @ others.T
