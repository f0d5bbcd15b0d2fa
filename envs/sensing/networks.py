"""The thermal networks of a batch: each built once, known by its number, laid out in one table for compiled code."""

from __future__ import annotations

from collections.abc import Callable, Container
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ...thermal import (
    ContactSystem,
    Demand,
    Geometry,
    HeatTables,
    heat_tables,
    network_for,
    network_of,
)
from ...thermal.batch import TipRows, carry_matrix, no_heat_tables, tip_rows
from ...thermal.network import box_choice

if TYPE_CHECKING:
    from .touches import Touches


MOST_NETWORKS = 256  # beside those in use


class HeatNetworks:
    """The thermal networks of a batch, by number. dt: s of a heat sample. cache: keep networks on disk.
    least_sensor_states: of each fingertip (T mode), also where the tolerance needs fewer. used: tells the numbers that
    are in use. systems, rungs: the networks and their names, by number.

    From MOST_NETWORKS on a new one takes the number of the one that was asked for longest ago and is not in use, so
    that memory stays the same however many sizes and places are drawn."""

    def __init__(
        self, dt: float, cache: bool, least_sensor_states: int, used: Callable[[], Container[int]]
    ) -> None:
        self._dt, self._cache, self._least_sensor_states = dt, cache, least_sensor_states
        self._used = used
        self._numbers: dict[object, int] = {}
        self._films: list[float] = []
        self._carries: dict[tuple[int, int], np.ndarray] = {}
        self._turns: dict[int, np.ndarray] = {}
        self._tables: HeatTables | None = None
        self.systems: list[ContactSystem] = []
        self.rungs: list[str] = []

    def tables(self, fingertips: int) -> HeatTables:
        """The tables of all networks."""
        return no_heat_tables(fingertips, self._dt) if self._tables is None else self._tables

    @property
    def states(self) -> int:
        """The number of states of the largest network."""
        return 0 if self._tables is None else self._tables.rates.shape[1]

    def of_plate(self, geometry: Geometry, demand: Demand, film: float) -> int:
        """Number of the plate's that keeps the demand, losing heat through a film of W/(m2 K)."""
        key = (geometry, demand.difference, demand.beside, film)
        if key not in self._numbers and geometry.surround is not None:
            choice = box_choice(geometry, demand, film)
            assert choice is not None  # or it raises
            self._add(key, choice.system, film, f"network:{choice.system.orders}")
        if key not in self._numbers:
            system = network_for(geometry, demand, cache=self._cache).system
            if 0 < system.orders.sensor < self._least_sensor_states:
                orders = replace(system.orders, sensor=self._least_sensor_states)
                system = network_of(geometry, orders, cache=self._cache)
            self._add(key, system, film, f"network:{system.orders}")
        return self._mark_used(key)

    def of_touches(self, touches: Touches, film: float, air: float) -> int:
        """Number of that of an object that is touched anywhere. air: W/K, of one whose contents feed its walls."""
        key = (touches.body, touches.contacts, film)
        if key not in self._numbers:
            filled = touches.body.filled(touches.film, air) if touches.fed else None
            system = (filled or touches.body).system(touches.contacts)
            number = self._add(key, system, film, f"body:{system.orders}")
            if filled is not None:
                self._turns[number] = filled.turn
        return self._mark_used(key)

    def field_carried(self, old: int, new: int, field: np.ndarray) -> np.ndarray:
        """Matrix that takes an object's field from one network to another, and what fills it along. field: the same of
        the networks without contents."""
        if old not in self._turns:
            return field
        whole = np.zeros((field.shape[0] + 1, field.shape[1] + 1))
        whole[:-1, :-1], whole[-1, -1] = field, 1.0
        return self._turns[new].T @ whole @ self._turns[old]

    def fingertip(self, number: int, tip: int) -> slice:
        """The slice of a fingertip's own states in a network's."""
        orders = self.systems[number].orders
        first = orders.even + (orders.odd or 0) + tip * orders.sensor
        return slice(first, first + orders.sensor)

    def tip_rows(self, number: int) -> TipRows:
        """What a fingertip's states tell in a network. Raises InvalidValueError in O mode."""
        return tip_rows(self.systems[number])

    def carried(self, old: int, new: int) -> np.ndarray:
        """Matrix that takes a fingertip's field from one network to another. Raises InvalidValueError in O mode."""
        if (old, new) not in self._carries:
            source, target = self.systems[old], self.systems[new]
            same = source is target
            self._carries[old, new] = (
                np.eye(source.orders.sensor) if same else carry_matrix(tip_rows(source), tip_rows(target))
            )
        return self._carries[old, new]

    def _mark_used(self, key: object) -> int:
        """Its number; it is now the one that was asked for last."""
        number = self._numbers[key] = self._numbers.pop(key)
        return number

    def _add(self, key: object, system: ContactSystem, film: float, rung: str) -> int:
        number = self._free_number()
        entry = slice(number, number + 1)  # of one that is given up, or behind the last
        self.systems[entry], self._films[entry], self.rungs[entry] = [system], [film], [rung]
        self._numbers[key] = number
        self._tables = heat_tables(self.systems, self._films, self._dt)
        return number

    def _free_number(self) -> int:
        """The number of a network that is forgotten for a new one, or the next where none is to be."""
        if len(self.systems) < MOST_NETWORKS:
            return len(self.systems)
        used = self._used()
        key = next((key for key, number in self._numbers.items() if number not in used), None)
        if key is None:
            return len(self.systems)
        number = self._numbers.pop(key)
        self._turns.pop(number, None)
        self._carries = {pair: matrix for pair, matrix in self._carries.items() if number not in pair}
        return number
