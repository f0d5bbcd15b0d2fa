"""What an agent feels: the same dictionary from a simulated and from a real gripper."""

from __future__ import annotations

import gymnasium
import numpy as np

from thermograsp.plant import Command, Reading

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
            "gripper": box(
                [-0.005, -MOST_RATE, -0.005, 0.0],
                [MAX_OPENING + 0.005, MOST_RATE, MAX_HEIGHT + 0.005, MAX_FORCE],
                (4,),
            ),
            "force": box(-MOST_FORCE, MOST_FORCE, (2, 3)),
            "voltage": box(-MOST_VOLTAGE, MOST_VOLTAGE, (2, HISTORY)),
            "thermostat": box(THERMOSTAT[0], THERMOSTAT[1], (2,)),
        }
    )


class Observer:
    """Keeps the voltage history of `num_envs` environments and puts readings into observations.

    A reading beyond the space's bounds saturates there, as the instruments' own ranges would have it."""

    def __init__(self, num_envs: int) -> None:
        self._space = observation_space()
        self.history = np.zeros((num_envs, 2, HISTORY))

    def restart(self, rows: np.ndarray) -> None:
        """Forgets the rows' history."""
        self.history[rows] = 0.0

    def observe(self, reading: Reading, command: Command) -> Observation:
        """Observations (B, ...) after a reading; arrays of their own."""
        fresh = np.moveaxis(reading.voltage, 1, 2)
        self.history = np.concatenate((self.history, fresh), axis=2)[:, :, -HISTORY:]
        gripper = np.stack(
            (reading.opening, reading.opening_rate, reading.height, command.force_limit), axis=1
        )
        values = {
            "gripper": gripper,
            "force": reading.force,
            "voltage": self.history,
            "thermostat": reading.thermostat,
        }
        bounded = {}
        for name, value in values.items():
            space = self._space[name]
            assert isinstance(space, gymnasium.spaces.Box)
            bounded[name] = np.clip(value, space.low, space.high).astype(np.float32)
        return bounded
