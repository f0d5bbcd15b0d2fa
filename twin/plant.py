"""The simulated gripper behind a serial line: drivers, protocols and emulated devices, in virtual time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from thermograsp.envs.limits import SAMPLE_PERIOD
from thermograsp.envs.plant import SimulatedPlant, simulated_plant
from thermograsp.errors import InvalidValueError
from thermograsp.hardware import Fingertips, GripperModel, RobotiqGripper, VirtualLine
from thermograsp.hardware.plant import SerialConfig, SerialPlant, VirtualTime, without_maps
from thermograsp.plant import Command, Reading

from .simulated_hand import SimulatedHand


class TwinPlant:
    """A SerialPlant on emulated devices that `simulation` moves (a plant, thermograsp.plant.Plant). It is what a policy
    will meet on the real gripper: commands in the gripper's steps, samples from the wire, no lift axis. Only the
    material is told beyond what a SerialPlant knows, so that a policy can be judged. Nothing waits for the wall's time,
    and the same seeds give the same bits.

    Raises InvalidValueError for a simulation of more than one environment, and for fingertips of two temperatures."""

    num_envs = 1

    def __init__(self, simulation: SimulatedPlant) -> None:
        plates = simulation.config.sensor_temperatures
        if len(set(plates)) > 1:
            raise InvalidValueError(f"sensor_temperature {plates!r} °C: behind a serial line both are alike")
        self.dt, self.sample_rate = simulation.dt, simulation.sample_rate
        self._simulation = simulation
        self._hand = SimulatedHand(simulation, model=GripperModel(activation_speed=1.0))
        lines = VirtualLine(self._hand.fingertips), VirtualLine(self._hand.gripper)
        self._serial = SerialPlant(
            Fingertips(lines[0].open, clock=lines[0].clock, background=False, setpoint=plates[0]),
            RobotiqGripper(lines[1].open, clock=lines[1].clock, sleep=lines[1].advance),
            SerialConfig(dt=simulation.dt, rate=round(1 / SAMPLE_PERIOD), setpoint=plates[0]),
            VirtualTime(lines),
        )

    def reset(
        self, rows: Sequence[int], rngs: Sequence[np.random.Generator], options: Mapping[str, Any]
    ) -> Reading:
        """Opens the gripper, between whose fingers an object then stands that the simulation draws. options: the
        simulation's. Raises DeviceError, and InvalidValueError for options."""
        self._hand.draw_next(rngs[0], options)
        return self._judged(self._serial.reset(rows, rngs, {}))

    def step(self, command: Command) -> Reading:
        """One control step."""
        return self._judged(self._serial.step(command))

    def close(self) -> None:
        """Releases the lines and the simulation."""
        self._serial.close()
        self._simulation.close()

    def _judged(self, reading: Reading) -> Reading:
        """With the material, which the simulation knows."""
        material = np.array([self._simulation.bodies[0].material.name], object)
        unknown = np.empty(1, object)
        unknown[0] = tuple(name for name in reading.truth["unknown"][0] if name != "material")
        truth = {**reading.truth, "unknown": unknown, "material": material}
        return reading._replace(truth=truth, info_names=(*reading.info_names, "material"))


def twin_plant(url: str, num_envs: int, **config: Any) -> TwinPlant:
    """The plant behind plant="twin". Keywords as in SimulationConfig. Raises UnknownKeywordError for others, and
    InvalidValueError for what no serial line has and for a URL with a port: devices are emulated."""
    if url != "twin":
        raise InvalidValueError(f"plant {url!r}: a twin has no port; give 'twin'")
    if num_envs != 1:
        raise InvalidValueError(f"a twin is one gripper, so num_envs must be 1, got {num_envs}")
    return TwinPlant(simulated_plant(url, 1, **without_maps(config)))
