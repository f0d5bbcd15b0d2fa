"""Rung "network": one press on a thermal network of few states."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

import numpy as np

from thermograsp.compiled import njit
from thermograsp.errors import InvalidValueError

from ..network import (
    ContactSystem,
    StepArrays,
    advance,
    even_ports,
    propagator,
    step_arrays,
    with_air,
    workspace,
)
from ..padded import RING_PORTS
from ..plates import Geometry
from ..readout import ThermostatState, settled_thermostat, thermostat_at, thermostat_step
from ..stack import CoreState, heated_core
from .problem import Conductance, PressCurves, PressProblem

LONGEST_STEP = 0.01  # s, over which a conductance that varies is held at its value in the middle


def geometry_of(problem: PressProblem, fingertips: Literal[1, 2] | None = None) -> Geometry:
    """What of the problem a network depends on. fingertips: None for as many as press."""
    pressing = 1 if problem.opposite is None else 2
    return Geometry(
        problem.stack,
        problem.material,
        problem.mode,
        problem.area,
        problem.shape,
        problem.object_size,
        fingertips or pressing,
        surround=problem.surround,
    )


def solve(problem: PressProblem, t: np.ndarray, system: ContactSystem) -> PressCurves:
    """Curves at the samples t = 0, dt, 2 dt, ... (n,) s. A constant conductance is stepped exactly from sample to
    sample, one that varies in equal steps of at most LONGEST_STEP. A second fingertip of the system stays apart unless
    the problem presses it.

    Raises InvalidValueError when a conductance function returns a negative or non-finite value, with the time, and when
    the system has one fingertip and the problem two.
    """
    fingertips = system.geometry.fingertips
    pressed = [problem.conductance] if problem.opposite is None else [problem.conductance, problem.opposite]
    if len(pressed) > fingertips:
        raise InvalidValueError(
            f"network {system.orders} has one fingertip, the problem two: give modes/sensor/even/odd"
        )
    system, _ = with_air(system, problem.air)
    spacing = t[1] - t[0] if len(t) > 1 else 1.0
    ideal = problem.thermostat is None and problem.heated is None
    held = ideal and not any(map(callable, pressed))
    steps = 1 if held else max(1, int(np.ceil(spacing / LONGEST_STEP - 1e-9)))
    dt = spacing / steps
    arrays = step_arrays(
        propagator(system.rates, system.ports, dt),
        modes=system.modes,
        sensor_states=system.orders.sensor,
    )
    middles = (np.arange(steps * (len(t) - 1)) + 0.5) * dt
    # of the faces, then of the pads around them
    weights, modes = np.zeros((len(middles), 2 * fingertips)), system.modes
    for tip, conductance in enumerate(pressed):
        weights[:, [tip, fingertips + tip]] = _of_contact(problem, _values(conductance, middles))
    columns, even = np.repeat(np.arange(fingertips), modes), even_ports(system.geometry, modes)
    if problem.surround is not None:
        for tip in range(fingertips):
            columns[tip * modes :][:modes][RING_PORTS] += fingertips
    states = np.zeros((len(t), len(system.rates)))
    offset, reading = np.zeros(len(t)), None
    if ideal:
        drive = np.tile(problem.temperature_difference * even, fingertips)
        _march(arrays, weights, columns, drive, steps, states)
    else:
        faces = np.ascontiguousarray(weights[:, :fingertips])
        offset, reading = _march_with_backs(problem, system, arrays, faces, steps, states)
    now = _of_contact(problem, _values(problem.conductance, t))
    flows = now[:, 0] * (problem.temperature_difference + offset - states @ system.ports[:, 0])
    if problem.surround is not None and modes > RING_PORTS.start:
        flows += now[:, 1] * (problem.temperature_difference - states @ system.ports[:, RING_PORTS.start])
    element = states @ system.element_heat[0]
    if problem.mode == "T":  # the states hold temperatures above the thermostat's
        element = element + system.geometry.element_capacity * offset
    return PressCurves(
        temperature_drop=states @ system.drop[0],
        heat_flow=flows,
        sensor_surface=problem.sensor_temperature + offset + states @ system.sensor_surface[0],
        object_surface=problem.object_temperature + states @ system.object_surface[0],
        stored_heat=np.stack((element, states @ system.object_heat), axis=1),
        reading=reading if problem.heated else None,
    )


def _of_contact(problem: PressProblem, conductance: np.ndarray) -> np.ndarray:
    """(n, 2) W/K of a fingertip's face and of the pad around it, from the face's (n,) W/(m2 K)."""
    if problem.surround is None:
        return np.stack((conductance * problem.area, np.zeros(len(conductance))), axis=1)
    face = problem.stack.face_area
    beside = conductance if problem.beside is None else problem.beside * (conductance > 0)
    return np.stack((conductance * face, beside * max(problem.area - face, 0.0)), axis=1)


def _march_with_backs(
    problem: PressProblem,
    system: ContactSystem,
    arrays: StepArrays,
    conductance: np.ndarray,
    steps: int,
    states: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Fills states (n, K) as _march does, each fingertip on a thermostat or a core that follows its heater step by
    step. Returns the first one's temperature (n,) K above sensor_temperature, and its reading (n,) °C."""
    fingertips, modes = system.geometry.fingertips, system.modes
    back, following = _back(problem, fingertips, arrays.dt)
    start = back.temperature
    rows = system.element_heat if problem.mode == "T" else np.zeros_like(system.element_heat)
    capacity = system.geometry.element_capacity if problem.mode == "T" else 0.0
    state, room = states[0].copy(), workspace(len(arrays.rates), len(arrays.ports))
    flow, drive = np.zeros(len(arrays.ports)), np.zeros(len(arrays.ports))
    stored = np.zeros(fingertips)
    offset, reading = np.zeros((len(states), fingertips)), np.full((len(states), fingertips), start)
    for step, weights in enumerate(conductance):
        above = back.temperature - start
        drive[::modes] = problem.temperature_difference + above
        advance(arrays, state, np.repeat(weights, modes), drive, flow, room)
        now = rows @ state + capacity * above
        drawn = flow[::modes] + (now - stored) / arrays.dt
        back = following(back, drawn, system.drop @ state, step * arrays.dt)
        stored = now
        # A uniform shift of the back is, seen from it, minus that shift of the elements.
        state -= (back.temperature - start - above) @ rows
        if (step + 1) % steps == 0:
            states[(step + 1) // steps] = state
            offset[(step + 1) // steps] = back.temperature - start
            if isinstance(back, CoreState):
                reading[(step + 1) // steps] = back.reading
    return offset[:, 0], reading[:, 0]


_Back = ThermostatState | CoreState
_Following = Callable[[Any, np.ndarray, np.ndarray, float], _Back]


def _back(problem: PressProblem, fingertips: int, dt: float) -> tuple[_Back, _Following]:
    """What the elements sit on, settled, and how it goes on from (state, W drawn, K of drop, s)."""
    if problem.heated is not None:
        core = heated_core(problem.heated, dt)
        room, force = problem.object_temperature, problem.force
        first = core.settled(np.full(fingertips, problem.sensor_temperature), room)

        def core_after(state: CoreState, drawn: np.ndarray, drop: np.ndarray, time: float) -> CoreState:
            newton = float(force(time)) if callable(force) else float(force)
            return core.step(state, drawn, drop, np.full(fingertips, newton), room)

        return first, core_after
    assert problem.thermostat is not None
    stack = problem.stack if problem.mode == "T" else None
    thermostat = thermostat_at(problem.sensor_temperature, problem.thermostat, stack, dt)

    def plate_after(
        state: ThermostatState, drawn: np.ndarray, drop: np.ndarray, time: float
    ) -> ThermostatState:
        del drop, time
        return thermostat_step(thermostat, state, drawn, dt)

    return settled_thermostat(thermostat, fingertips), plate_after


@njit(cache=True, error_model="numpy")
def _march(arrays, conductance, columns, drive, steps, states):
    """States (n, K) at the samples; conductance (W/K) of every step and contact, `steps` of them between samples.
    columns (M,): the contact of each port. drive (M,): K."""
    ports = arrays.ports.shape[0]
    weight, flow = np.zeros(ports), np.zeros(ports)
    room = workspace(arrays.rates.shape[0], ports)
    state = states[0].copy()
    for i in range(1, states.shape[0]):
        for k in range(steps):
            for p in range(ports):
                weight[p] = conductance[(i - 1) * steps + k, columns[p]]
            advance(arrays, state, weight, drive, flow, room)
        states[i] = state


def _values(conductance: Conductance, times: np.ndarray) -> np.ndarray:
    if not callable(conductance):
        return np.full(len(times), float(conductance))
    return np.array([conductance(time) for time in times.tolist()])
