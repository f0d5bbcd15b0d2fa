"""Emulated fingertips, gripper and arm that belong together: one simulated plant is what they move and feel."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from typing import Any

import numpy as np

from thermograsp.envs.limits import (
    LATERAL_REACH,
    MAX_HEIGHT,
    MAX_LATERAL_RATE,
    MAX_LIFT_RATE,
    SAMPLE_PERIOD,
)
from thermograsp.envs.plant import SimulatedPlant
from thermograsp.errors import InvalidValueError, within
from thermograsp.hardware import (
    Contact,
    EmulatedFingertips,
    EmulatedGripper,
    Feel,
    GripperModel,
)
from thermograsp.hardware.drivers import Activation
from thermograsp.plant import Command, Reading

_WIDE = 1e-4  # m from the whole stroke that still counts as wide open
_PRESSING = 0.2  # N on each pad
_STANDING = 2e-3  # m/s of fingers that something has stopped
_SHORT = 1e-3  # m short of their target
_REHEARSAL = 50  # control steps, in which the fingers reach an object
_PAUSE = 1.0  # s without a sample, in which the simulation stands still


class SimulatedAxis:
    """An axis of a simulated hand's arm, an Axis without a line. name: of its rate. travel: m. most_rate: m/s. rate:
    m/s that it was told last; the simulation follows it with its own acceleration, and stops at its ends. place: m
    after the last control step."""

    def __init__(self, name: str, travel: float, most_rate: float) -> None:
        self.travel, self.rate, self.place = travel, 0.0, 0.0
        self._name, self._most_rate = name, most_rate

    def move(self, rate: float) -> None:
        """See Axis. Raises InvalidValueError for a rate that the simulated arm does not have."""
        self.rate = float(within(self._name, rate, -self._most_rate, self._most_rate, "m/s"))

    def position(self) -> float:
        """See Axis."""
        return self.place

    def stop(self) -> None:
        """See Axis."""
        self.rate = 0.0

    def close(self) -> None:
        """Nothing is held."""


class SimulatedHand:
    """Serve `fingertips` and `gripper`, each on a line of its own; it is the gripper's Fingers, too. `lift` is an axis
    of its arm, and `lateral` the one along the table where two objects lie, else None. They stand still unless they
    are moved.

    A fresh object, drawn by SimulatedPlant.reset from default_rng(seed), default_rng(seed + 1), ..., stands between the
    fingers whenever an active gripper is wide open. Two objects stay until the gripper is activated anew, since the
    fingers open on the way from one to the other. Once `draw_next` has been called, objects come from it alone. The
    simulation goes on, a control step whenever one is due for the next sample, from the first command to close or to
    move the arm until the next object. While the gripper is not active nothing is between the fingers. Their speed is
    the simulation's, whatever the command says, and the plates keep the simulation's temperature. Two threads may serve
    the two lines.

    opening, contact, current: see Fingers. episodes: objects so far. reading: the simulation's last, None while nothing
    is between the fingers. Raises InvalidValueError for a plant of more than one environment.
    """

    def __init__(self, simulation: SimulatedPlant, seed: int = 0, model: GripperModel | None = None) -> None:
        if simulation.num_envs != 1:
            raise InvalidValueError(f"a hand is one gripper, the simulation has {simulation.num_envs}")
        model = model or GripperModel()
        self.opening, self.contact, self.current = model.units.stroke, Contact.NONE, 0.0
        self.episodes = 0
        self._simulation, self._seed, self._stroke = simulation, seed, model.units.stroke
        self._rehearse()
        self._plates = simulation.config.sensor_temperatures
        self._last_command = (model.units.stroke, 0.0)
        self.lift = SimulatedAxis("lift_rate", MAX_HEIGHT, MAX_LIFT_RATE)
        self.lateral: SimulatedAxis | None = None
        if simulation.layout.lateral:
            self.lateral = SimulatedAxis("lateral_rate", LATERAL_REACH, MAX_LATERAL_RATE)
        self._arm = [axis for axis in (self.lift, self.lateral) if axis is not None]
        self.reading: Reading | None = None
        self._asked = False
        self._begun: float | None = None  # s, of the control step that the reading is of
        self._next: tuple[np.random.Generator, Mapping[str, Any]] | None = None
        self._lock = threading.Lock()
        self.gripper = EmulatedGripper(model, self)
        self.fingertips = EmulatedFingertips(self._feel)  # feels at once

    def draw_next(self, rng: np.random.Generator, options: Mapping[str, Any]) -> None:
        """Takes the object away. The next one is drawn from `rng`, with the reset options of the simulation."""
        with self._lock:
            self.reading = self._begun = None
            self._arm_back()
            self._next, self._asked = (rng, options), True

    def move(self, target: float, force: float, speed: float, seconds: float) -> None:
        """See Fingers."""
        with self._lock:
            self._last_command = (target, force)
            if not self._active:
                self.reading = self._begun = None
            if self.reading is None or target > self.opening - _SHORT:
                self.contact = Contact.NONE
            if self.reading is None:
                step = speed * seconds
                self.opening += float(np.clip(target - self.opening, -step, step))

    @property
    def _active(self) -> bool:
        return self.gripper.state.activation == Activation.DONE

    def _arm_back(self) -> None:
        for axis in self._arm:
            axis.place = 0.0

    def _rehearse(self) -> None:
        """A grasp that nobody sees: what is compiled or loaded at a first touch must not keep a line waiting."""
        self._simulation.reset([0], [np.random.default_rng(self._seed)], {})
        for _ in range(_REHEARSAL):
            self._simulation.step(Command(np.zeros(1), np.full(1, 20.0), np.zeros(1)))

    def _feel(self, now: float) -> Feel:
        with self._lock:
            wide = min(self.opening, self._last_command[0]) > self._stroke - _WIDE
            if (
                self._active
                and wide
                and (
                    self.reading is None
                    or (self._begun is not None and not self._asked and self.lateral is None)
                )
            ):
                self._put_object()
            if self.reading is None or (
                self._begun is None and wide and not any(axis.rate for axis in self._arm)
            ):
                return Feel(thermostat=self._plates)
            return self._simulated(now)

    def _put_object(self) -> None:
        rng, options = self._next or (np.random.default_rng(self._seed + self.episodes), {})
        self._next = None
        self.reading, self._begun = self._simulation.reset([0], [rng], options), None
        self.opening, self.contact = self._stroke, Contact.NONE
        self._arm_back()
        self.episodes += 1

    def _simulated(self, now: float) -> Feel:
        """What the sample of time `now` feels."""
        dt, samples = self._simulation.dt, self._simulation.config.samples
        if self._begun is None or now - self._begun > _PAUSE:
            self._begun = now - dt  # a step is due
        place = round((now - self._begun) / SAMPLE_PERIOD)
        while place >= samples:
            self._step()
            self._begun += dt
            place -= samples
        assert self.reading is not None
        reading = self.reading
        left, right = reading.force[0].tolist()
        volts = reading.voltage[0, place].tolist()
        return Feel((volts[0], volts[1]), (0.0, 0.0), (left, right), tuple(reading.thermostat[0].tolist()))  # pyright: ignore[reportArgumentType]

    def _step(self) -> None:
        target, force = self._last_command
        command = Command(np.array([target]), np.array([force]), np.array([self.lift.rate]))
        if self.lateral is not None:
            command = command._replace(lateral_rate=np.array([self.lateral.rate]))
        reading = self._simulation.step(command)
        self.reading, self.opening = reading, float(reading.opening[0])
        self.lift.place = float(reading.height[0])
        if self.lateral is not None and reading.lateral is not None:
            self.lateral.place = float(reading.lateral[0])
        pressing = reading.force[0, :, 0].min() > _PRESSING
        standing = abs(reading.opening_rate[0]) < _STANDING and self.opening > target + _SHORT
        self.contact = Contact.CLOSING if pressing and standing else Contact.NONE
