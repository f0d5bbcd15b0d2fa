"""Contact to heat: forces of every substep become conductances, patches and the fingertips' temperature drops.

B: environments, S: substeps, F = 2 fingertips, N: heat samples of a control step, K: states of the largest network.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from thermograsp.errors import InvalidValueError

from ..thermal import (
    CONTACT_LAW,
    ContactSystem,
    Demand,
    HeatTables,
    free_area,
    heat_tables,
    network_for,
    network_of,
    shift_thermostats,
)
from ..thermal.carry import carry_matrix
from .heat_kernel import advance_grasps
from .heat_rows import EVENTS, HEAT_ROW, HEAT_TOLD
from .reservoir import RESERVOIR_ROW
from .things import Thing

CONDUCTANCES = (1e2, 1e3, 1e4, 1e5)  # W/(m2 K), over which a network must keep the tolerance
HORIZON = 20.0  # s of contact over which it must
LEAST_DIFFERENCE = 12.0  # K for which the tolerance is meant at least


@dataclass(frozen=True, slots=True)
class HeatState:
    """Everything that the heat of some environments remembers; picklable. rows: their HEAT_ROW records. state (n, K).
    things: each environment's object."""

    rows: np.ndarray
    state: np.ndarray
    things: tuple[Thing, ...]


class HeatStep(NamedTuple):
    """One control step. drop (B, N, F) K at the end of each heat sample. told (B,): HEAT_TOLD records of

    conductance (B, F) W/(m2 K) and area (B, F) m2 of the contact: their product, the mean over the substeps, is what
    heat saw. sensor_surface, object_surface (B, F) °C, means over the contact. object_temperature (B,) °C, the object's
    mean. heat (B, 3) J gained by left element, right element and object. flow (B, F) W into the object's side and
    air_loss (B,) W, the step's means. reservoir_temperature (B,) °C, nan where there is none, and reservoir_flow (B,) W
    into the object, the step's mean. drawn (B, F) W from the thermostats. over_temperature (B,):
    one of the thermostats has been too hot, and the heaters are off. imbalance (B,) J that the object's side
    gained beyond what flowed in less what the air took, and exchanged (B,) J, the flow's absolute sum, since the start.
    """

    drop: np.ndarray
    told: np.ndarray

    @property
    def events(self) -> np.ndarray:
        """(B,) of tuples of (kind, fingertip)."""
        codes = self.told["events"]
        return EVENTS[codes[:, 0], codes[:, 1]]


class GraspHeat:
    """The thermal side of `num_envs` grasps. tolerance: K. air: W/(m2 K) on the objects. dt: s, spacing of heat
    samples, `samples` of them in a control step. sensor_temperature: °C of the thermostats, one or
    each fingertip's. cache: keep networks on disk. least_sensor_states: of each fingertip (T mode), also where the
    tolerance needs fewer."""

    def __init__(
        self,
        num_envs: int,
        *,
        tolerance: float,
        air: float,
        dt: float,
        samples: int,
        sensor_temperature: float | tuple[float, float],
        cache: bool = True,
        least_sensor_states: int = 0,
    ) -> None:
        self._least_sensor_states = least_sensor_states
        self._carries: dict[tuple[int, int], np.ndarray] = {}
        self._tolerance, self._air, self._dt, self._samples = tolerance, air, dt, samples
        self._sensor_temperature, self._cache = sensor_temperature, cache
        self._networks: dict[object, int] = {}
        self._systems: list[ContactSystem] = []
        self._films: list[float] = []
        self._tables: HeatTables | None = None
        self.rungs: list[str] = []
        self._things: list[Thing | None] = [None] * num_envs
        self._rows = np.zeros(num_envs, HEAT_ROW)
        self._laws = np.zeros(num_envs, CONTACT_LAW)
        self._reservoirs = np.zeros(num_envs, RESERVOIR_ROW)
        self._state = np.zeros((num_envs, 0))

    def reset(
        self, rows: Sequence[int], things: Sequence[Thing], sensor_temperatures: np.ndarray | None = None
    ) -> None:
        """The rows start with new objects, everything at its first temperature. sensor_temperatures: °C of each row's
        thermostats, (n, F), where they differ from the batch's."""
        temperatures = np.broadcast_to(self._sensor_temperature, (len(rows), 2))
        if sensor_temperatures is not None:
            temperatures = sensor_temperatures
        for row, thing, temperature in zip(rows, things, temperatures, strict=True):
            self._place(row, thing, temperature)
            self._state[row] = 0.0
            fresh = self._rows[row]
            fresh["sensor_temperature"] = temperature
            fresh["difference"] = temperature - thing.temperature
            fresh["known"] = thing.mode == "O"
            fresh["anchor"] = thing.spec.element_places
            for name in ("offset", "stored", "touching", "books"):
                fresh[name] = 0
            fresh["begun"] = thing.spec.reservoir is not None or fresh["ambient"] != 0
            if thing.spec.reservoir is not None:
                fresh["enthalpy"] = thing.spec.reservoir.row(thing.temperature)[1]

    def rung(self, row: int) -> str:
        """The model that computes an environment's heat."""
        return self.rungs[self._rows["network"][row]]

    def advance(self, force: np.ndarray, place: np.ndarray) -> HeatStep:
        """One control step. force: (B, S, F) N, normal, of each substep, 0 where apart. place: (B, F, 3) m, the
        sensor faces' middles in the object's frame at the end of the step."""
        if self._tables is None:
            raise InvalidValueError("the heat knows no objects yet: call reset first")
        drop = np.empty((len(force), self._samples, 2))
        told = np.empty(len(force), HEAT_TOLD)
        advance_grasps(
            self._laws,
            self._reservoirs,
            self._rows,
            self._state,
            np.ascontiguousarray(force, dtype=float),
            np.ascontiguousarray(place, dtype=float),
            drop,
            told,
            *self._tables,
        )
        return HeatStep(drop, told)

    def rest(self) -> HeatStep:
        """What a step would tell of a batch in which nothing has touched yet."""
        told = np.zeros(len(self._rows), HEAT_TOLD)
        told["sensor_surface"] = self._rows["sensor_temperature"] + self._rows["offset"]
        told["object_surface"] = told["sensor_surface"] - self._rows["difference"]
        told["object_temperature"] = told["object_surface"][:, 0]
        told["reservoir_temperature"] = np.where(
            self._reservoirs["conductance"] > 0, self._reservoirs["temperature"], np.nan
        )
        return HeatStep(np.zeros((len(self._rows), self._samples, 2)), told)

    def set_thermostats(self, celsius: np.ndarray) -> None:
        """Temperatures (B, F) °C of the thermostats from now on."""
        change = celsius - self._rows["sensor_temperature"] - self._rows["offset"]
        self._rows["offset"] += change
        if self._tables is not None:
            tips = self._tables.fingertips
            self._state, self._rows["difference"][:, :tips] = shift_thermostats(
                self._tables,
                self._rows["network"],
                self._state,
                self._rows["difference"][:, :tips],
                change[:, :tips],
            )

    def carry(self, source: int, target: int, fingertip: int) -> None:
        """The fingertip's field goes from one row to another, whose object it touches from now on. The source's
        fingertip is left as warm as its thermostat. Raises InvalidValueError in O mode."""
        old, new = self._rows[source], self._rows[target]
        pair = int(old["network"]), int(new["network"])
        if pair not in self._carries:
            source_system, target_system = (self._systems[network] for network in pair)
            same = source_system is target_system
            self._carries[pair] = (
                np.eye(source_system.orders.sensor) if same else carry_matrix(source_system, target_system)
            )
        before, after = (self._fingertip(row, fingertip) for row in (source, target))
        # Row by row, so that rounding does not depend on what else the batch holds.
        self._state[target, after] = (self._carries[pair] * self._state[source, before]).sum(axis=1)
        self._state[source, before] = 0.0
        new["stored"][fingertip], old["stored"][fingertip] = old["stored"][fingertip], 0.0

    def _fingertip(self, row: int, fingertip: int) -> slice:
        """Where the fingertip's own states are in a row's."""
        orders = self._systems[self._rows[row]["network"]].orders
        first = orders.even + (orders.odd or 0) + fingertip * orders.sensor
        return slice(first, first + orders.sensor)

    def state(self, rows: Sequence[int]) -> HeatState:
        """A copy of what the rows remember."""
        chosen = list(rows)
        things = tuple(thing for thing in (self._things[row] for row in chosen) if thing is not None)
        return HeatState(self._rows[chosen], self._state[chosen], things)

    def set_state(self, rows: Sequence[int], state: HeatState) -> None:
        """Puts the rows into a state taken by `state`."""
        for k, row in enumerate(rows):
            self._place(row, state.things[k], state.rows["sensor_temperature"][k])
            network = self._rows["network"][row]  # this batch's own number of it
            self._rows[row] = state.rows[k]
            self._rows["network"][row] = network
            width = min(state.state.shape[1], self._state.shape[1])
            self._state[row] = 0.0
            self._state[row, :width] = state.state[k, :width]

    @property
    def sensor_temperatures(self) -> np.ndarray:
        """(B, F) °C of the thermostats at the start."""
        return self._rows["sensor_temperature"]

    def _place(self, row: int, thing: Thing, sensor_temperature: np.ndarray) -> None:
        self._things[row] = thing
        self._laws[row] = thing.law
        mine = self._rows[row]
        mine["glued"] = thing.mode == "O"
        mine["reach"] = thing.stack.width / 2
        mine["capacity"] = thing.heat_capacity
        mine["element_capacity"] = thing.stack.heat_capacity
        mine["ambient"] = (
            0.0 if thing.ambient is None or self._air == 0 else thing.ambient - thing.temperature
        )
        free = free_area(thing.geometry)
        mine["air"] = self._air * free
        self._reservoirs[row] = np.zeros(1, RESERVOIR_ROW)[0]
        if thing.spec.reservoir is not None:
            self._reservoirs[row] = thing.spec.reservoir.row(thing.temperature)[0]
        # What the object gives to the air and to a reservoir, as one film of that many W/(m2 K).
        film = self._air + float(self._reservoirs["conductance"][row]) / free
        celsius = [thing.temperature, thing.temperature + float(mine["ambient"])]
        if thing.spec.reservoir is not None:
            celsius.append(float(self._reservoirs["temperature"][row]))
        # In steps, so that nearly equal temperatures share a network.
        above = max(np.abs(sensor_temperature - each).max() for each in celsius) / LEAST_DIFFERENCE
        difference = LEAST_DIFFERENCE * 1.25 ** max(np.ceil(np.log(max(above, 1e-9)) / np.log(1.25)), 0.0)
        key = (thing.geometry, difference, film)
        if key not in self._networks:
            demand = Demand(self._tolerance, difference, CONDUCTANCES, HORIZON)
            system = network_for(thing.geometry, demand, cache=self._cache).system
            if 0 < system.orders.sensor < self._least_sensor_states:
                orders = replace(system.orders, sensor=self._least_sensor_states)
                system = network_of(thing.geometry, orders, cache=self._cache)
            self._networks[key] = len(self._systems)
            self._systems.append(system)
            self._films.append(film)
            self.rungs.append(f"network:{system.orders}")
            self._tables = heat_tables(self._systems, self._films, self._dt)
            grown = np.zeros((len(self._state), self._tables.rates.shape[1]))
            grown[:, : self._state.shape[1]] = self._state
            self._state = grown
        mine["network"] = self._networks[key]
