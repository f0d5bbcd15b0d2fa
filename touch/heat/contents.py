"""What is in an object and keeps it hot or cold: one temperature behind a film on its walls, stepped beside the fields.

Half of a step's exchange comes before the step of the fields and half behind it (Strang splitting), each exact for
contents whose temperature stands still; heat that has left them changes it at the step's end, as in environments.

W: worlds, K: states.
"""

from __future__ import annotations

from collections import namedtuple
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from threadpoolctl import ThreadpoolController

from ...thermal import Reservoir
from ...thermal.matter import RESERVOIR_ROW, reservoir_step, reservoir_temperature
from .places import BodyField

Row = namedtuple("Row", RESERVOIR_ROW.names or ())  # quicker to read than a record
_BLAS = ThreadpoolController()


class ContentsState(NamedTuple):
    """temperature: (W,) °C, given and enthalpy: (W,) J, and rows: (W,) of a RESERVOIR_ROW's numbers."""

    temperature: np.ndarray
    given: np.ndarray
    enthalpy: np.ndarray
    rows: tuple[Row, ...]


class HeldContents:
    """In object number `object`, in steps of dt s. temperatures: (W, C) °C of all objects' contents, of which this is
    column `number`; it stays where it is. given: (W,) J to the object so far."""

    def __init__(
        self, object: int, reservoir: Reservoir, temperatures: np.ndarray, number: int, dt: float
    ) -> None:
        worlds = len(temperatures)
        self.object, self.given = object, np.zeros(worlds)
        self._reservoir, self._temperatures, self._number, self._dt = reservoir, temperatures, number, dt
        self._rows = [Row(*np.zeros(1, RESERVOIR_ROW)[0])] * worlds
        self._enthalpy, self._passed = np.zeros(worlds), np.zeros(worlds)
        self._bare: dict[int, BodyField] = {}

    def reset(self, w: int, celsius: float, bare: BodyField) -> None:
        """A world's at their first temperature, in an object of °C whose field, untouched, is `bare`."""
        row, self._enthalpy[w] = self._reservoir.row(celsius)
        self._rows[w] = Row(*row.tolist())
        self.temperature[w] = self._rows[w].temperature
        self.given[w], self._passed[w], self._bare[w] = 0.0, 0.0, bare

    @property
    def temperature(self) -> np.ndarray:
        """(W,) °C."""
        return self._temperatures[:, self._number]

    def exchange(self, states: np.ndarray, ambient: float) -> None:
        """Half a step. states: (W, K) of the object, in place. ambient: °C from which its temperature counts."""
        for w, bare in self._bare.items():
            held, modes, kept = bare.heat[0], len(bare.walls), _kept(bare, self._dt / 2)
            even, before = (self.temperature[w] - ambient) * held, states[w, 0]
            states[w, 0] -= even
            states[w, :modes] = kept @ states[w, :modes]
            states[w, 0] += even
            self._passed[w] += held * (states[w, 0] - before)  # with what rounding has added to it

    def end(self) -> None:
        """What heat has left them in the step, they do not have."""
        for w in self._bare:
            flow = self._passed[w] / self._dt
            self.given[w] += self._passed[w]
            self._enthalpy[w] = reservoir_step.py_func(self._rows[w], self._enthalpy[w], flow, self._dt)
            self.temperature[w] = reservoir_temperature.py_func(self._rows[w], self._enthalpy[w])
            self._passed[w] = 0.0

    def state(self) -> ContentsState:
        """A copy of what they remember between steps."""
        return ContentsState(
            self.temperature.copy(), self.given.copy(), self._enthalpy.copy(), tuple(self._rows)
        )

    def set_state(self, state: ContentsState, bare: list[BodyField]) -> None:
        """Puts them into a state taken by `state`, in objects whose fields, untouched, are these in each world."""
        self.temperature[:], self.given[:], self._enthalpy[:] = state[:3]
        self._rows, self._bare = list(state.rows), dict(enumerate(bare))


@lru_cache(maxsize=512)
def _kept(bare: BodyField, seconds: float) -> np.ndarray:
    """(own, own): what is left of the object's own states after so many s of the film alone, less the contents'."""
    with _BLAS.limit(limits=1, user_api="blas"):  # or the number of threads would decide last bits
        rates, turn = np.linalg.eigh(bare.walls)
        return turn * np.exp(-seconds * np.maximum(rates, 0.0)) @ turn.T
