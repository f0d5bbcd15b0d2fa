"""Heat of many grasps at once: every row its own network, object and conductances; rows never mix.

B: rows, F: fingertips of a row, T: different networks, K: states of the largest, M: its contact ports, Q: pole pairs,
N: samples of a call.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numba import njit

from thermograsp.errors import InvalidValueError

from .coupling import POLES, propagator
from .coupling_kernel import advance
from .network_press import with_air
from .system import ContactSystem


@dataclass(frozen=True, slots=True)
class HeatTables:
    """Networks of the same fingertips, padded to one size, for steps of dt s. fingertips, modes and states: (T,) true
    sizes. rates (T, K), ports (T, K, M), scale (T, Q, K), gram (T, Q, M, M), drop, element_heat, sensor_surface and
    object_surface (T, F, K), object_heat (T, K), mean (T,), area (T,) m2 of the patch a network was made for."""

    dt: float
    fingertips: int
    modes: np.ndarray
    states: np.ndarray
    rates: np.ndarray
    ports: np.ndarray
    scale: np.ndarray
    gram: np.ndarray
    drop: np.ndarray
    element_heat: np.ndarray
    sensor_surface: np.ndarray
    object_surface: np.ndarray
    object_heat: np.ndarray
    mean: np.ndarray
    on_object: np.ndarray
    area: np.ndarray


@dataclass(frozen=True, slots=True)
class HeatReading:
    """At the end of each step of a call. drop: (B, N, F) K. element_heat: (B, N, F) J. object_heat: (B, N) J.
    sensor_rise, object_rise: (B, N, F) K of the two contact faces above what each body started from. flow: (B, N, F)
    W from sensor to object, the step's mean."""

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
    count = len(systems)
    fingertips = systems[0].geometry.fingertips
    states = np.array([len(s.rates) for s in systems])
    modes = np.array([s.modes for s in systems])
    k, m, q = int(states.max()), int(modes.max()) * fingertips, len(POLES)
    tables = HeatTables(
        dt,
        fingertips,
        modes,
        states,
        np.zeros((count, k)),
        np.zeros((count, k, m)),
        np.zeros((count, q, k), complex),
        np.zeros((count, q, m, m), complex),
        *(np.zeros((count, fingertips, k)) for _ in range(4)),
        np.zeros((count, k)),
        np.array([s.mean for s in systems]),
        np.zeros((count, k), bool),
        np.array([s.geometry.area for s in systems]),
    )
    for i, (system, film) in enumerate(zip(systems, air, strict=True)):
        n, p = len(system.rates), system.ports.shape[1]
        stepper = propagator(with_air(system, film), system.ports, dt)
        tables.rates[i, :n], tables.ports[i, :n, :p] = stepper.rates, stepper.ports
        tables.scale[i, :, :n], tables.gram[i, :, :p, :p] = stepper.scale, stepper.gram
        for name in ("drop", "element_heat", "sensor_surface", "object_surface"):
            getattr(tables, name)[i, :, :n] = getattr(system, name)
        tables.object_heat[i, :n] = system.object_heat
        tables.on_object[i, : n - fingertips * system.orders.sensor] = True
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
    state = state.copy()
    reading = HeatReading(
        np.zeros((rows, samples, fingertips)),
        np.zeros((rows, samples, fingertips)),
        np.zeros((rows, samples)),
        np.zeros((rows, samples, fingertips)),
        np.zeros((rows, samples, fingertips)),
        np.zeros((rows, samples, fingertips)),
        np.zeros((rows, samples)),
    )
    _advance_rows(
        tables.dt,
        tables.modes,
        tables.states,
        tables.rates,
        tables.ports,
        tables.scale,
        tables.gram,
        tables.drop,
        tables.element_heat,
        tables.sensor_surface,
        tables.object_surface,
        tables.object_heat,
        tables.mean,
        network,
        state,
        conductance,
        difference,
        active,
        reading.drop,
        reading.element_heat,
        reading.object_heat,
        reading.sensor_rise,
        reading.object_rise,
        reading.flow,
        reading.air_loss,
    )
    return state, reading


def forget_field(tables: HeatTables, network: np.ndarray, state: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """State (B, K) with the object of the given rows (B,) bool at its mean temperature throughout: what a touch at a new
    place finds. The object's heat is unchanged (only its mean state holds any); the fingertips' states stay."""
    state = state.copy()
    for row in np.flatnonzero(rows):
        table = network[row]
        local = tables.on_object[table].copy()
        local[tables.mean[table]] = False
        state[row, local] = 0.0
    return state


@njit(cache=True, error_model="numpy")
def _advance_rows(
    dt,
    modes,
    states,
    rates,
    ports,
    scale,
    gram,
    drop,
    element_heat,
    sensor_surface,
    object_surface,
    object_heat,
    mean,
    network,
    state,
    conductance,
    difference,
    active,
    drop_out,
    element_out,
    object_out,
    sensor_out,
    surface_out,
    flow_out,
    loss_out,
):
    rows, samples, fingertips = drop_out.shape
    for b in range(rows):
        if not active[b]:
            continue
        i = network[b]
        n, p = states[i], modes[i]
        m = p * fingertips
        weight = np.zeros(m)
        drive = np.zeros(m)
        flow = np.zeros(m)
        for f in range(fingertips):
            drive[f * p] = difference[b, f]
            for j in range(p):
                weight[f * p + j] = conductance[b, f]
        own = np.ascontiguousarray(ports[i, :n, :m])
        own_scale = np.ascontiguousarray(scale[i, :, :n])
        own_gram = np.ascontiguousarray(gram[i, :, :m, :m])
        own_rates = rates[i, :n]
        x = state[b, :n]
        for k in range(samples):
            level = advance(own_rates, own, own_scale, own_gram, dt, x, weight, drive, flow, mean[i])
            kept = object_heat[i, mean[i]]
            for f in range(fingertips):
                kept += element_heat[i, f, mean[i]]
            loss_out[b, k] = own_rates[mean[i]] * kept * level
            for f in range(fingertips):
                flow_out[b, k, f] = flow[f * p]
                for j in range(n):
                    drop_out[b, k, f] += drop[i, f, j] * x[j]
                    element_out[b, k, f] += element_heat[i, f, j] * x[j]
                    sensor_out[b, k, f] += sensor_surface[i, f, j] * x[j]
                    surface_out[b, k, f] += object_surface[i, f, j] * x[j]
            for j in range(n):
                object_out[b, k] += object_heat[i, j] * x[j]
