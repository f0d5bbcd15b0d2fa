"""Rung "lumped": the sensor as a chain of thermal resistances, the object as one temperature.

Neglects: the sensor's heat capacity and all conduction in the object, heat spreading in it included. Right late, for
small objects of good conductors (Biot number below 0.1); wrong before the sensor's own settling, R C = 7 s for the
seed's. It alone of the lower rungs follows a conductance that is a function of time, and the air.
"""

from __future__ import annotations

import numpy as np

from thermograsp.errors import InvalidValueError

from .layered import sample_times
from .problem import PressCurves, PressProblem

_SUBSTEPS = 8


def biot(problem: PressProblem) -> float:
    """Largest exchange conductance, contact and sensor in series, over the object's conduction across its thickness.

    -: the object is nearly uniform below 0.1 (Incropera & DeWitt, Fundamentals of Heat and Mass Transfer, section 5.1).
    The contact counts as perfect when it is a function of time.
    """
    resistance = _sensor_resistance(problem)
    if not callable(problem.conductance):
        resistance += 1 / (problem.conductance * problem.area) if problem.conductance else np.inf
    area = problem.area if problem.mode == "T" else problem.stack.face_area
    exchange = 1 / resistance + problem.air * _free_area(problem)
    return float(exchange * problem.object_size[2] / (problem.material.conductivity * area))


def solve(problem: PressProblem, t: np.ndarray) -> PressCurves:
    """Curves at t (n,) s, >= 0, increasing: C dT/dt = G(t) (T_S - T) - air (free area) (T - T_M).

    Exact for a constant conductance, second order in an eighth of the samples' spacing for one that varies.
    object_surface is the object's temperature plus, in O mode, the element's rise above it. The element's stored heat
    is NaN.
    Raises InvalidValueError for sample times that are negative, not finite or falling, and
    for a conductance below 0.
    """
    t = sample_times(t)
    if (np.diff(t) < 0).any():
        raise InvalidValueError("the sample times must increase: rung 'lumped' marches through them")
    width, depth, thickness = problem.object_size
    capacity = problem.material.density * problem.material.specific_heat * width * depth * thickness
    loss = problem.air * _free_area(problem)
    rise = np.empty(len(t))
    now, u = 0.0, 0.0
    for i, end in enumerate(t):
        step = (end - now) / _SUBSTEPS
        for k in range(_SUBSTEPS if step else 0):
            gain = _conductance(problem, now + (k + 0.5) * step)
            u = _relax(u, gain, loss, capacity, problem.temperature_difference, step)
        now, rise[i] = end, u
    jump = problem.temperature_difference
    gains = np.array([_conductance(problem, time) for time in t])
    flow = gains * (jump - rise)
    resistance = _sensor_resistance(problem)
    sensed = problem.stack.layers[problem.stack.sensed]
    fall = flow * resistance
    return PressCurves(
        temperature_drop=flow * sensed.thickness / (sensed.conductivity * problem.stack.face_area),
        heat_flow=flow,
        sensor_surface=problem.sensor_temperature - (fall if problem.mode == "T" else np.zeros_like(fall)),
        object_surface=problem.object_temperature + rise + (fall if problem.mode == "O" else 0.0),
        stored_heat=np.stack([np.full(len(t), np.nan), capacity * rise], axis=1),
    )


def _relax(u: float, gain: float, loss: float, capacity: float, jump: float, step: float) -> float:
    total = gain + loss
    if total == 0:
        return u
    final = gain / total * jump
    return u + (final - u) * -float(np.expm1(-total / capacity * step))


def _conductance(problem: PressProblem, time: float) -> float:
    """W/K from thermostat to object at that time."""
    h = problem.conductance
    if callable(h):
        h = h(time)
    return 1 / (_sensor_resistance(problem) + 1 / (h * problem.area)) if h > 0 else 0.0


def _sensor_resistance(problem: PressProblem) -> float:
    stack = problem.stack
    return sum(layer.thickness / layer.conductivity for layer in stack.layers) / stack.face_area


def _free_area(problem: PressProblem) -> float:
    """m2 of the object's surface that the sensor does not cover."""
    width, depth, thickness = problem.object_size
    covered = problem.area if problem.mode == "T" else problem.stack.face_area
    return 2 * (width * depth + (width + depth) * thickness) - covered
