"""Rung "network": one press on a thermal network of few states."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
from numba import njit

from thermograsp.errors import InvalidValueError

from .air import with_air
from .bodies import Geometry
from .coupling import propagator
from .coupling_kernel import StepArrays, advance, step_arrays, workspace
from .problem import Conductance, PressCurves, PressProblem
from .system import ContactSystem
from .thermostat import settled_thermostat, thermostat_step

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
    held = problem.thermostat is None and not any(map(callable, pressed))
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
    offset = np.zeros(len(t))
    if problem.thermostat is None:
        _march(arrays, weights, problem.temperature_difference, steps, states)
    else:
        offset = _march_with_thermostats(problem, system, arrays, weights, steps, states)
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
    )


def _march_with_thermostats(
    problem: PressProblem,
    system: ContactSystem,
    arrays: StepArrays,
    conductance: np.ndarray,
    steps: int,
    states: np.ndarray,
) -> np.ndarray:
    """Fills states (n, K) as _march does, each fingertip on a thermostat that follows its controller step by step.
    Returns the first thermostat's temperature (n,) K above sensor_temperature."""
    assert problem.thermostat is not None
    fingertips, modes = system.geometry.fingertips, system.modes
    thermostat = replace(problem.thermostat, setpoint=problem.sensor_temperature)
    plate = settled_thermostat(thermostat, fingertips)
    start = plate.temperature
    rows = system.element_heat if problem.mode == "T" else np.zeros_like(system.element_heat)
    capacity = system.geometry.element_capacity if problem.mode == "T" else 0.0
    state, room = states[0].copy(), workspace(len(arrays.rates), len(arrays.ports))
    flow, drive = np.zeros(len(arrays.ports)), np.zeros(len(arrays.ports))
    stored = np.zeros(fingertips)
    offset = np.zeros((len(states), fingertips))
    for step, weights in enumerate(conductance):
        above = plate.temperature - start
        drive[::modes] = problem.temperature_difference + above
        advance(arrays, state, np.repeat(weights, modes), drive, flow, room)
        now = rows @ state + capacity * above
        plate = thermostat_step(thermostat, plate, flow[::modes] + (now - stored) / arrays.dt, arrays.dt)
        stored = now
        # A uniform shift of the thermostat is, seen from it, minus that shift of the elements.
        state -= (plate.temperature - start - above) @ rows
        if (step + 1) % steps == 0:
            states[(step + 1) // steps] = state
            offset[(step + 1) // steps] = plate.temperature - start
    return offset[:, 0]


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
