"""The thermostats of an emulated device: both plates with their heaters, thermistors, and what breaks of them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ...thermal import (
    TOO_HOT,
    Thermostat,
    ThermostatState,
    thermostat_step,
)
from ..protocol import (
    LATCHING,
    Check,
    Flag,
    HeatersOff,
    Pair,
)

_CONTROL = 0.02  # s, period of the controllers
_OFF_SETPOINT = 1.0  # K
_OFF = -273.15  # °C, a setpoint at which no heater works
_RUNAWAY_ENERGY = 30.0  # J that must have warmed a plate
_RUNAWAY_RISE = 0.5  # K by that much


class EmulatedPlates:
    """Start at the surroundings' temperature, heaters off. setpoint: °C, NaN for a heater that is off. latched: why
    both heaters are off until that is cleared. broken_thermistors, broken_heaters: fingertips of which that is so; a
    broken heater is driven and warms nothing."""

    def __init__(self, thermostat: Thermostat) -> None:
        self.setpoint: Pair = (math.nan, math.nan)
        self.latched = HeatersOff(0)
        self.broken_thermistors: set[int] = set()
        self.broken_heaters: set[int] = set()
        self._thermostat = thermostat
        self._now = 0.0
        ambient, zero = np.array([thermostat.ambient]), np.zeros(1)
        self._plates = [ThermostatState(ambient, ambient, ambient, zero, zero) for _ in range(2)]
        self._coldest = [thermostat.ambient] * 2  # since it became warmer last
        self._spent = [0.0] * 2  # J since then

    def advance(self, now: float, heat: Pair, given: Pair | None) -> None:
        """Up to now, s, in whole periods of the controllers. heat: W drawn from each plate. given: °C that the plates
        have, whatever the heaters do."""
        while self._now + _CONTROL <= now:
            self._now += _CONTROL
            for i in range(2):
                self._plates[i] = self._stepped(i, heat[i])
                if given is None:
                    self._watch(i)
        if given is not None:
            for i in range(2):
                self.put(i, given[i])
        for i in range(2):
            if self.too_hot(i):
                self.latched |= HeatersOff(HeatersOff.TOO_HOT_LEFT << i)

    def clear(self, faults: HeatersOff) -> bool:
        """These are latched no longer; False, and nothing is done, while a plate is too hot."""
        if any(self.too_hot(i) for i in range(2)):
            return False
        self.latched &= ~faults & LATCHING
        self._spent = [0.0] * 2
        return True

    def too_hot(self, i: int) -> bool:
        """Whether that plate is, now, as far as its thermistor can tell."""
        return i not in self.broken_thermistors and float(self._plates[i].measured[0]) >= TOO_HOT

    def _stepped(self, i: int, heat: float) -> ThermostatState:
        model = replace(self._thermostat, setpoint=_OFF if self._off(i) else self.setpoint[i])
        after = thermostat_step(model, self._plates[i], np.array([heat]), _CONTROL)
        if i in self.broken_heaters:  # none of its power arrives
            after = thermostat_step(model, self._plates[i], heat + after.power, _CONTROL)
        return after

    def _watch(self, i: int) -> None:
        """For a heater that is on without its plate becoming warmer."""
        measured, power = float(self._plates[i].measured[0]), float(self._plates[i].power[0])
        below = self.setpoint[i] - measured > _OFF_SETPOINT  # never where it is off, NaN
        self._coldest[i] = min(self._coldest[i], measured)
        if not below or measured >= self._coldest[i] + _RUNAWAY_RISE:
            self._coldest[i], self._spent[i] = measured, 0.0
        self._spent[i] += power * _CONTROL
        if below and self._spent[i] >= _RUNAWAY_ENERGY:
            self.latched |= HeatersOff(HeatersOff.RUNAWAY_LEFT << i)

    def put(self, fingertip: int, temperature: float) -> None:
        """A plate is at that temperature, °C."""
        plate = np.array([temperature])
        self._plates[fingertip] = replace(
            self._plates[fingertip], temperature=plate, measured=plate, previous=plate
        )

    @property
    def temperatures(self) -> Pair:
        """°C by the thermistors, NaN for a broken one."""
        left, right = (
            math.nan if i in self.broken_thermistors else float(plate.measured[0])
            for i, plate in enumerate(self._plates)
        )
        return left, right

    @property
    def powers(self) -> Pair:
        """W of the heaters."""
        left, right = (max(0.0, float(plate.power[0])) for plate in self._plates)
        return left, right

    @property
    def flags(self) -> Flag:
        """What is wrong with them."""
        flags = Flag.LATCHED_OFF if self.latched else Flag(0)
        for i, temperature in enumerate(self.temperatures):
            if math.isnan(temperature):
                flags |= Flag(Flag.OPEN_LEFT << i)
            elif abs(temperature - self.setpoint[i]) > _OFF_SETPOINT:  # never where it is off, NaN
                flags |= Flag(Flag.OFF_SETPOINT_LEFT << i)
        return flags

    @property
    def failed(self) -> Check:
        """What a self-test finds."""
        failed = Check(0)
        for i in self.broken_thermistors:
            failed |= Check(Check.LEFT_THERMISTOR << i)
        for i in self.broken_heaters:
            failed |= Check(Check.LEFT_HEATER << i)
        return failed

    def _off(self, i: int) -> bool:
        return math.isnan(self.setpoint[i]) or bool(self.latched) or i in self.broken_thermistors
