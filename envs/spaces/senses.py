"""How an agent that learns to grasp meets the environment: its inputs as one vector, and an arm that waits.

B: environments.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..limits import HISTORY

SIZE = 4 + 6 + 2 * HISTORY + 2
"""Numbers in the vector."""

# Middle and half range of what a grasp meets, so that the vector is about -1 .. 1.
_GRIPPER = (np.array([0.0425, 0.0, 0.025, 20.0]), np.array([0.0425, 0.1, 0.025, 20.0]))  # m, m/s, m, N
_FORCE = 20.0  # N
_THERMOSTAT = (36.0, 10.0)  # °C


@dataclass(frozen=True, slots=True)
class Senses:
    """The part of an observation that an agent is given. heat: voltages and thermostats. load: the load cells. What is
    left out reads 0, so that agents with and without it have the same network. voltage: V that read 1."""

    heat: bool = True
    load: bool = True
    voltage: float = 1.5e-3

    def vector(self, observation: Mapping[str, np.ndarray]) -> np.ndarray:
        """(B, SIZE) float32 of observations (B, ...): gripper, force, voltage, thermostat, in the order of
        `observation_space`."""
        rows = len(observation["gripper"])
        parts = (
            (observation["gripper"] - _GRIPPER[0]) / _GRIPPER[1],
            observation["force"] / _FORCE * self.load,
            observation["voltage"] / self.voltage * self.heat,
            (observation["thermostat"] - _THERMOSTAT[0]) / _THERMOSTAT[1] * self.heat,
        )
        return np.concatenate([part.reshape(rows, -1) for part in parts], axis=1).astype(np.float32)
