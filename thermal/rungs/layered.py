"""Rung "layered": the layered sensor, the contact and an object of finite thickness, in one dimension, exact in time.

Neglects: heat spreading sideways in the object, whose column is as wide as the patch (the contact's area in T mode, the
bonded face in O mode) and adiabatic at its back and sides. So metals and thick plates cool it too little after the heat
front has passed the patch's width. Any constant conductance, 0 included.

Thermostat, element, contact and object stand in a row in the Laplace domain (`Column`, which `closed_form` shares).
Layers are solved exactly (Carslaw & Jaeger, Conduction of Heat in Solids, 2nd ed., section 3.7: plates/impedance.py).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from thermograsp.errors import InvalidValueError

from ..matter import Layer
from ..numerics import invert
from ..plates import stack_profile
from .problem import PressCurves, PressProblem

Impedance = Callable[[np.ndarray], np.ndarray]


def solve(problem: PressProblem, t: np.ndarray) -> PressCurves:
    """Curves at t (n,) s, >= 0, to about 1e-12 of the first difference (inverted Laplace transforms).

    Raises InvalidValueError when the conductance is a function of time or air is not 0.
    """
    conductance = constant_conductance(problem, "layered")
    no_air(problem, "layered")
    if conductance == 0:
        return untouched(problem, t)
    material, stack = problem.material, problem.stack
    body = material.layer(problem.object_size[2])
    column = Column(
        mode=problem.mode,
        layers=stack.layers,
        sensed=stack.sensed,
        face_area=stack.face_area,
        contact_resistance=1 / (conductance * problem.area),
        object_impedance=layer_on_insulation(body),
        object_area=problem.area if problem.mode == "T" else stack.face_area,
    )
    return press_curves(problem, t, column, first=(0.0, conductance * problem.area, 0.0, 0.0, 0.0, 0.0))


def half_space(effusivity: float) -> Impedance:
    """Surface impedance m2 K/W of a semi-infinite body of that effusivity, W s^0.5/(m2 K)."""
    return lambda s: 1 / (effusivity * np.sqrt(s))


def layer_on_insulation(layer: Layer) -> Impedance:
    """Surface impedance m2 K/W of one layer whose far side is adiabatic."""

    def impedance(s: np.ndarray) -> np.ndarray:
        root = np.sqrt(s / layer.diffusivity)
        return 1 / (layer.conductivity * root * np.tanh(root * layer.thickness))

    return impedance


@dataclass(frozen=True, slots=True)
class Column:
    """Thermostat, element, contact and object in one dimension. mode: "T" or "O". layers: the element's, thermostat
    side first. sensed: index of the one whose drop is measured. face_area: m2, the element's cross-section.
    contact_resistance: K/W. object_impedance: at the object's surface, m2 K/W. object_area: m2, the object's column."""

    mode: str
    layers: tuple[Layer, ...]
    sensed: int
    face_area: float
    contact_resistance: float
    object_impedance: Impedance
    object_area: float

    def transform(self, s: np.ndarray) -> np.ndarray:
        """(..., 6) per kelvin of first difference: drop K, heat flow W, fall of the sensor-side surface K, rise of the
        object-side surface K, heat gained by the element J and by the object J."""
        area, column, even = self.face_area, s[..., None], np.zeros(1)
        object_side = self.object_impedance(s) / self.object_area
        if self.mode == "T":  # the element starts with the thermostat: reckon its temperature below that
            layers, far = self.layers[::-1], "isothermal"
            near, beyond = len(layers) - 1 - self.sensed, len(layers) - self.sensed
        else:  # the element starts with the object: reckon its temperature above that
            layers, far = self.layers, (object_side * area)[..., None]
            near, beyond = self.sensed, self.sensed + 1
        profile = stack_profile(layers, far, column, even)
        temperatures, flows = ([each[..., 0] for each in part] for part in profile)
        sensor_side = temperatures[0] / area
        if self.mode == "T":
            flow = 1 / s / (sensor_side + self.contact_resistance + object_side)
            sensor_fall, object_rise = sensor_side * flow, object_side * flow
            element, into_object = (flows[-1] - 1) * flow, flow
        else:
            flow = 1 / s / (sensor_side + self.contact_resistance)
            sensor_fall, object_rise = np.zeros_like(s), sensor_side * flow
            element, into_object = (1 - flows[-1]) * flow, flows[-1] * flow
        drop = (temperatures[near] - temperatures[beyond]) / area * flow
        return np.stack([drop, flow, sensor_fall, object_rise, element / s, into_object / s], axis=-1)


def press_curves(
    problem: PressProblem, t: np.ndarray, column: Column, first: tuple[float, ...]
) -> PressCurves:
    """The column's answer at t (n,) s, >= 0. first: the six quantities of Column.transform at t = 0+, per kelvin."""
    t = sample_times(t)
    values = np.empty((len(t), 6))
    values[:] = first
    later = t > 0
    if later.any():
        values[later] = invert(column.transform, t[later])
    return curves_of(problem, values)


def curves_of(problem: PressProblem, values: np.ndarray) -> PressCurves:
    """Of the six quantities of Column.transform, (n, 6) per kelvin of first difference."""
    values = values * problem.temperature_difference
    return PressCurves(
        temperature_drop=values[:, 0],
        heat_flow=values[:, 1],
        sensor_surface=problem.sensor_temperature - values[:, 2],
        object_surface=problem.object_temperature + values[:, 3],
        stored_heat=values[:, 4:],
    )


def untouched(problem: PressProblem, t: np.ndarray) -> PressCurves:
    """Both bodies as they were: what a conductance of 0 leaves."""
    return curves_of(problem, np.zeros((len(sample_times(t)), 6)))


def sample_times(t: np.ndarray) -> np.ndarray:
    """t as (n,) floats. Raises InvalidValueError when one is negative or not finite."""
    t = np.atleast_1d(np.asarray(t, dtype=float))
    if t.ndim != 1 or not np.isfinite(t).all() or (t < 0).any():
        raise InvalidValueError("the sample times must be one row of finite numbers >= 0 s")
    return t


def constant_conductance(problem: PressProblem, rung: str) -> float:
    """The problem's conductance, W/(m2 K). Raises InvalidValueError when it is a function of time."""
    if callable(problem.conductance):
        raise InvalidValueError(
            f"rung {rung!r} solves one contact of constant conductance in closed form and cannot follow a function of "
            "time: give a number, or use 'lumped' or a network rung"
        )
    return problem.conductance


def no_air(problem: PressProblem, rung: str) -> None:
    """Raises InvalidValueError when the object loses heat to the air, which no one-dimensional rung can tell."""
    if problem.air > 0:
        raise InvalidValueError(
            f"rung {rung!r} is one-dimensional and has no free faces to lose heat from, got air = {problem.air:g} "
            "W/(m2 K): give 0, or use 'lumped' or a network rung"
        )
