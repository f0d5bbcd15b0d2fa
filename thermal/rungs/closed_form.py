"""Rung "closed_form": one homogeneous layer between an ideal thermostat and a semi-infinite object, perfect contact.

With gamma = (b_S - b_M)/(b_S + b_M) from the effusivities of layer and object, L the layer's thickness, alpha its
diffusivity and F = alpha t / L^2, the drop over the layer per kelvin of first difference is

    T mode: (1 - gamma)/2 sum_n (-gamma)^n (erfc(n/sqrt F) - erfc((n+1)/sqrt F))
            = (1 - gamma)/2 (1 - (1 + gamma) S(1))
    O mode: 1 - (1 + gamma) S(1/2),        S(a) = sum_n (-gamma)^n erfc((n + a)/sqrt F),   n = 0, 1, 2, ...

The T form is eq. (2) of Wu et al. 2012; their printed eq. (1) for the O mode is no solution (tests show it).
"""

from __future__ import annotations

import numpy as np
from scipy.special import erfc

from thermograsp.errors import InvalidValueError

from ..matter import Layer, SensorStack
from ..numerics import invert
from .layered import (
    Column,
    constant_conductance,
    half_space,
    no_air,
    press_curves,
)
from .problem import PressCurves, PressProblem

_SERIES_UP_TO = (
    2.0  # Fourier number below which 9 terms of the series are exact to erfc(9.5 / sqrt 2) = 2e-21
)


def drop_t_mode(fourier: np.ndarray | float, gamma: float) -> np.ndarray:
    """Drop over the layer per kelvin, T mode, at the Fourier numbers alpha t / L^2 (any shape, >= 0).

    gamma: in [-1, 1]. At 0 it is the jump (1 - gamma)/2 of a perfect contact. Error below 1e-12.
    Raises InvalidValueError outside these ranges.
    """
    return (1 - _checked(gamma)) / 2 * (1 - (1 + gamma) * _reflections(fourier, gamma, 1.0))


def drop_o_mode(fourier: np.ndarray | float, gamma: float) -> np.ndarray:
    """Drop over the layer per kelvin, O mode, at the Fourier numbers alpha t / L^2 (any shape, >= 0).

    gamma: in [-1, 1]. At 0 it is 1, the thermostat's jump. Error below 1e-12.
    Raises InvalidValueError outside these ranges.
    """
    return 1 - (1 + _checked(gamma)) * _reflections(fourier, gamma, 0.5)


def _checked(gamma: float) -> float:
    if not -1 <= gamma <= 1:
        raise InvalidValueError(f"gamma must lie in [-1, 1], got {gamma!r}")
    return gamma


def _reflections(fourier: np.ndarray | float, gamma: float, start: float) -> np.ndarray:
    """S(start): the series while it is short, else the inversion of its Laplace transform, whose poles near the
    negative axis for |gamma| -> 1 the contour goes around."""
    fourier = np.asarray(fourier, dtype=float)
    if not (fourier >= 0).all():
        raise InvalidValueError("the Fourier number alpha t / L^2 must be >= 0")
    result = np.zeros(fourier.shape)
    early = (fourier > 0) & (fourier <= _SERIES_UP_TO)
    n = np.arange(9)
    result[early] = np.sum((-gamma) ** n * erfc((n + start) / np.sqrt(fourier[early])[:, None]), axis=-1)
    late = fourier > _SERIES_UP_TO

    def transform(s: np.ndarray) -> np.ndarray:
        root = 2 * np.sqrt(s)
        return np.exp(-start * root) / (s * ((1 + gamma) + gamma * np.expm1(-root)))

    if late.any():
        result[late] = invert(transform, fourier[late])
    return result


def equivalent_slab(stack: SensorStack) -> Layer:
    """The homogeneous layer of the stack's thickness, thermal resistance and heat capacity per area."""
    thickness = stack.thickness
    resistance = sum(layer.thickness / layer.conductivity for layer in stack.layers)
    capacity = stack.heat_capacity / stack.face_area / thickness  # J/(m3 K)
    return Layer(stack.name, thickness, thickness / resistance, capacity, 1.0)


def sensed_share(stack: SensorStack) -> float:
    """Share of the stack's thermal resistance that its sensed layer has."""
    resistances = [layer.thickness / layer.conductivity for layer in stack.layers]
    return resistances[stack.sensed] / sum(resistances)


def solve(problem: PressProblem, t: np.ndarray) -> PressCurves:
    """Curves at t (n,) s, >= 0. At t = 0 the contact has just closed, and the heat flow is infinite.

    The layered element is replaced by its equivalent_slab, and the sensed layer's drop is its share of the
    resistance times the slab's: exact for one layer, and late, when the flux is the same in all layers.
    Neglects: the contact's resistance (the conductance is not used), what sets the layers apart, the object's
    thickness, and heat spreading sideways in it.
    Raises InvalidValueError when the conductance is 0 or a function of time, or air is not 0.
    """
    if constant_conductance(problem, "closed_form") == 0:
        raise InvalidValueError(
            "rung 'closed_form' takes the contact as perfect; conductance 0 means apart: use another"
        )
    no_air(problem, "closed_form")
    slab, effusivity = equivalent_slab(problem.stack), problem.material.effusivity
    object_area = problem.area if problem.mode == "T" else problem.stack.face_area
    ratio = effusivity * object_area / (slab.effusivity * problem.stack.face_area)
    gamma = float((1 - ratio) / (1 + ratio))
    column = Column(
        problem.mode, (slab,), 0, problem.stack.face_area, 0.0, half_space(effusivity), object_area
    )
    if problem.mode == "T":
        fall = (1 - gamma) / 2
        first = (fall, np.inf, fall, 1 - fall, 0.0, 0.0)
    else:
        first = (1.0, np.inf, 0.0, 1.0, 0.0, 0.0)
    curves = press_curves(problem, t, column, first)
    fourier = slab.diffusivity * np.atleast_1d(t) / slab.thickness**2
    drop = (drop_t_mode if problem.mode == "T" else drop_o_mode)(fourier, gamma)
    return PressCurves(
        temperature_drop=sensed_share(problem.stack) * problem.temperature_difference * drop,
        heat_flow=curves.heat_flow,
        sensor_surface=curves.sensor_surface,
        object_surface=curves.object_surface,
        stored_heat=curves.stored_heat,
    )
