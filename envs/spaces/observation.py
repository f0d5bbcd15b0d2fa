"""Observations: the same dictionary from a simulated and from a real gripper."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np

from thermograsp.plant import Reading

from ..limits import (
    HISTORY,
    MAX_FORCE,
    MAX_HEIGHT,
    MAX_OPENING,
    MOST_FORCE,
    MOST_RATE,
    MOST_VOLTAGE,
    THERMOSTAT,
)

Observation = dict[str, np.ndarray]


def observation_space() -> gymnasium.spaces.Dict:
    """gripper (4,): opening m, its rate m/s, height m, commanded force N. force (2, 3) N: normal and two tangential per
    fingertip, pad frame. voltage (2, 16) V after the ADC, oldest first. thermostat (2,) °C. float32, finite bounds."""

    def box(low: object, high: object, shape: tuple[int, ...]) -> gymnasium.spaces.Box:
        lowest, highest = (
            np.broadcast_to(np.asarray(bound, np.float32), shape).copy() for bound in (low, high)
        )
        return gymnasium.spaces.Box(low=lowest, high=highest, dtype=np.float32)

    return gymnasium.spaces.Dict(
        {name: box(_BOUNDS[name][0], _BOUNDS[name][1], shape) for name, shape in _SHAPES.items()}
    )


class Observer:
    """Keeps the voltage history of `num_envs` environments and puts readings into observations of its `space`.

    A reading beyond the space's bounds is clipped to them, as an instrument saturates at the ends of its range."""

    def __init__(self, num_envs: int) -> None:
        self.space = observation_space()
        self._fresh = np.ones(num_envs, bool)  # nothing has been observed since a restart
        self._values = np.zeros((num_envs, _LOW.size), np.float32)  # as read last, an environment in a row
        self._read = _by_name(self._values, _READ)

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """All that is remembered, (B, ...) each, to be copied from and written into; a subclass adds its own."""
        return self._fresh, self._values

    def restart(self, rows: np.ndarray) -> None:
        """Forgets the rows' history: the next reading's first voltage stands for it."""
        self._fresh[rows] = True

    def observe(self, reading: Reading, force_limit: np.ndarray, observed: np.ndarray) -> Observation:
        """Observations (B, ...) after a reading; arrays of their own. force_limit: (B,) N, as commanded. Rows of which
        `observed` (B,) is False keep what they last observed."""
        before = None if np.count_nonzero(observed) == len(observed) else self._values.copy()
        read, voltage = self._read, self._read["voltage"]
        samples = reading.voltage.transpose(0, 2, 1)[:, :, -HISTORY:]
        if np.count_nonzero(self._fresh):
            begins = self._fresh & observed
            voltage[begins], self._fresh[begins] = samples[begins, :, :1], False
        kept = HISTORY - samples.shape[2]
        voltage[:, :, :kept] = voltage[:, :, samples.shape[2] :]
        voltage[:, :, kept:] = samples
        read["opening"], read["opening_rate"] = reading.opening, reading.opening_rate
        read["height"], read["force_limit"] = reading.height, force_limit
        read["force"], read["thermostat"] = reading.force, reading.thermostat
        if before is not None:
            self._values[~observed] = before[~observed]
        clipped = _by_name(np.minimum(np.maximum(self._values, _LOW), _HIGH), _OBSERVED)
        return {name: clipped[name] for name in _SHAPES}


_SHAPES = {"gripper": (4,), "force": (2, 3), "voltage": (2, HISTORY), "thermostat": (2,)}
_BOUNDS: dict[str, tuple[Any, Any]] = {
    "gripper": (
        np.array([-0.005, -MOST_RATE, -0.005, 0.0]),
        np.array([MAX_OPENING + 0.005, MOST_RATE, MAX_HEIGHT + 0.005, MAX_FORCE]),
    ),
    "force": (-MOST_FORCE, MOST_FORCE),
    "voltage": (-MOST_VOLTAGE, MOST_VOLTAGE),
    "thermostat": THERMOSTAT,
}


def _row(end: int) -> np.ndarray:
    """(1, n) the lower (0) or upper (1) bounds of a row's numbers, of the same shape as one environment's: NumPy takes
    a quicker way with equal shapes."""
    bounds = [np.broadcast_to(_BOUNDS[name][end], shape).ravel() for name, shape in _SHAPES.items()]
    return np.concatenate(bounds)[None].astype(np.float32)


def _by_name(rows: np.ndarray, names: np.dtype) -> np.ndarray:
    """The same numbers (B, n) as records (B,)."""
    return np.ndarray(len(rows), names, rows)


_LOW, _HIGH = _row(0), _row(1)
_OBSERVED = np.dtype([(name, "f4", shape) for name, shape in _SHAPES.items()])
_READ = np.dtype(
    [
        *(("opening", "f4"), ("opening_rate", "f4"), ("height", "f4"), ("force_limit", "f4")),
        *(("force", "f4", (2, 3)), ("voltage", "f4", (2, HISTORY)), ("thermostat", "f4", (2,))),
    ]
)
"""All numbers of an environment in a row: as observed, and as read, the gripper's one by one."""
