"""Fingertips with heaters of their own: what stands in a thermostat's place behind an element, stepped beside it.

W: worlds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

import numpy as np

from ...thermal.kernels import Tip
from ...thermal.stack import CoreState, heated_core
from ..scene import PadPlace


class HeatedBack:
    """The core behind fingertip number `tip`, of all worlds, in steps of dt s; the room is at `ambient` °C. Within a
    step the heater's place is as warm as at its start (thermal.stack.core)."""

    def __init__(
        self, pad: PadPlace, number: int, element: Tip, *, worlds: int, dt: float, ambient: float
    ) -> None:
        assert pad.heated is not None
        self.tip, self._dt, self._ambient = number, dt, ambient
        self._divider, self._core = pad.heated.divider, heated_core(pad.heated, dt)
        self._heat, self._field = element.side.outputs["element"], element.uniform
        self._capacity = pad.stack.heat_capacity
        self._first = self._core.settled(np.full(worlds, pad.temperature), ambient)
        self._state = _copied(self._first)

    def reset(self, worlds: Sequence[int]) -> None:
        """Those worlds' have been as warm as at the start for long."""
        for field in fields(CoreState):
            getattr(self._state, field.name)[worlds] = getattr(self._first, field.name)[worlds]

    def held(self, states: np.ndarray) -> np.ndarray:
        """(W,) J in the element above the heater's place, of its states (W, K)."""
        return (states[:, : len(self._heat)] * self._heat).sum(axis=1)

    def step(
        self, states: np.ndarray, before: np.ndarray, passed: np.ndarray, drop: np.ndarray, force: np.ndarray
    ) -> None:
        """After a step of the fields. states: (W, K) of the element, which are then seen from where the heater's place
        has gone. before: (W,) J held at the step's start. passed: (W,) J out of its face. drop: (W,) K. force: (W,) N.

        What the slowest modes do not hold of a change has been taken from the heater's place at once."""
        rest = self._capacity - float(self._heat @ self._field)
        drawn = (self.held(states) - before + rest * self._state.change + passed) / self._dt
        self._state = _copied(self._core.step(self._state, drawn, drop, force, self._ambient))
        states[:, : len(self._field)] -= self._state.change[:, None] * self._field

    @property
    def temperature(self) -> np.ndarray:
        """(W,) °C of the heater's place."""
        return self._state.temperature

    @property
    def gained(self) -> np.ndarray:
        """(W,) J that the element has by its back's being warmer than at the start."""
        return self._capacity * (self._state.temperature - self._first.temperature)

    @property
    def voltage(self) -> np.ndarray:
        """(W,) V of the divider."""
        return self._divider.voltage(self._state.reading)

    def state(self) -> CoreState:
        """A copy of what it remembers."""
        return _copied(self._state)

    def set_state(self, state: CoreState) -> None:
        """Puts it into a state taken by `state`."""
        self._state = _copied(state)


def _copied(state: CoreState) -> CoreState:
    """With an array of its own in every field, to be written to."""
    return CoreState(*(getattr(state, field.name).copy() for field in fields(state)))
