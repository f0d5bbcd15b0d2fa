"""A real gripper with fingertips on serial ports, driven from the studio."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium.utils.seeding import np_random

from thermograsp.envs import GraspVectorEnv
from thermograsp.envs.limits import TIPS
from thermograsp.envs.tasks import TOUCHING
from thermograsp.hardware.plant import OVERRUN
from thermograsp.studio.control import Choices, Controls, Driving, Stock, known_touch
from thermograsp.studio.sources.puppet import Puppet
from thermograsp.thermal import TouchSetup
from thermograsp.twin import measured_columns

_FOREVER = 1e6  # s


class MeasuredGrasp:
    """See SimulatedGrasp; a reset opens the fingers and waits for the thermostats. Of the choices the mode and the
    temperatures count, as what identification may know. Raises DeviceError where the devices do not answer."""

    paced = True
    rows = 1
    names = ("real object",)

    def __init__(self, choices: Choices, stock: Stock) -> None:
        assert stock.plant is not None
        self._choices = choices
        self._env = GraspVectorEnv(num_envs=1, plant=stock.plant, seconds=_FOREVER)
        self._batch = self._env.batch
        self._plant: Any = self._batch.plant
        self.dt = self._batch.dt
        self._driving = Driving(self._env, stock.network)
        self._puppet = Puppet(None)
        try:
            self.reset(choices.seed)
        except BaseException:
            self.close()
            raise

    @property
    def colours(self) -> tuple[float, float]:
        """See SimulatedGrasp."""
        return self._choices.colours

    def reset(self, seed: int) -> None:
        """Opens, and begins anew."""
        self._observation, self.reading = self._batch.reset([0], [np_random(seed)[0]])
        self._driving.restart(seed)
        self.time = 0.0

    @property
    def running(self) -> bool:
        """Until something goes wrong."""
        return not self.reading.error[0]

    def step(self, controls: Controls) -> dict[str, np.ndarray]:
        """One control step, which takes as long as it lasts; the columns (1, S)."""
        step = self._batch.step(self._driving.action(controls, self._observation, self.reading))
        self._observation, self.reading = step.observation, step.reading
        samples = self._plant.config.samples
        late = float(step.reading.truth["late"][0])
        self.time += self.dt + (late if late > OVERRUN else 0.0)
        time = self.time - self.dt / samples * np.arange(samples)[::-1]
        columns = {"time_s": time, **measured_columns([step.reading], samples)}
        return {name: np.asarray(values)[None] for name, values in columns.items()}

    def shapes(self) -> list[dict[str, Any]]:
        """See shapes.py."""
        return self._puppet.shapes()

    def message(self, row: int) -> dict[str, Any]:
        """See SimulatedGrasp."""
        reading = self.reading
        opening, height = float(reading.opening[row]), float(reading.height[row])
        celsius = {
            f"thermostat_{tip}": round(float(reading.thermostat[row, k]), 3) for k, tip in enumerate(TIPS)
        }
        return {
            "poses": self._puppet.poses(opening, height, 0.0),
            "celsius": celsius,
            "ending": reading.error[row],
            "state": "gripped" if reading.force[row, :, 0].min() > TOUCHING else "apart",
            "opening": opening,
            "height": height,
        }

    def touch_setup(self, row: int) -> TouchSetup:
        """See SimulatedGrasp."""
        del row
        return known_touch(self._choices, 2)

    def close(self) -> None:
        """Releases the ports; the fingers stay as they are."""
        self._batch.close()
