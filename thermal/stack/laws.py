"""What a heater does: laws, as numbers that a compiled step follows.

A law is open-loop (power known beforehand) or a controller on the reading; either may end when contact is made.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from thermograsp.errors import celsius, non_negative, positive


class Drive(NamedTuple):
    """A law for touches (B,) of n steps. power: (B, n) W/m2 whatever is read. controller: (setpoint °C, proportional,
    integral, derivative, limit) in W/m2 and K, limit 0 for none. until: (B,) step at which the controller is cut. held:
    whether the heater's place keeps its temperature whatever that takes. ends: N at which either ends for good."""

    power: np.ndarray
    controller: tuple[float, float, float, float, float]
    until: np.ndarray
    held: bool
    ends: float = np.inf


class HeaterMemory(NamedTuple):
    """What a law remembers from step to step, (B,) each. before: W/m2, what kept the sensor warm. cut: whether contact
    has ended the heating. integral: W/m2 and previous: °C, of a controller. setpoint: °C, which the reading began at.
    """

    before: np.ndarray
    cut: np.ndarray
    integral: np.ndarray
    previous: np.ndarray
    setpoint: np.ndarray

    @staticmethod
    def begin(before: np.ndarray, reading: np.ndarray) -> HeaterMemory:
        """Settled at that power and reading."""
        return HeaterMemory(before, np.zeros(len(before), bool), before, reading, reading)


_NO_CONTROLLER = (0.0, 0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Off:
    """No heat."""

    def drive(self, force: np.ndarray, before: np.ndarray) -> Drive:
        """force: (B, n + 1) N at the ends of steps. before: (B,) W/m2, the power that warmed the sensor so far."""
        return Drive(np.zeros((len(force), force.shape[1] - 1)), _NO_CONTROLLER, _never(force), False)

    def power_now(
        self, memory: HeaterMemory, force: np.ndarray, reading: np.ndarray, dt: float
    ) -> tuple[np.ndarray, HeaterMemory]:
        """(W/m2 over the next dt s, new memory), (B,). force: N and reading: °C at its start."""
        return np.zeros_like(reading), memory


@dataclass(frozen=True, slots=True)
class ConstantPower:
    """Always `power` W/m2; None for the power that warmed the sensor before the record."""

    power: float | None = None

    def __post_init__(self) -> None:
        if self.power is not None:
            non_negative("heater: power (W/m2)", self.power)

    def drive(self, force: np.ndarray, before: np.ndarray) -> Drive:
        """See Off.drive."""
        power = before if self.power is None else np.full(len(force), self.power)
        return Drive(
            np.repeat(power[:, None], force.shape[1] - 1, axis=1), _NO_CONTROLLER, _never(force), False
        )

    def power_now(
        self, memory: HeaterMemory, force: np.ndarray, reading: np.ndarray, dt: float
    ) -> tuple[np.ndarray, HeaterMemory]:
        """See Off.power_now."""
        return memory.before if self.power is None else np.full_like(reading, self.power), memory


@dataclass(frozen=True, slots=True)
class CutAtContact:
    """Constant power, as in ConstantPower, that ends for good when the force first reaches `force` N."""

    force: float
    power: float | None = None

    def __post_init__(self) -> None:
        positive("heater: force of the cut (N)", self.force)
        if self.power is not None:
            non_negative("heater: power (W/m2)", self.power)

    def drive(self, force: np.ndarray, before: np.ndarray) -> Drive:
        """See Off.drive."""
        constant = ConstantPower(self.power).drive(force, before)
        on = np.arange(force.shape[1] - 1) < cut_step(force, self.force)[:, None]
        return constant._replace(power=constant.power * on, ends=self.force)

    def power_now(
        self, memory: HeaterMemory, force: np.ndarray, reading: np.ndarray, dt: float
    ) -> tuple[np.ndarray, HeaterMemory]:
        """See Off.power_now."""
        cut = memory.cut | (force >= self.force)
        power, _ = ConstantPower(self.power).power_now(memory, force, reading, dt)
        return np.where(cut, 0.0, power), memory._replace(cut=cut)


@dataclass(frozen=True, slots=True)
class Held:
    """An ideal thermostat: the heater's place keeps its first temperature."""

    def drive(self, force: np.ndarray, before: np.ndarray) -> Drive:
        """See Off.drive."""
        return Off().drive(force, before)._replace(held=True)


@dataclass(frozen=True, slots=True)
class Pid:
    """A controller of the reading (unfiltered), once a step. setpoint: °C. proportional: W/(m2 K). integral: W/(m2 K
    s). derivative: W s/(m2 K). limit: W/m2, the heater's; it cannot cool. cut: N at which it is cut for good, None for
    never. The integral starts with the power that warmed the sensor before the record."""

    setpoint: float
    proportional: float
    integral: float
    limit: float
    derivative: float = 0.0
    cut: float | None = None

    def __post_init__(self) -> None:
        celsius("heater: setpoint (°C)", self.setpoint)
        positive("heater: limit (W/m2)", self.limit)
        for name in ("proportional", "integral", "derivative"):
            non_negative(f"heater: {name}", getattr(self, name))
        if self.cut is not None:
            positive("heater: cut (N)", self.cut)

    def drive(self, force: np.ndarray, before: np.ndarray) -> Drive:
        """See Off.drive."""
        gains = (self.setpoint, self.proportional, self.integral, self.derivative, self.limit)
        ends = np.inf if self.cut is None else self.cut
        power = np.repeat(before[:, None], force.shape[1] - 1, axis=1)
        return Drive(power, gains, cut_step(force, ends), False, ends)

    def power_now(
        self, memory: HeaterMemory, force: np.ndarray, reading: np.ndarray, dt: float
    ) -> tuple[np.ndarray, HeaterMemory]:
        """See Off.power_now. The setpoint is what the simulation begins at: its thermostats' temperature."""
        cut = memory.cut if self.cut is None else memory.cut | (force >= self.cut)
        error = memory.setpoint - reading
        grown = memory.integral + self.integral * error * dt
        wanted = self.proportional * error + grown - self.derivative * (reading - memory.previous) / dt
        power = np.clip(wanted, 0.0, self.limit)
        winding = (wanted - power) * error > 0
        kept = memory._replace(cut=cut, integral=np.where(winding, memory.integral, grown), previous=reading)
        return np.where(cut, 0.0, power), kept


HeaterLaw = Off | ConstantPower | CutAtContact | Held | Pid


def cut_step(force: np.ndarray, threshold: float) -> np.ndarray:
    """(B,) index of the first sample (B, n) at or above the threshold; n where there is none."""
    reached = force >= threshold
    return np.where(reached.any(axis=1), reached.argmax(axis=1), force.shape[1])


def _never(force: np.ndarray) -> np.ndarray:
    return np.full(len(force), force.shape[1])
