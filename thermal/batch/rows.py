"""Heat of many grasps at once: every row its own network, object and conductances; rows never mix.

B: rows, F: fingertips of a row, T: different networks, K: states of the largest, M: its contact ports, Q: pole pairs,
N: samples of a call.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit
from thermograsp.errors import InvalidValueError

from ..network import POLES, ContactSystem, StepArrays, advance, propagator, with_air, workspace
from ..numerics import FAST
from ..padded import RING_PORTS

# Rows of HeatTables; the fingertips' begin at TIPPED.
RATES, OBJECT_HEAT, AIR_LOSS, RESERVOIR, TIPPED = range(5)


class HeatTables(NamedTuple):
    """Networks of the same fingertips, padded to one size, for steps of dt s: few arrays, since compiled code takes as
    long to receive each as to use it.

    sizes (T, 6): states, object_states and sensor_states, modes, mean, the index of the object's mean temperature (T
    mode), and how many of each contact's ports, behind its first, are of the pad around the face. rows (T, R, K), each
    a property: rates 1/s, object_heat J, air_loss W and reservoir J (T, K); drop, element_heat, sensor_surface and
    object_surface (T, F, K); scale_real and scale_imag (T, Q, K); ports (T, M, K). gram (T, Q, M, M). The leading axis
    may be missing, for one network."""

    dt: float
    sizes: np.ndarray
    rows: np.ndarray
    gram: np.ndarray

    @property
    def fingertips(self) -> int:
        """F."""
        return _fingertips(self.rows.shape[-2], self.gram.shape[-3], self.gram.shape[-1])

    @property
    def states(self) -> np.ndarray:
        """(T,), true sizes."""
        return self.sizes[..., 0]

    @property
    def object_states(self) -> np.ndarray:
        """(T,), which come first."""
        return self.sizes[..., 1]

    @property
    def sensor_states(self) -> np.ndarray:
        """(T,), of each fingertip."""
        return self.sizes[..., 2]

    @property
    def modes(self) -> np.ndarray:
        """(T,), ports of each contact."""
        return self.sizes[..., 3]

    @property
    def mean(self) -> np.ndarray:
        """(T,), an index."""
        return self.sizes[..., 4]

    @property
    def rates(self) -> np.ndarray:
        """(T, K)."""
        return self.rows[..., RATES, :]

    @property
    def object_heat(self) -> np.ndarray:
        """(T, K)."""
        return self.rows[..., OBJECT_HEAT, :]

    @property
    def air_loss(self) -> np.ndarray:
        """(T, K)."""
        return self.rows[..., AIR_LOSS, :]

    @property
    def reservoir(self) -> np.ndarray:
        """(T, K)."""
        return self.rows[..., RESERVOIR, :]

    @property
    def drop(self) -> np.ndarray:
        """(T, F, K)."""
        return self._tipped(0)

    @property
    def element_heat(self) -> np.ndarray:
        """(T, F, K)."""
        return self._tipped(1)

    @property
    def sensor_surface(self) -> np.ndarray:
        """(T, F, K)."""
        return self._tipped(2)

    @property
    def object_surface(self) -> np.ndarray:
        """(T, F, K)."""
        return self._tipped(3)

    @property
    def scale_real(self) -> np.ndarray:
        """(T, Q, K)."""
        return self.rows[..., self._scales : self._scales + self.gram.shape[-3], :]

    @property
    def scale_imag(self) -> np.ndarray:
        """(T, Q, K)."""
        first = self._scales + self.gram.shape[-3]
        return self.rows[..., first : first + self.gram.shape[-3], :]

    @property
    def ports(self) -> np.ndarray:
        """(T, M, K)."""
        return self.rows[..., self._scales + 2 * self.gram.shape[-3] :, :]

    @property
    def _scales(self) -> int:
        return TIPPED + 4 * self.fingertips

    def _tipped(self, number: int) -> np.ndarray:
        first = TIPPED + number * self.fingertips
        return self.rows[..., first : first + self.fingertips, :]


class HeatReading(NamedTuple):
    """Outputs at the end of each step of a call. drop: (B, N, F) K. element_heat: (B, N, F) J. object_heat: (B, N) J.
    sensor_rise, object_rise: (B, N, F) K of the two contact faces above what each body started from. flow: (B, N, F) W
    from sensor to object and air_loss: (B, N) W from the object to the air, means over the step."""

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
    sizes = np.empty((count, 6), np.int64)
    for entry, s in zip(sizes, systems, strict=True):
        states, sensor_states = len(s.rates), s.orders.sensor
        beside = 0 if s.geometry.surround is None else len(range(s.modes)[RING_PORTS])
        entry[:] = states, states - fingertips * sensor_states, sensor_states, s.modes, s.mean, beside
    k, m = int(sizes[:, 0].max()), int(sizes[:, 3].max()) * fingertips
    rows = np.zeros((count, TIPPED + 4 * fingertips + 2 * pairs + m, k))
    tables = HeatTables(dt, sizes, rows, np.zeros((count, pairs, m, m), complex))
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
        for name in ("drop", "element_heat", "sensor_surface", "object_surface"):
            getattr(tables, name)[i, :, :n] = getattr(aired, name)
        tables.object_heat[i, :n] = aired.object_heat
    return tables


def no_heat_tables(fingertips: int, dt: float) -> HeatTables:
    """The tables of no network."""
    pairs = len(POLES)
    rows = np.zeros((0, TIPPED + 4 * fingertips + 2 * pairs, 0))
    return HeatTables(dt, np.zeros((0, 6), np.int64), rows, np.zeros((0, pairs, 0, 0), complex))


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
    the call, >= 0; pads around sensors' faces are apart. difference: (B, F) K, what sensor less object was when both
    were uniform. active: (B,) bool; other rows are left as they are and cost nothing. The input is not changed.
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
    room = workspace(tables.rows.shape[2], tables.gram.shape[3])
    open_flow = np.zeros(conductance.shape[1])
    for b in range(len(active)):
        if active[b]:
            for k in range(reading.drop.shape[1]):
                advance_row(
                    tables,
                    network[b],
                    state[b],
                    conductance[b],
                    open_flow,
                    difference[b],
                    0.0,
                    room,
                    reading,
                    b,
                    k,
                )


@njit(cache=True, inner=True, error_model="numpy", fastmath=FAST, forceinline=True)
def advance_row(tables, i, x, conductance, beside, difference, around, room, reading, b, k):
    """One sample of advance_heat of one row for compiled callers: network i, state x (K,) in place, conductance and
    difference (F,), into sample k of row b of the reading. beside: (F,) W/K of the pads around the faces. around: K,
    the surroundings above the object's first temperature; air_loss stays what would be lost to surroundings at that
    temperature. room: a workspace of the tables' size."""
    fingertips = reading.drop.shape[2]
    n, object_states, sensor_states, p = (
        tables.sizes[i, 0],
        tables.sizes[i, 1],
        tables.sizes[i, 2],
        tables.sizes[i, 3],
    )
    rows, gram = tables.rows[i], tables.gram[i]
    drop, heat, sensor, face = TIPPED, TIPPED + fingertips, TIPPED + 2 * fingertips, TIPPED + 3 * fingertips
    real = TIPPED + 4 * fingertips
    imag, ports = real + len(gram), real + 2 * len(gram)
    system = StepArrays(
        tables.dt,
        rows[RATES],
        rows[ports:],
        rows[real:imag],
        rows[imag:ports],
        gram,
        object_states,
        sensor_states,
        p,
        fingertips,
        rows[AIR_LOSS],
        around,
    )
    weight, drive, flow = room.weight, room.drive, room.flow
    for f in range(fingertips):  # written out: filling a slice takes a tenth of a second more to compile
        for j in range(f * p, (f + 1) * p):
            drive[j] = 0.0
            weight[j] = conductance[f]
        drive[f * p] = difference[f]
        for j in range(f * p + 1, f * p + 1 + tables.sizes[i, 5]):
            weight[j] = beside[f]
            drive[f * p + 1] = difference[f]
    reading.air_loss[b, k] = advance(system, x, weight, drive, flow, room)
    for f in range(fingertips):
        reading.drop[b, k, f] = _dot(rows[drop + f], x, n)
        reading.element_heat[b, k, f] = _dot(rows[heat + f], x, n)
        reading.sensor_rise[b, k, f] = _dot(rows[sensor + f], x, n)
        reading.object_rise[b, k, f] = _dot(rows[face + f], x, n)
        reading.flow[b, k, f] = flow[f * p]
        if tables.sizes[i, 5] > 0:
            reading.flow[b, k, f] += flow[f * p + 1]
    reading.object_heat[b, k] = _dot(rows[OBJECT_HEAT], x, n)


@njit(cache=True, inline="always")
def _fingertips(rows, pairs, ports):
    """How many there are in tables of so many rows."""
    return (rows - TIPPED - 2 * pairs - ports) // 4


@njit(cache=True, inner=True)
def fingertips_of(tables):
    """HeatTables.fingertips for compiled callers."""
    return _fingertips(tables.rows.shape[1], tables.gram.shape[1], tables.gram.shape[3])


@njit(cache=True, error_model="numpy")
def forget_row(tables, i, x):
    """forget_field of one row for compiled callers: network i, state x (K,) in place."""
    place = tables.sizes[i, 4]
    mean = x[place]
    for j in range(tables.sizes[i, 1]):
        x[j] = 0.0
    x[place] = mean


@njit(cache=True, fastmath=FAST, inline="always")
def _dot(row, state, count):
    total = 0.0
    for j in range(count):
        total += row[j] * state[j]
    return total
