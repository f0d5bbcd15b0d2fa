"""The thermal networks of a batch: each built once, known by its number, laid out in one table for compiled code."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from thermograsp.errors import InvalidValueError

from ..thermal import ContactSystem, Demand, Geometry, HeatTables, heat_tables, network_for, network_of
from ..thermal.carry import carry_matrix

if TYPE_CHECKING:
    from .touches import Touches


class HeatNetworks:
    """dt: s of a heat sample. cache: keep networks on disk. least_sensor_states: of each fingertip (T mode), also where
    the tolerance needs fewer. systems, rungs: the networks and their names, by number."""

    def __init__(self, dt: float, cache: bool, least_sensor_states: int) -> None:
        self._dt, self._cache, self._least_sensor_states = dt, cache, least_sensor_states
        self._numbers: dict[object, int] = {}
        self._films: list[float] = []
        self._carries: dict[tuple[int, int], np.ndarray] = {}
        self._turns: dict[int, np.ndarray] = {}
        self._tables: HeatTables | None = None
        self.systems: list[ContactSystem] = []
        self.rungs: list[str] = []

    @property
    def tables(self) -> HeatTables:
        """Of all. Raises InvalidValueError while there is none."""
        if self._tables is None:
            raise InvalidValueError("the heat knows no objects yet: call reset first")
        return self._tables

    @property
    def states(self) -> int:
        """Of the largest."""
        return 0 if self._tables is None else self._tables.rates.shape[1]

    def of_plate(self, geometry: Geometry, demand: Demand, film: float) -> int:
        """Number of the plate's that keeps the demand, losing heat through a film of W/(m2 K)."""
        key = (geometry, demand.difference, film)
        if key not in self._numbers:
            system = network_for(geometry, demand, cache=self._cache).system
            if 0 < system.orders.sensor < self._least_sensor_states:
                orders = replace(system.orders, sensor=self._least_sensor_states)
                system = network_of(geometry, orders, cache=self._cache)
            self._add(key, system, film, f"network:{system.orders}")
        return self._numbers[key]

    def of_touches(self, touches: Touches, film: float, air: float) -> int:
        """Number of that of an object that is touched anywhere. air: W/K, of one whose contents feed its walls."""
        key = (touches.body, touches.contacts, film)
        if key not in self._numbers:
            filled = touches.body.filled(touches.film, air) if touches.fed else None
            system = (filled or touches.body).system(touches.contacts)
            if filled is not None:
                self._turns[len(self.systems)] = filled.turn
            self._add(key, system, film, f"body:{system.orders}")
        return self._numbers[key]

    def field_carried(self, old: int, new: int, field: np.ndarray) -> np.ndarray:
        """Matrix that takes an object's field from one network to another, and what fills it along. field: the same of
        the networks without contents."""
        if old not in self._turns:
            return field
        whole = np.zeros((field.shape[0] + 1, field.shape[1] + 1))
        whole[:-1, :-1], whole[-1, -1] = field, 1.0
        return self._turns[new].T @ whole @ self._turns[old]

    def fingertip(self, number: int, tip: int) -> slice:
        """Where a fingertip's own states are in a network's."""
        orders = self.systems[number].orders
        first = orders.even + (orders.odd or 0) + tip * orders.sensor
        return slice(first, first + orders.sensor)

    def carried(self, old: int, new: int) -> np.ndarray:
        """Matrix that takes a fingertip's field from one network to another. Raises InvalidValueError in O mode."""
        if (old, new) not in self._carries:
            source, target = self.systems[old], self.systems[new]
            same = source is target
            self._carries[old, new] = np.eye(source.orders.sensor) if same else carry_matrix(source, target)
        return self._carries[old, new]

    def _add(self, key: object, system: ContactSystem, film: float, rung: str) -> None:
        self._numbers[key] = len(self.systems)
        self.systems.append(system)
        self._films.append(film)
        self.rungs.append(rung)
        self._tables = heat_tables(self.systems, self._films, self._dt)
