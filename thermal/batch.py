"""Heat of many grasps at once: every row its own network, object and conductances; rows never mix.

B: rows, F: fingertips of a row, T: different networks, K: states of the largest, M: its contact ports, Q: pole pairs,
N: samples of a call.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit

from thermograsp.errors import InvalidValueError

from .air import with_air
from .coupling import POLES, propagator
from .coupling_kernel import FAST, StepArrays, advance, workspace
from .system import ContactSystem


class HeatTables(NamedTuple):
    """Networks of the same fingertips, padded to one size, for steps of dt s. states, object_states, sensor_states and
    modes: (T,) true sizes. rates (T, K), ports (T, M, K), scale_real and scale_imag (T, Q, K), gram (T, Q, M, M), drop,
    element_heat, sensor_surface and object_surface (T, F, K), object_heat, air_loss (W) and reservoir (J) (T, K), mean
    (T,): the index of the object's mean temperature (T mode)."""

    dt: float
    states: np.ndarray
    object_states: np.ndarray
    sensor_states: np.ndarray
    modes: np.ndarray
    rates: np.ndarray
    ports: np.ndarray
    scale_real: np.ndarray
    scale_imag: np.ndarray
    gram: np.ndarray
    drop: np.ndarray
    element_heat: np.ndarray
    sensor_surface: np.ndarray
    object_surface: np.ndarray
    object_heat: np.ndarray
    air_loss: np.ndarray
    mean: np.ndarray
    reservoir: np.ndarray

    @property
    def fingertips(self) -> int:
        """F."""
        return self.drop.shape[1]


class HeatReading(NamedTuple):
    """At the end of each step of a call. drop: (B, N, F) K. element_heat: (B, N, F) J. object_heat: (B, N) J.
    sensor_rise, object_rise: (B, N, F) K of the two contact faces above what each body started from. flow: (B, N, F)
    W from sensor to object and air_loss: (B, N) W from the object to the air, means over the step."""

    drop: np.ndarray
    element_heat: np.ndarray
    object_heat: np.ndarray
    sensor_rise: np.ndarray
    object_rise: np.ndarray
    flow: np.ndarray
    air_loss: np.ndarray


def heat_tables(systems: Sequence[ContactSystem], air: Sequence[float], dt: float) -> HeatTables:
    """Tables of the systems (T of them) in air W/(m2 K). Raises InvalidValueError when their fingertips differ."""
    if len({system.geometry.fingertips for system in systems}) != 1:
        raise InvalidValueError("systems of one batch must have the same number of fingertips")
    count, fingertips, pairs = len(systems), systems[0].geometry.fingertips, len(POLES)
    states = np.array([len(s.rates) for s in systems])
    sensor_states = np.array([s.orders.sensor for s in systems])
    modes = np.array([s.modes for s in systems])
    k, m = int(states.max()), int(modes.max()) * fingertips
    rows = {
        name: np.zeros((count, fingertips, k))
        for name in ("drop", "element_heat", "sensor_surface", "object_surface")
    }
    tables = HeatTables(
        dt=dt,
        states=states,
        object_states=states - fingertips * sensor_states,
        sensor_states=sensor_states,
        modes=modes,
        rates=np.zeros((count, k)),
        ports=np.zeros((count, m, k)),
        scale_real=np.zeros((count, pairs, k)),
        scale_imag=np.zeros((count, pairs, k)),
        gram=np.zeros((count, pairs, m, m), complex),
        object_heat=np.zeros((count, k)),
        air_loss=np.zeros((count, k)),
        mean=np.array([s.mean for s in systems]),
        reservoir=np.zeros((count, k)),
        **rows,
    )
    for i, (system, film) in enumerate(zip(systems, air, strict=True)):
        n, p = len(system.rates), system.ports.shape[1]
        if system.air_loss is None:
            aired, tables.air_loss[i, :n] = with_air(system, film)
        else:
            aired, tables.air_loss[i, :n] = system, system.air_loss
        if system.reservoir is not None:
            tables.reservoir[i, :n] = system.reservoir
        stepper = propagator(aired.rates, aired.ports, dt)
        tables.rates[i, :n], tables.ports[i, :p, :n] = stepper.rates, stepper.ports.T
        tables.scale_real[i, :, :n], tables.scale_imag[i, :, :n] = (
            np.real(stepper.scale),
            np.imag(stepper.scale),
        )
        tables.gram[i, :, :p, :p] = stepper.gram
        for name, table in rows.items():
            table[i, :, :n] = getattr(aired, name)
        tables.object_heat[i, :n] = aired.object_heat
    return tables


def advance_heat(
    tables: HeatTables,
    network: np.ndarray,
    state: np.ndarray,
    conductance: np.ndarray,
    difference: np.ndarray,
    active: np.ndarray,
    samples: int,
) -> tuple[np.ndarray, HeatReading]:
    """State (B, K) after `samples` steps and what was read at each.

    network: (B,) which of the tables' networks. state: (B, K). conductance: (B, F) W/K of each contact, constant over
    the call, >= 0. difference: (B, F) K, what sensor less object was when both were uniform. active: (B,) bool; other
    rows are left as they are and cost nothing. The input is not changed.
    """
    rows, fingertips = conductance.shape
    per_tip, per_row = (rows, samples, fingertips), (rows, samples)
    reading = HeatReading(
        drop=np.zeros(per_tip),
        element_heat=np.zeros(per_tip),
        object_heat=np.zeros(per_row),
        sensor_rise=np.zeros(per_tip),
        object_rise=np.zeros(per_tip),
        flow=np.zeros(per_tip),
        air_loss=np.zeros(per_row),
    )
    state = state.copy()
    _advance_rows(tables, network, state, conductance, difference, active, reading)
    return state, reading


def forget_field(tables: HeatTables, network: np.ndarray, state: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """State (B, K) with the object of the given rows (B,) bool at its mean temperature throughout: what a touch at a
    new place finds. The object's heat is unchanged (only its mean state holds any); the fingertips' states stay."""
    state = state.copy()
    for row in np.flatnonzero(rows):
        forget_row(tables, network[row], state[row])
    return state


def shift_thermostats(
    tables: HeatTables, network: np.ndarray, state: np.ndarray, difference: np.ndarray, change: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(state (B, K), difference (B, F)) after the thermostats' temperatures moved by change (B, F) K.

    Networks hold temperatures above the thermostat's, so the same field is lower by the change throughout the elements
    that sit on it (T mode): minus the change times their row of stored heat, which is the uniform field's coordinates.
    """
    state = state.copy()
    for f in range(tables.fingertips):
        moved = tables.element_heat[network, f] * (tables.sensor_states[network] > 0)[:, None]
        state -= moved * change[:, f : f + 1]
    return state, difference + change


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _advance_rows(tables, network, state, conductance, difference, active, reading):
    room = workspace(tables.rates.shape[1], tables.ports.shape[1])
    for b in range(len(active)):
        if active[b]:
            advance_row(tables, network[b], state[b], conductance[b], difference[b], 0.0, room, reading, b)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def advance_row(tables, i, x, conductance, difference, around, room, reading, b):
    """advance_heat of one row for compiled callers: network i, state x (K,) in place, conductance and difference (F,),
    into row b of the reading. around: K, the surroundings above the object's first temperature; air_loss stays what
    would be lost to surroundings at that temperature. room: a workspace of the tables' size."""
    samples, fingertips = reading.drop.shape[1:]
    n, p = tables.states[i], tables.modes[i]
    system = StepArrays(
        tables.dt,
        tables.rates[i],
        tables.ports[i],
        tables.scale_real[i],
        tables.scale_imag[i],
        tables.gram[i],
        tables.object_states[i],
        tables.sensor_states[i],
        p,
        fingertips,
        tables.air_loss[i],
        around,
    )
    weight, drive, flow = room.weight, room.drive, room.flow
    drive[:] = 0.0
    for f in range(fingertips):
        drive[f * p] = difference[f]
        weight[f * p : (f + 1) * p] = conductance[f]
    for k in range(samples):
        reading.air_loss[b, k] = advance(system, x, weight, drive, flow, room)
        for f in range(fingertips):
            reading.drop[b, k, f] = _dot(tables.drop, i, f, x, n)
            reading.element_heat[b, k, f] = _dot(tables.element_heat, i, f, x, n)
            reading.sensor_rise[b, k, f] = _dot(tables.sensor_surface, i, f, x, n)
            reading.object_rise[b, k, f] = _dot(tables.object_surface, i, f, x, n)
            reading.flow[b, k, f] = flow[f * p]
        total = 0.0
        for j in range(n):
            total += tables.object_heat[i, j] * x[j]
        reading.object_heat[b, k] = total


@njit(cache=True, error_model="numpy")
def forget_row(tables, i, x):
    """forget_field of one row for compiled callers: network i, state x (K,) in place."""
    mean = x[tables.mean[i]]
    x[: tables.object_states[i]] = 0.0
    x[tables.mean[i]] = mean


@njit(cache=True, fastmath=FAST, inline="always")
def _dot(rows, i, f, state, count):
    total = 0.0
    for j in range(count):
        total += rows[i, f, j] * state[j]
    return total
