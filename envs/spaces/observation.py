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
        self.history = np.full((num_envs, 2, HISTORY), np.nan)  # nan: nothing observed yet
        self.last: tuple[np.ndarray, ...] = tuple(
            np.zeros((num_envs, *shape), np.float32) for shape in _SHAPES.values()
        )

    def restart(self, rows: np.ndarray) -> None:
        """Forgets the rows' history: the next reading's first voltage stands for it."""
        self.history[rows] = np.nan

    def observe(self, reading: Reading, force_limit: np.ndarray, seen: np.ndarray) -> Observation:
        """Observations (B, ...) after a reading; arrays of their own. force_limit: (B,) N, as commanded. Rows of which
        `seen` (B,) is False keep what they last observed."""
        samples = reading.voltage.transpose(0, 2, 1)[:, :, -HISTORY:]
        begins = np.isnan(self.history[:, 0, 0]) & seen
        if begins.any():
            self.history[begins] = samples[begins, :, :1]
        longer = np.concatenate((self.history, samples), axis=2)
        np.copyto(self.history, longer[:, :, -HISTORY:], where=seen[:, None, None])
        gripper = np.empty((len(seen), 4))
        gripper[:, 0], gripper[:, 1] = reading.opening, reading.opening_rate
        gripper[:, 2], gripper[:, 3] = reading.height, force_limit
        values = (gripper, reading.force, self.history, reading.thermostat)
        observation = {}
        # More keys follow in a subclass.
        for (name, (low, high)), last, value in zip(_BOUNDS.items(), self.last, values, strict=False):
            rows = seen.reshape(-1, *(1,) * (value.ndim - 1))
            # np.clip takes five times as long for few numbers. Rounding to float32 keeps the bounds: those of the space
            # are rounded alike.
            np.copyto(last, np.minimum(np.maximum(value, low), high), where=rows, casting="same_kind")
            observation[name] = last.copy()
        return observation


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
