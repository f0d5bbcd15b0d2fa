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
    propagator,
    step_arrays,
    with_air,
    workspace,
)
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
    weights = np.zeros((len(middles), fingertips))
    for tip, conductance in enumerate(pressed):
        weights[:, tip] = _values(conductance, middles) * problem.area
    states = np.zeros((len(t), len(system.rates)))
    offset, reading = np.zeros(len(t)), None
    if ideal:
        _march(arrays, weights, problem.temperature_difference, steps, states)
    else:
        offset, reading = _march_with_backs(problem, system, arrays, weights, steps, states)
    now = _values(problem.conductance, t) * problem.area
    flows = now * (problem.temperature_difference + offset - states @ system.ports[:, 0])
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
def _march(arrays, conductance, difference, steps, states):
    """States (n, K) at the samples; conductance (W/K) of every step and fingertip, `steps` of them between samples."""
    ports, modes = arrays.ports.shape[0], arrays.modes
    weight, drive, flow = np.zeros(ports), np.zeros(ports), np.zeros(ports)
    for f in range(arrays.contacts):
        drive[f * modes] = difference
    room = workspace(arrays.rates.shape[0], ports)
    state = states[0].copy()
    for i in range(1, states.shape[0]):
        for k in range(steps):
            for f in range(arrays.contacts):
                weight[f * modes : (f + 1) * modes] = conductance[(i - 1) * steps + k, f]
            advance(arrays, state, weight, drive, flow, room)
        states[i] = state


def _values(conductance: Conductance, times: np.ndarray) -> np.ndarray:
    if not callable(conductance):
        return np.full(len(times), float(conductance))
    values = np.array([float(conductance(float(time))) for time in times])
    wrong = ~(np.isfinite(values) & (values >= 0))
    if wrong.any():
        first = int(np.argmax(wrong))
        raise InvalidValueError(
            f"conductance({times[first]:g} s) is {float(values[first])!r}: "
            "it must be finite and >= 0 W/(m2 K), 0 where apart"
        )
    return values
