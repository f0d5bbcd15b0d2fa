"""The thermostats of a batch's fingertips: ideal ones, or of finite power with a controller.

B: environments, F = 2 fingertips.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...thermal import (
    TOO_HOT,
    SensorStack,
    Thermostat,
    ThermostatState,
    settled_thermostat,
    thermostat_step,
)
from ...thermal.readout import thermostat_at
from ..sensing import OVER_TEMPERATURE
from .states import arrays_of, copied, fingertip_rows

_OFF = -273.15  # °C, a setpoint at which no heater works


class Thermostats:
    """Of `num_envs` environments. model: of finite power, None for ideal ones. setpoints: °C of the left and the right
    one; one of finite power has the left one's. stack: in front of them, None in O mode. dt: s, the control step.

    They protect themselves as the device does (docs/protocol.md, LATCHED_OFF): from the moment that one of an
    environment's two measures TOO_HOT both heaters are off, however far it cools, until a reset sets them anew. An
    ideal one stays at its setpoint and never gets there."""

    def __init__(
        self,
        num_envs: int,
        model: Thermostat | None,
        setpoints: tuple[float, float],
        stack: SensorStack | None,
        dt: float,
    ) -> None:
        self.setpoints = np.tile(setpoints, (num_envs, 1))
        self._model = None if model is None else thermostat_at(setpoints[0], model, stack, dt)
        self._dt = dt
        self._hot = np.zeros(num_envs, bool)
        self._tripped = np.zeros((num_envs, 2), bool)
        if self._model is not None:
            self._state = copied(settled_thermostat(self._model, 2 * num_envs))

    def reset(self, rows: Sequence[int]) -> None:
        """The rows' have been at their setpoint for long."""
        self._hot[list(rows)] = False
        if self._model is not None:
            both = fingertip_rows(rows).ravel()
            settled = settled_thermostat(self._model, self.setpoints.size)
            for kept, new in zip(arrays_of(self._state), arrays_of(settled), strict=True):
                kept[both] = new[both]

    @property
    def ideal(self) -> bool:
        """Whether they stay as warm as they are, whatever is drawn from them."""
        return self._model is None

    def step(self, drawn: np.ndarray, first: np.ndarray) -> np.ndarray:
        """The thermostats' temperatures (B, F) °C after a control step in which heat `drawn` (B, F) W left them. first:
        (B, F) °C, what they started from."""
        if self._model is None:
            return first
        before, off = self._state, np.repeat(self._hot, 2)
        after = thermostat_step(self._model, before, drawn.ravel(), self._dt)
        if off.any():
            idle = thermostat_step(replace(self._model, setpoint=_OFF), before, drawn.ravel(), self._dt)
            both = zip(arrays_of(idle), arrays_of(after), strict=True)
            after = ThermostatState(*(np.where(off, a, b) for a, b in both))
        self._state = copied(after)
        too_hot = self._state.measured.reshape(-1, 2) >= TOO_HOT
        self._tripped = too_hot & ~self._hot[:, None]
        self._hot = self._hot | too_hot.any(axis=1)
        # The controller keeps its own sensor at the setpoint; where that errs, the plate is as much warmer.
        return self._state.temperature.reshape(-1, 2) + (first - self.setpoints)

    @property
    def measured(self) -> np.ndarray:
        """(B, F) °C by their own sensors; not to be written to."""
        if self._model is None:
            return self.setpoints
        return self._state.measured.reshape(-1, 2).copy()

    def tell(self, info: np.ndarray) -> None:
        """Writes into HEAT_INFO records (B,) which environments' heaters are off, and whose fingertips' heat has just
        put them off."""
        info["over_temperature"] = self._hot
        info["events"] |= np.where(self._tripped, np.uint8(OVER_TEMPERATURE), np.uint8(0))

    def state(self, rows: Sequence[int]) -> tuple[np.ndarray, ...]:
        """A copy of what the rows remember."""
        return (self._hot[list(rows)], *(array[fingertip_rows(rows)] for array in self._remembered()))

    def set_state(self, rows: Sequence[int], state: tuple[np.ndarray, ...]) -> None:
        """Puts the rows into a state taken by `state`."""
        self._hot[list(rows)], *arrays = state
        for kept, new in zip(self._remembered(), arrays, strict=True):
            kept[fingertip_rows(rows)] = new

    def _remembered(self) -> list[np.ndarray]:
        return [] if self._model is None else arrays_of(self._state)
