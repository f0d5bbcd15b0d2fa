"""The thermostats of an emulated device: both plates with their heaters, thermistors, and what breaks of them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..thermal import TOO_HOT, Thermostat, ThermostatState, thermostat_step
from .messages import Check, Flag, Pair

_CONTROL = 0.02  # s, period of the controllers
_OFF_SETPOINT = 1.0  # K
_OFF = -1000.0  # °C, a setpoint at which no heater works


class EmulatedPlates:
    """Start at the surroundings' temperature, heaters off. setpoint: °C, NaN for a heater that is off. hot: too hot
    once, heaters off until a setpoint is set. broken_thermistors, broken_heaters: fingertips of which that is so."""

    def __init__(self, thermostat: Thermostat) -> None:
        self.setpoint: Pair = (math.nan, math.nan)
        self.hot = False
        self.broken_thermistors: set[int] = set()
        self.broken_heaters: set[int] = set()
        self._thermostat = thermostat
        self._now = 0.0
        ambient, zero = np.array([thermostat.ambient]), np.zeros(1)
        self._plates = [ThermostatState(ambient, ambient, ambient, zero, zero) for _ in range(2)]

    def advance(self, now: float, heat: Pair, given: Pair | None) -> None:
        """Up to now, s, in whole periods of the controllers. heat: W drawn from each plate. given: °C that the plates
        have, whatever the heaters do."""
        while self._now + _CONTROL <= now:
            self._now += _CONTROL
            for i in range(2):
                model = replace(self._thermostat, setpoint=_OFF if self._off(i) else self.setpoint[i])
                self._plates[i] = thermostat_step(model, self._plates[i], np.array([heat[i]]), _CONTROL)
        if given is not None:
            for i in range(2):
                self.put(i, given[i])
        self.hot |= any(float(plate.measured[0]) >= TOO_HOT for plate in self._plates)

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
        flags = Flag.OVER_TEMPERATURE if self.hot else Flag(0)
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
        return math.isnan(self.setpoint[i]) or self.hot or i in self.broken_heaters | self.broken_thermistors
