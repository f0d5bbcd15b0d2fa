"""Contact to heat: forces of every substep become conductances, patches and the fingertips' temperature drops.

B: environments, S: substeps, F = 2 fingertips, N: heat samples of a control step, K: states of the largest network.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..thermal import (
    ContactSystem,
    Demand,
    HeatTables,
    advance_heat,
    forget_field,
    heat_tables,
    network_for,
    shift_thermostats,
)
from .contact_rows import ContactRows
from .things import Thing

CONDUCTANCES = (1e2, 1e3, 1e4, 1e5)  # W/(m2 K), over which a network must keep the tolerance
HORIZON = 20.0  # s of contact over which it must
LEAST_DIFFERENCE = 12.0  # K for which the tolerance is meant at least


@dataclass(frozen=True, slots=True)
class HeatState:
    """Everything that the heat of some environments remembers; picklable. state (B, K). difference (B, F) K, sensor
    less object when both were uniform. begun (B,): something has touched. touching (B, F). known (B, F): whether
    there is a patch, and anchor (B, F, 3) m where on the object, in its frame, it is. offset (B, F) K of the
    thermostats and stored (B, F) J that the elements gained. things: each environment's object."""

    state: np.ndarray
    difference: np.ndarray
    begun: np.ndarray
    touching: np.ndarray
    known: np.ndarray
    offset: np.ndarray
    stored: np.ndarray
    anchor: np.ndarray
    things: tuple[Thing, ...]


@dataclass(frozen=True, slots=True)
class HeatStep:
    """One control step. drop (B, N, F) K at the end of each heat sample. conductance (B, F) W/(m2 K) and area (B, F)
    m2 of the contact: their product, the mean over the substeps, is what heat saw. sensor_surface, object_surface (B,
    F) °C, means over the contact. object_temperature (B,) °C, the object's mean. heat (B, 3) J gained by left
    element, right element and object. flow (B, F) W into the object's side and air_loss (B,) W, the step's means.
    drawn (B, F) W from the thermostats. events: per environment (kind, fingertip).
    """

    drop: np.ndarray
    conductance: np.ndarray
    area: np.ndarray
    sensor_surface: np.ndarray
    object_surface: np.ndarray
    object_temperature: np.ndarray
    heat: np.ndarray
    flow: np.ndarray
    air_loss: np.ndarray
    drawn: np.ndarray
    events: tuple[tuple[tuple[str, str], ...], ...]


class GraspHeat:
    """The thermal side of `num_envs` grasps. tolerance: K. air: W/(m2 K) on the objects. dt: s, spacing of heat
    samples, `samples` of them in a control step. sensor_temperature: °C of the thermostats. cache: keep networks on
    disk."""

    def __init__(
        self,
        num_envs: int,
        *,
        tolerance: float,
        air: float,
        dt: float,
        samples: int,
        sensor_temperature: float,
        cache: bool = True,
    ) -> None:
        self._tolerance, self._air, self._dt, self._samples = tolerance, air, dt, samples
        self._sensor_temperature, self._cache = sensor_temperature, cache
        self._networks: dict[object, int] = {}
        self._systems: list[ContactSystem] = []
        self._tables: HeatTables | None = None
        self.rungs: list[str] = []
        self._network = np.zeros(num_envs, int)
        self._things: list[Thing | None] = [None] * num_envs
        self._contacts = ContactRows(num_envs)
        self._state = np.zeros((num_envs, 0))
        self._difference = np.zeros((num_envs, 2))
        self._begun = np.zeros(num_envs, bool)
        self._touching = np.zeros((num_envs, 2), bool)
        self._known = np.zeros((num_envs, 2), bool)
        self._anchor = np.zeros((num_envs, 2, 3))
        self._offset = np.zeros((num_envs, 2))  # K, thermostats above sensor_temperature
        self._stored = np.zeros((num_envs, 2))  # J, gained by the elements
        self._glued = np.zeros(num_envs, bool)
        self._reach = np.zeros(num_envs)
        self._capacity, self._element_capacity = np.ones(num_envs), np.zeros(num_envs)

    def reset(self, rows: Sequence[int], things: Sequence[Thing]) -> None:
        """The rows start with new objects, everything at its first temperature."""
        for row, thing in zip(rows, things, strict=True):
            self._place(row, thing)
            self._state[row] = 0.0
            self._difference[row] = self._sensor_temperature - thing.temperature
            self._begun[row] = False
            self._offset[row] = 0.0
            self._stored[row] = 0.0
            self._touching[row] = False
            self._known[row] = thing.mode == "O"
            self._anchor[row] = thing.spec.element_places

    def rung(self, row: int) -> str:
        """The model that computes an environment's heat."""
        return self.rungs[self._network[row]]

    def advance(self, force: np.ndarray, place: np.ndarray) -> HeatStep:
        """One control step. force: (B, S, F) N, normal, of each substep, 0 where apart. place: (B, F, 3) m, the
        sensor faces' middles in the object's frame at the end of the step."""
        rows = len(force)
        conductance, area = self._contacts.mean_contact(force)
        events = self._follow(area > 0, place)
        self._begun |= np.any(area > 0, axis=1)
        felt = conductance * area * self._felt(place)
        drop = np.zeros((rows, self._samples, 2))
        rise = [np.zeros((rows, 2)) for _ in range(2)]
        heat, flow = np.zeros((rows, 3)), np.zeros((rows, 2))
        before = self._stored
        object_heat, air_loss = np.zeros(rows), np.zeros(rows)
        if self._begun.any():
            assert self._tables is not None
            tips = self._tables.fingertips  # a fingertip without a sensor takes no part
            self._state, reading = advance_heat(
                self._tables,
                self._network,
                self._state,
                felt[:, :tips],
                self._difference[:, :tips],
                self._begun,
                self._samples,
            )
            drop[:, :, :tips] = reading.drop
            rise[0][:, :tips], rise[1][:, :tips] = reading.sensor_rise[:, -1], reading.object_rise[:, -1]
            object_heat = reading.object_heat[:, -1]
            heat[:, :tips], heat[:, 2] = reading.element_heat[:, -1], object_heat
            heat[:, :2] += ~self._glued[:, None] * self._element_capacity[:, None] * self._offset
            self._stored = heat[:, :2].copy()
            for k in range(self._samples):  # in fixed order: a row's bits must not depend on the others
                flow[:, :tips] += reading.flow[:, k] / self._samples
                air_loss += reading.air_loss[:, k] / self._samples
        duration = self._dt * self._samples
        drawn = flow + ~self._glued[:, None] * (self._stored - before) / duration
        thermostat = self._sensor_temperature + self._offset
        first = thermostat - self._difference
        return HeatStep(
            drop=drop,
            conductance=conductance,
            area=area,
            sensor_surface=thermostat + rise[0],
            object_surface=first + rise[1],
            object_temperature=first[:, 0] + object_heat / self._capacity,
            heat=heat,
            flow=flow,
            air_loss=air_loss,
            drawn=drawn,
            events=events,
        )

    def set_thermostats(self, celsius: np.ndarray) -> None:
        """Temperatures (B, F) °C of the thermostats from now on."""
        change = celsius - self._sensor_temperature - self._offset
        self._offset = self._offset + change
        if self._tables is not None:
            tips = self._tables.fingertips
            self._state, self._difference[:, :tips] = shift_thermostats(
                self._tables, self._network, self._state, self._difference[:, :tips], change[:, :tips]
            )

    def state(self, rows: Sequence[int]) -> HeatState:
        """A copy of what the rows remember."""
        chosen = list(rows)
        things = tuple(thing for thing in (self._things[row] for row in chosen) if thing is not None)
        return HeatState(
            self._state[chosen],
            self._difference[chosen],
            self._begun[chosen],
            self._touching[chosen],
            self._known[chosen],
            self._offset[chosen],
            self._stored[chosen],
            self._anchor[chosen],
            things,
        )

    def set_state(self, rows: Sequence[int], state: HeatState) -> None:
        """Puts the rows into a state taken by `state`."""
        for k, row in enumerate(rows):
            self._place(row, state.things[k])
            width = min(state.state.shape[1], self._state.shape[1])
            self._state[row] = 0.0
            self._state[row, :width] = state.state[k, :width]
            for mine, theirs in (
                (self._difference, state.difference),
                (self._begun, state.begun),
                (self._touching, state.touching),
                (self._known, state.known),
                (self._offset, state.offset),
                (self._stored, state.stored),
                (self._anchor, state.anchor),
            ):
                mine[row] = theirs[k]

    def _place(self, row: int, thing: Thing) -> None:
        self._things[row] = thing
        self._contacts.place(row, thing)
        self._glued[row] = thing.mode == "O"
        self._reach[row] = thing.stack.width / 2
        self._capacity[row] = thing.heat_capacity
        self._element_capacity[row] = thing.stack.heat_capacity
        difference = max(abs(self._sensor_temperature - thing.temperature), LEAST_DIFFERENCE)
        key = (thing.geometry, difference)
        if key not in self._networks:
            demand = Demand(self._tolerance, difference, CONDUCTANCES, HORIZON)
            choice = network_for(thing.geometry, demand, cache=self._cache)
            self._networks[key] = len(self._systems)
            self._systems.append(choice.system)
            self.rungs.append(f"network:{choice.system.orders}")
            self._tables = heat_tables(self._systems, [self._air] * len(self._systems), self._dt)
            grown = np.zeros((len(self._state), self._tables.rates.shape[1]))
            grown[:, : self._state.shape[1]] = self._state
            self._state = grown
        self._network[row] = self._networks[key]

    def _follow(self, touching: np.ndarray, place: np.ndarray) -> tuple[tuple[tuple[str, str], ...], ...]:
        """Touches, releases and new patches since the last step, per environment."""
        events: list[list[tuple[str, str]]] = [[] for _ in touching]
        renewed = np.zeros(len(touching), bool)
        moved = self._distance(place) > self._reach[:, None]
        for row, side in np.argwhere(
            (touching != self._touching) | (touching & moved & ~self._glued[:, None])
        ):
            tip = ("left", "right")[side]
            if not touching[row, side]:
                events[row].append(("release", tip))
                continue
            if not self._touching[row, side]:
                off = self._glued[row] and moved[row, side]
                events[row].append(("touch off the element" if off else "touch", tip))
            if self._glued[row]:
                continue
            if self._known[row, side] and moved[row, side]:
                events[row].append(("new patch", tip))
                renewed[row] = True
            if moved[row, side] or not self._known[row, side]:
                self._anchor[row, side] = place[row, side]
                self._known[row, side] = True
        self._touching = touching.copy()
        if renewed.any():
            assert self._tables is not None
            self._state = forget_field(self._tables, self._network, self._state, renewed)
        return tuple(tuple(items) for items in events)

    def _felt(self, place: np.ndarray) -> np.ndarray:
        """(B, F) bool: whether a sensor is in the contact; in O mode only where the element is glued."""
        return ~self._glued[:, None] | (self._distance(place) <= self._reach[:, None])

    def _distance(self, place: np.ndarray) -> np.ndarray:
        """(B, F) m from each sensor face to where it first touched, or to the glued element."""
        x, y, z = np.moveaxis(place - self._anchor, -1, 0)
        return np.sqrt(x * x + y * y + z * z)
