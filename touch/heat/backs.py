"""What is behind an element and is not as warm as at the start: a thermostat of finite power, or the core of a sensor
with a heater of its own. It is stepped beside the fields, and is within a step as warm as at its start.

W: worlds.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import fields
from typing import Any, Generic, TypeVar

import numpy as np

from ...thermal import ThermostatState, settled_thermostat, thermostat_step
from ...thermal.readout import thermostat_at
from ...thermal.stack import CoreState, heated_core
from ..scene import PadPlace
from .places import TipField

_State = TypeVar("_State", CoreState, ThermostatState)


class _Back(ABC, Generic[_State]):
    """Behind fingertip number `tip`, of all worlds, in steps of dt s. first: its state at the start."""

    def __init__(self, pad: PadPlace, number: int, element: TipField, dt: float, first: _State) -> None:
        self.tip, self._dt = number, dt
        self._heat, self._field = element.tip.side.outputs["element"], element.uniform
        self._capacity = 0.0 if pad.bare else pad.stack.heat_capacity
        self._first = first
        self._state = _copied(first)
        self._change = np.zeros(len(first.temperature))

    def reset(self, worlds: Sequence[int]) -> None:
        """Those worlds' have been as warm as at the start for long."""
        self._change[worlds] = 0.0
        for field in fields(self._first):
            getattr(self._state, field.name)[worlds] = getattr(self._first, field.name)[worlds]

    def held(self, states: np.ndarray) -> np.ndarray:
        """(W,) J in the element above its back, of its states (W, K)."""
        return (states[:, : len(self._heat)] * self._heat).sum(axis=1)

    def step(
        self, states: np.ndarray, before: np.ndarray, passed: np.ndarray, drop: np.ndarray, force: np.ndarray
    ) -> None:
        """After a step of the fields. states: (W, K) of the element, which are then seen from where its back has gone.
        before: (W,) J held at the step's start. passed: (W,) J out of its face. drop: (W,) K. force: (W,) N.

        What the slowest modes do not hold of a change has been taken from the back at once."""
        rest = self._capacity - float(self._heat @ self._field)
        drawn = (self.held(states) - before + rest * self._change + passed) / self._dt
        was = self._state.temperature
        self._state = _copied(self._after(drawn, drop, force))
        self._change = self._state.temperature - was
        states[:, : len(self._field)] -= self._change[:, None] * self._field

    @abstractmethod
    def _after(self, drawn: np.ndarray, drop: np.ndarray, force: np.ndarray) -> _State:
        """The state a step later, with (W,) W drawn from it."""

    @property
    def temperature(self) -> np.ndarray:
        """(W,) °C where the element's back is."""
        return self._state.temperature

    @property
    def gained(self) -> np.ndarray:
        """(W,) J that the element has by its back's being warmer than at the start."""
        return self._capacity * (self._state.temperature - self._first.temperature)

    def state(self) -> tuple[Any, np.ndarray]:
        """A copy of what it remembers."""
        return _copied(self._state), self._change.copy()

    def set_state(self, state: tuple[Any, np.ndarray]) -> None:
        """Puts it into a state taken by `state`."""
        self._state, self._change = _copied(state[0]), state[1].copy()


class HeatedBack(_Back[CoreState]):
    """The core behind the element of a sensor with a heater of its own (thermal.stack.core); the room is at `ambient`
    °C."""

    def __init__(
        self, pad: PadPlace, number: int, element: TipField, *, worlds: int, dt: float, ambient: float
    ) -> None:
        assert pad.heated is not None
        self._divider, self._core = pad.heated.divider, heated_core(pad.heated, dt)
        self._ambient = ambient
        first = self._core.settled(np.full(worlds, pad.temperature), ambient)
        super().__init__(pad, number, element, dt, first)

    def _after(self, drawn: np.ndarray, drop: np.ndarray, force: np.ndarray) -> CoreState:
        return self._core.step(self._state, drawn, drop, force, self._ambient)

    def sent(self, drop: np.ndarray) -> np.ndarray:
        """(W,) V of the divider, which the electronics take in place of a drop."""
        del drop
        return self._divider.voltage(self._state.reading)


class ThermostatBack(_Back[ThermostatState]):
    """The fingertip's thermostat of finite power (thermal.Thermostat), at the fingertip's temperature for long."""

    def __init__(self, pad: PadPlace, number: int, element: TipField, *, worlds: int, dt: float) -> None:
        assert pad.thermostat is not None
        self._thermostat = thermostat_at(pad.temperature, pad.thermostat, None if pad.bare else pad.stack, dt)
        super().__init__(pad, number, element, dt, settled_thermostat(self._thermostat, worlds))

    def _after(self, drawn: np.ndarray, drop: np.ndarray, force: np.ndarray) -> ThermostatState:
        del drop, force
        return thermostat_step(self._thermostat, self._state, drawn, self._dt)

    def sent(self, drop: np.ndarray) -> np.ndarray:
        """(W,) K of drop."""
        return drop


def _copied(state: _State) -> _State:
    """With an array of its own in every field, to be written to."""
    return type(state)(*(getattr(state, field.name).copy() for field in fields(state)))
