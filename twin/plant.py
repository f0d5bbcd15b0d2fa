"""The simulated gripper behind a serial line: drivers, protocols and emulated devices, in virtual time."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any
from urllib.parse import parse_qsl, urlsplit

import numpy as np

from thermograsp.envs.limits import SAMPLE_PERIOD
from thermograsp.envs.plant import SimulatedPlant, pair_plant, simulated_plant
from thermograsp.errors import InvalidValueError
from thermograsp.hardware import Fingertips, GripperModel, RobotiqGripper, RobotiqUnits, VirtualLine
from thermograsp.hardware.plant import SerialConfig, SerialPlant, VirtualTime, without_maps
from thermograsp.plant import Command, Reading

from .simulated_hand import SimulatedHand

_JUDGED = ("material", "lift", "crushing_force", "object_force", "goal", "asked", "right")
"""Of the simulation's truth, those that it has."""


class TwinPlant:
    """A SerialPlant on emulated devices that `simulation` moves (a plant, thermograsp.plant.Plant). It is what a policy
    will meet on the real gripper: commands in the gripper's steps, samples from the wire, an arm that lifts and, over
    two objects, moves along the table. units: of the emulated gripper, a Robotiq 2F-85 by default. layout: the
    simulation's. Beyond what a SerialPlant knows, the material, the objects' heights, the forces on them and those that
    crush them are told, and of two objects the right one, so that a policy can be judged. Nothing waits for the wall's
    time, and the same seeds give the same bits.

    Raises InvalidValueError for a simulation of more than one environment, and for fingertips of two temperatures."""

    num_envs = 1

    def __init__(self, simulation: SimulatedPlant, units: RobotiqUnits | None = None) -> None:
        plates = simulation.config.sensor_temperatures
        if len(set(plates)) > 1:
            raise InvalidValueError(f"sensor_temperature {plates!r} °C: behind a serial line both are alike")
        self.dt, self.sample_rate = simulation.dt, simulation.sample_rate
        self._simulation, self.layout = simulation, simulation.layout
        units = units or RobotiqUnits()
        self._hand = SimulatedHand(simulation, model=GripperModel(units, activation_speed=1.0))
        lines = VirtualLine(self._hand.fingertips), VirtualLine(self._hand.gripper)
        self._serial = SerialPlant(
            Fingertips(lines[0].open, clock=lines[0].clock, background=False, setpoint=plates[0]),
            RobotiqGripper(lines[1].open, units=units, clock=lines[1].clock, sleep=lines[1].advance),
            SerialConfig(dt=simulation.dt, rate=round(1 / SAMPLE_PERIOD), setpoint=plates[0]),
            VirtualTime(lines),
            lift=self._hand.lift,
            lateral=self._hand.lateral,
        )
        self._known: Mapping[str, Any] = {}

    def reset(
        self, rows: Sequence[int], rngs: Sequence[np.random.Generator], options: Mapping[str, Any]
    ) -> Reading:
        """Opens the gripper, over the object or between the objects that the simulation draws. options: the
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
        """With what the simulation knows."""
        simulated = self._hand.reading
        if simulated is not None:  # an object that was taken away is known still
            self._known = {name: simulated.truth[name] for name in _JUDGED if name in simulated.truth}
        known = self._known
        unknown = np.empty(1, object)
        unknown[0] = tuple(name for name in reading.truth["unknown"][0] if name not in known)
        truth = {**reading.truth, **known, "unknown": unknown}
        shown = tuple(name for name in ("material", "asked", "right") if name in known)
        return reading._replace(truth=truth, info_names=(*reading.info_names, *shown))


def twin_plant(url: str, num_envs: int, **config: Any) -> TwinPlant:
    """The plant behind plant="twin", or "twin:?weakest=1&strongest=40" for a gripper whose forces, N, are other than a
    Robotiq 2F-85's. Keywords as in SimulationConfig. Raises UnknownKeywordError for others, and InvalidValueError for
    what no serial line has and for a URL of another form, such as one with a port: devices are emulated."""
    return _twin(url, num_envs, lambda: simulated_plant("twin", 1, **without_maps(config)))


def twin_pair_plant(url: str, num_envs: int, **config: Any) -> TwinPlant:
    """The same of two objects, behind plant="twin-pair", which Sort-v0 makes of "twin". Keywords as in pair_config."""
    return _twin(url, num_envs, lambda: pair_plant("twin-pair", 1, **without_maps(config)))


def _twin(url: str, num_envs: int, simulation: Callable[[], SimulatedPlant]) -> TwinPlant:
    parts = urlsplit(url)
    given = {"weakest": RobotiqUnits().weakest, "strongest": RobotiqUnits().strongest}
    try:
        asked = {name: float(value) for name, value in parse_qsl(parts.query, keep_blank_values=True)}
    except ValueError:
        asked = {"": 0.0}
    if parts.netloc or parts.path not in ("", "twin", "twin-pair") or not asked.keys() <= given.keys():
        raise InvalidValueError(
            f"plant {url!r}: a twin has no port; give 'twin', or 'twin:?weakest=N&strongest=N' with N in newtons"
        )
    if num_envs != 1:
        raise InvalidValueError(f"a twin is one gripper, so num_envs must be 1, got {num_envs}")
    forces = given | asked
    units = RobotiqUnits(weakest=forces["weakest"], strongest=forces["strongest"])
    return TwinPlant(simulation(), units)
