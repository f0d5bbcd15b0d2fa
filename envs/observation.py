"""What an agent feels: the same dictionary from a simulated and from a real gripper."""

from __future__ import annotations

import gymnasium
import numpy as np
from numba import njit

from thermograsp.plant import Reading

from .mechanics import MAX_FORCE, MAX_HEIGHT
from .scene import MAX_OPENING

HISTORY = 16  # voltage samples kept
MOST_FORCE = 200.0  # N, range of a fingertip's load cell
MOST_RATE = 1.0  # m/s
MOST_VOLTAGE = 0.256  # V, the widest range of the converters we know
THERMOSTAT = (-20.0, 100.0)  # °C

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
        {
            "gripper": box(_LOWEST, _HIGHEST, (4,)),
            "force": box(-MOST_FORCE, MOST_FORCE, (2, 3)),
            "voltage": box(-MOST_VOLTAGE, MOST_VOLTAGE, (2, HISTORY)),
            "thermostat": box(THERMOSTAT[0], THERMOSTAT[1], (2,)),
        }
    )


class Observer:
    """Keeps the voltage history of `num_envs` environments and puts readings into observations of its `space`.

    A reading beyond the space's bounds saturates there, as the instruments' own ranges would have it."""

    def __init__(self, num_envs: int) -> None:
        self.space = observation_space()
        self.history = np.zeros((num_envs, 2, HISTORY))
        self.last: tuple[np.ndarray, ...] = tuple(
            np.zeros((num_envs, *shape), np.float32) for shape in _SHAPES.values()
        )

    def restart(self, rows: np.ndarray) -> None:
        """Forgets the rows' history."""
        self.history[rows] = 0.0

    def observe(self, reading: Reading, force_limit: np.ndarray, seen: np.ndarray) -> Observation:
        """Observations (B, ...) after a reading; arrays of their own. force_limit: (B,) N, as commanded. Rows of which
        `seen` (B,) is False keep what they last observed."""
        last = self.last[: len(_SHAPES)]  # those that follow are a kind's own
        fresh = [np.empty(values.shape, np.float32) for values in last]
        _observe_rows(
            seen,
            reading.opening,
            reading.opening_rate,
            reading.height,
            force_limit,
            reading.force,
            reading.voltage,
            reading.thermostat,
            self.history,
            *last,
            *fresh,
        )
        gripper, force, voltage, thermostat = fresh
        return {"gripper": gripper, "force": force, "voltage": voltage, "thermostat": thermostat}


_SHAPES = {"gripper": (4,), "force": (2, 3), "voltage": (2, HISTORY), "thermostat": (2,)}
_LOWEST = (-0.005, -MOST_RATE, -0.005, 0.0)
_HIGHEST = (MAX_OPENING + 0.005, MOST_RATE, MAX_HEIGHT + 0.005, MAX_FORCE)


@njit(cache=True, error_model="numpy")
def _observe_rows(
    seen,
    opening,
    opening_rate,
    height,
    force_limit,
    force,
    voltage,
    thermostat,
    history,
    last_gripper,
    last_force,
    last_voltage,
    last_thermostat,
    new_gripper,
    new_force,
    new_voltage,
    new_thermostat,
):
    samples = voltage.shape[1]
    kept = max(HISTORY - samples, 0)
    for b in range(len(seen)):
        if seen[b]:
            gripper = (opening[b], opening_rate[b], height[b], force_limit[b])
            for i in range(4):
                last_gripper[b, i] = _within(gripper[i], _LOWEST[i], _HIGHEST[i])
            for f in range(2):
                for i in range(3):
                    last_force[b, f, i] = _within(force[b, f, i], -MOST_FORCE, MOST_FORCE)
                for i in range(kept):
                    history[b, f, i] = history[b, f, i + samples]
                for i in range(kept, HISTORY):
                    history[b, f, i] = voltage[b, samples - HISTORY + i, f]
                for i in range(HISTORY):
                    last_voltage[b, f, i] = _within(history[b, f, i], -MOST_VOLTAGE, MOST_VOLTAGE)
                last_thermostat[b, f] = _within(thermostat[b, f], THERMOSTAT[0], THERMOSTAT[1])
    new_gripper[:] = last_gripper
    new_force[:] = last_force
    new_voltage[:] = last_voltage
    new_thermostat[:] = last_thermostat


@njit(cache=True, error_model="numpy", inline="always")
def _within(value, low, high):
    """In float32, whose rounding of a bound is the space's."""
    return np.float32(min(max(value, low), high))
