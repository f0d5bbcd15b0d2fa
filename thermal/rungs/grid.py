"""A press on a grid: its bodies, its march in time and what is read from it.

Time: SDIRK2, the two-stage diagonally implicit Runge-Kutta method with gamma = 1 - 1/sqrt(2) (Alexander 1977, SIAM J.
Numer. Anal. 14, 1006): second order, L-stable. The update is summed from fluxes, so heat is balanced to round-off.
Steps are halves of halves of the time asked for, short after the touch and after a jump of the conductance.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from thermograsp.errors import InvalidValueError

from ..numerics import (
    BOTTOM,
    OBJECT,
    SENSOR,
    TOP,
    Axis,
    Body,
    Grid,
    Interface,
    Stage,
    graded_cells,
    rates,
)
from .problem import PressCurves, PressProblem

GAMMA = 1 - 1 / np.sqrt(2)
FIRST_CELL = 10e-6
"""m, length of the cells next to the contact and its edge, where the flux is nearly singular."""
GROWTH = 0.35
"""Length of a cell per distance from there."""
STEP_PER_TIME = 0.1
"""Length of a step over the time since the touch or the last jump of the conductance."""
_SMALL_JUMP = 0.1  # change of h / (h + h of the sensor) within a step that is not yet a jump
_SHORTEST_STEP = 1e-4  # s
_STAGES_KEPT = 24
_STAGES_BYTES = 1e9  # of the stages kept; two at the least, and on the finest grids one is as large


@dataclass
class Balance:
    """J since the start. contact: through the opening contact. thermostat: into the sensor. air: into the object."""

    contact: float = 0.0
    thermostat: float = 0.0
    air: float = 0.0

    def add(self, seconds: float, watts: tuple[float, float, float]) -> None:
        """Add watts (contact, thermostat, air) for that time."""
        self.contact += seconds * watts[0]
        self.thermostat += seconds * watts[1]
        self.air += seconds * watts[2]


@dataclass
class March:
    """A grid on its way through time. conductance: W/(m2 K) at a time in s. state: temperatures of the two bodies.
    slope: their rates K/s at the end of the last step. balance: heat exchanged so far."""

    grid: Grid
    conductance: Callable[[float], float]
    time: float = 0.0
    state: list[np.ndarray] = field(init=False)
    slope: list[np.ndarray] = field(init=False)
    balance: Balance = field(default_factory=Balance)
    _stages: dict[float, Stage] = field(default_factory=dict)
    _most_stages: int = field(init=False)

    def __post_init__(self) -> None:
        pairs = list(zip(self.grid.bodies, self.grid.first, strict=True))
        self.state = [np.full(body.capacity.shape, value) for body, value in pairs]
        self.slope = [np.zeros(body.capacity.shape) for body, _ in pairs]
        cells = sum(interface.cells[0] * interface.cells[1] for interface in self.grid.interfaces)
        # of a stage: the responses and their factors, and the air's where it is shielded
        matrices = 8.0 * cells**2 * (2 + bool(self.grid.bodies[OBJECT].top))
        self._most_stages = int(np.clip(_STAGES_BYTES / matrices, 2, _STAGES_KEPT))

    def advance(self, step: float) -> None:
        """One SDIRK2 step of that length (s)."""
        step = float(f"{step:.10e}")
        if step not in self._stages:
            if len(self._stages) >= self._most_stages:
                del self._stages[next(iter(self._stages))]
            self._stages[step] = Stage(self.grid, step * GAMMA)
        stage = self._stages[step]
        capacities = [body.capacity for body in self.grid.bodies]
        heat = [c * u for c, u in zip(capacities, self.state, strict=True)]
        flows = []
        for weight, node in ((1 - GAMMA, GAMMA), (GAMMA, 1.0)):
            h = self.conductance(self.time + node * step)
            flows, watts = rates(self.grid, stage.solve(heat, h), h)
            for total, flow in zip(heat, flows, strict=True):
                total += weight * step * flow
            self.balance.add(weight * step, watts)
        self.state = [total / c for total, c in zip(heat, capacities, strict=True)]
        self.slope = [flow / c for flow, c in zip(flows, capacities, strict=True)]
        self.time += step


def finest(half_width: float) -> float:
    """m, length of the cells next to the edge of a contact of that half width or radius."""
    return min(FIRST_CELL, 2e-3 * half_width)


def contact_edges(
    problem: PressProblem, contact: float, sensor: float, reach: float, resolution: int
) -> np.ndarray:
    """Cell boundaries m from the middle of the face out to reach, along one axis of the sensor or of the object.

    contact, sensor: m, half widths or radii. Both bodies get the same boundaries as far as they touch. In O mode the
    flux is singular at the edge of the bond; at the contact's the ceramic spreads it, so its cells may be longer.
    """
    edge = finest(contact)
    fine = {contact: edge} if problem.mode == "T" else {contact: 0.05 * contact, sensor: edge}
    breaks = sorted({0.0, contact, sensor, max(reach, sensor)})
    return graded_cells(breaks, fine, GROWTH, np.inf, resolution)


def press_grid(
    problem: PressProblem,
    axes: tuple[tuple[Axis, Axis], tuple[Axis, Axis]],
    cells: tuple[int, int],
    finest_cell: float,
    resolution: int,
) -> Grid:
    """The grid of a press from the lateral axes of the sensor and of the object. cells: of the contact."""
    stack, material, size = problem.stack, problem.material, problem.object_size
    bounds = np.concatenate(([0.0], np.cumsum([layer.thickness for layer in stack.layers])))
    opening = [bounds[-1]] if problem.mode == "T" else [0.0, bounds[-1]]
    depth = graded_cells(
        list(bounds), dict.fromkeys(opening, finest_cell), GROWTH, bounds[-1] / 24, resolution
    )
    layer_of = np.searchsorted(bounds, (depth[1:] + depth[:-1]) / 2) - 1
    sensor = Body(
        *axes[SENSOR],
        edges=depth,
        conductivity=np.array([layer.conductivity for layer in stack.layers])[layer_of],
        heat_capacity=np.array([layer.volumetric_heat_capacity for layer in stack.layers])[layer_of],
        top=np.inf if problem.mode == "T" else 0.0,
    )
    touched = cells if problem.mode == "T" else sensor.area.shape
    depth = graded_cells([0.0, size[2]], {0.0: finest_cell}, GROWTH, size[2] / 6, resolution)
    body = Body(
        *axes[OBJECT],
        edges=depth,
        conductivity=np.full(len(depth) - 1, material.conductivity),
        heat_capacity=np.full(len(depth) - 1, material.volumetric_heat_capacity),
        top=problem.air,
        bottom=problem.air,
        shielded=touched,
    )
    thermostat = problem.temperature_difference
    sensed = np.flatnonzero(layer_of == stack.sensed)
    if problem.mode == "T":
        interfaces: tuple[Interface, ...] = (Interface(SENSOR, OBJECT, cells, bonded=False),)
    else:
        interfaces = (
            Interface(None, SENSOR, cells, bonded=False),
            Interface(SENSOR, OBJECT, touched, bonded=True),
        )
    first = (thermostat if problem.mode == "T" else 0.0, 0.0)
    return Grid((sensor, body), interfaces, thermostat, first, (int(sensed[0]), int(sensed[-1]) + 1))


def march(
    problem: PressProblem, grid: Grid, t: np.ndarray, step_per_time: float = STEP_PER_TIME
) -> PressCurves:
    """Curves of a press at the times t (n,) s, increasing from 0 or later; the touch is at 0.

    A conductance that is a function of time is seen at the times t and halfway between them, and where it jumps the
    jump is cornered; what happens unseen in between is lost, so give t as fine as the function needs.
    """
    t = np.asarray(t, dtype=float)
    if t.ndim != 1 or not len(t) or not np.all(np.isfinite(t)) or t[0] < 0 or np.any(np.diff(t) <= 0):
        raise InvalidValueError(f"times must be one row, increasing from 0 s or later, got {t!r}")
    given = problem.conductance

    def conductance(time: float) -> float:
        return given(time) if callable(given) else given

    marching = March(grid, conductance)
    knots = [0.0]
    values = [_first_reading(grid, conductance(0.0))]
    slopes = [np.zeros(6)]
    reach = 1 / sum(layer.thickness / layer.conductivity for layer in problem.stack.layers)
    for knot in _knots(t, conductance, reach, callable(given), step_per_time):
        marching.advance(knot - knots[-1])
        marching.time = knot
        h = conductance(knot)
        knots.append(knot)
        values.append(_reading(grid, marching.state, grid.thermostat, h))
        slopes.append(_reading(grid, marching.slope, 0.0, h))
    if len(knots) == 1:
        drop, flow, sensor, body, *stored = np.array(values).T
    else:
        from scipy.interpolate import CubicHermiteSpline  # slow to import, and environments do without it

        drop, flow, sensor, body, *stored = CubicHermiteSpline(knots, np.array(values), np.array(slopes))(t).T
    gained = np.stack(stored, axis=1)
    gained[:, SENSOR] -= grid.first[SENSOR] * grid.bodies[SENSOR].capacity.sum()
    if len(knots) == 1:
        gained[:] = 0.0
    cold = problem.object_temperature
    return PressCurves(drop, flow, sensor + cold, body + cold, gained)


def _knots(
    t: np.ndarray, conductance: Callable[[float], float], reach: float, changes: bool, step_per_time: float
) -> Iterator[float]:
    """Ends of the steps: halves of halves of the whole time, or of that between samples if the conductance changes."""
    positive = t[t > 0]
    if not len(positive):
        return
    ends = [0.0, *(positive if changes else positive[-1:])]
    shortest = min(_SHORTEST_STEP, positive[0] * step_per_time / 4)
    touch = 0.0

    def share(time: float) -> float:
        h = conductance(time)
        return h / (h + reach)

    for start, stop in zip(ends[:-1], ends[1:], strict=True):
        waiting = [(start, stop)]
        while waiting:
            a, b = waiting.pop()
            middle = (a + b) / 2
            jumps = changes and np.ptp([share(a), share(middle), share(b)]) > _SMALL_JUMP
            too_long = b - a > max(shortest, step_per_time * (a - touch))
            if (jumps or too_long) and b - a > shortest:
                waiting += [(middle, b), (a, middle)]
                continue
            if jumps:
                touch = b
            yield b


def _first_reading(grid: Grid, conductance: float) -> np.ndarray:
    """At the touch the half cells hold no gradient yet: the contact alone limits the flow."""
    sensor, body = grid.first
    area = grid.contact_area(grid.interfaces[0]).sum()
    in_contact = (sensor, body) if grid.interfaces[0].above == SENSOR else (grid.thermostat, sensor)
    held = [first * b.capacity.sum() for first, b in zip(grid.first, grid.bodies, strict=True)]
    return np.array([0.0, conductance * area * grid.thermostat, *in_contact, *held])


def _reading(grid: Grid, state: list[np.ndarray], thermostat: float, conductance: float) -> np.ndarray:
    """(6,) linear in the temperatures: drop, heat flow, both surfaces of the contact, heat held by both bodies."""
    sensor = grid.bodies[SENSOR]
    rows = [(u[TOP], u[BOTTOM]) for u in state]
    flows = [grid.conductances(i, conductance) * grid.gap(i, rows, thermostat) for i in grid.interfaces]
    contact = grid.interfaces[0]
    area = grid.contact_area(contact)
    i, j = contact.cells
    below = grid.bodies[contact.below]
    lower = np.sum(area * rows[contact.below][0][:i, :j] + flows[0] * below.half_resistance[TOP]) / area.sum()
    if contact.above is None:
        upper = thermostat
    else:
        half = sensor.half_resistance[BOTTOM]
        upper = np.sum(area * rows[contact.above][1][:i, :j] - flows[0] * half) / area.sum()

    def face(n: int) -> float:
        """Mean temperature of the sensor between cells n - 1 and n."""
        if n == 0 and contact.above is not None:
            return thermostat
        half = sensor.half_resistance
        means = [
            np.sum(sensor.area * state[SENSOR][m]) / sensor.area.sum()
            for m in (n - 1, n)
            if 0 <= m < len(half)
        ]
        if n == 0:
            return means[0] + flows[0].sum() / sensor.area.sum() * half[TOP]
        if n == len(half):
            return means[0] - flows[-1].sum() / sensor.area.sum() * half[BOTTOM]
        return (means[0] * half[n] + means[1] * half[n - 1]) / (half[n - 1] + half[n])

    drop = face(grid.sensed[0]) - face(grid.sensed[1])
    held = [np.sum(body.capacity * u) for body, u in zip(grid.bodies, state, strict=True)]
    return np.array([drop, flows[0].sum(), upper, lower, *held])
