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
        self.last: tuple[np.ndarray, ...] = (np.zeros((num_envs, len(_LOW)), np.float32),)
        """What was observed last: all numbers of an environment in a row; more arrays follow in a subclass."""

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
        history = np.concatenate((self.history[:, :, samples.shape[2] :], samples), axis=2)
        values = np.empty(self.last[0].shape)
        values[:, 0], values[:, 1] = reading.opening, reading.opening_rate
        values[:, 2], values[:, 3] = reading.height, force_limit
        rows = len(values)
        arrays = reading.force, history, reading.thermostat
        for (_, part, shape), value in zip(_PARTS[1:], arrays, strict=True):
            values[:, part].reshape(rows, *shape)[:] = value
        # Rounding to float32 keeps the bounds: those of the space are rounded alike.
        clipped = np.minimum(np.maximum(values, _LOW), _HIGH).astype(np.float32)
        if not seen.all():
            kept = ~seen
            history[kept], clipped[kept] = self.history[kept], self.last[0][kept]
        self.history, self.last = history, (clipped.copy(), *self.last[1:])
        return {name: clipped[:, part].reshape(rows, *shape) for name, part, shape in _PARTS}


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


def _parts() -> tuple[tuple[str, slice, tuple[int, ...]], ...]:
    """Of each key its name, where it is in a row, and its shape."""
    ends = np.cumsum([np.prod(shape) for shape in _SHAPES.values()]).tolist()
    places = [slice(begin, end) for begin, end in zip((0, *ends), ends, strict=False)]
    return tuple((name, place, shape) for (name, shape), place in zip(_SHAPES.items(), places, strict=True))


def _row(end: int) -> np.ndarray:
    """The lower (0) or upper (1) bounds of a row's numbers."""
    return np.concatenate(
        [np.broadcast_to(_BOUNDS[name][end], shape).ravel() for name, shape in _SHAPES.items()]
    )


_PARTS, _LOW, _HIGH = _parts(), _row(0), _row(1)
