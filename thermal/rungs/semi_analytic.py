"""Rung "semi_analytic": the press in three dimensions without a grid, for a constant conductance.

Element and object are layered bodies of constant cross-section with adiabatic sides, so their surface impedances are
sums over lateral eigenfunctions of transmission-line impedances (Carslaw & Jaeger, Conduction of Heat in Solids, 2nd
ed., sections 3.7 and 10.3). The heat flux over the contact is piecewise linear, graded toward the edge where it is
nearly singular; the bodies are coupled at complex s and the transforms inverted numerically. The patterns alone make an
error, .0003 K of 12 K.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from thermograsp.errors import InvalidValueError

from ..numerics import invert_many
from ..plates import Geometry, lateral_sum, stack_impedance, stack_profile
from .layered import constant_conductance, curves_of, sample_times, untouched
from .network import geometry_of
from .problem import PressCurves, PressProblem

Transform = Callable[[np.ndarray], np.ndarray]


def solve(problem: PressProblem, t: np.ndarray) -> PressCurves:
    """Curves at t (n,) s, >= 0, in any order. Takes a second or two for each decade of times, however many they are.

    Raises InvalidValueError when the conductance is a function of time or air is not 0.
    """
    conductance = constant_conductance(problem, "semi_analytic")
    if problem.air > 0:
        raise InvalidValueError(
            f"rung 'semi_analytic' has adiabatic free faces, got air = {problem.air:g} W/(m2 K): give 0, or use "
            "'network' or a grid"
        )
    if conductance == 0:
        return untouched(problem, t)
    t = sample_times(t)
    geometry = geometry_of(problem)
    values = np.zeros((len(t), 6))
    values[:, 1] = conductance * problem.area
    if (t > 0).any():
        transform = (
            _element_first(geometry, conductance) if problem.mode == "T" else _bonded(geometry, conductance)
        )
        values[t > 0] = invert_many(transform, t[t > 0])
    return curves_of(problem, values)


def _element_first(geometry: Geometry, conductance: float) -> Transform:
    """T mode: s (S,) -> (S, 6) per kelvin of first difference: drop K, heat flow W, fall of the sensor's surface K,
    rise of the object's K, heat gained by the element and by the object J."""
    layers, patch = geometry.stack.layers[::-1], geometry.patch
    over_element = lateral_sum(geometry.element_section, patch, patch)
    over_object = lateral_sum(geometry.object_section, patch, patch)
    sensed = len(layers) - 1 - geometry.stack.sensed
    uniform, area = patch.uniform, patch.area
    contact = np.eye(len(uniform)) / conductance

    def transform(s: np.ndarray) -> np.ndarray:
        element = over_element(lambda at, kappa2: stack_impedance(layers, "isothermal", at, kappa2), s)
        plate = over_object(lambda at, kappa2: stack_impedance((geometry.plate,), "adiabatic", at, kappa2), s)
        flux = _solve(element + plate + contact, uniform) / s[:, None]
        flow = area * (flux @ uniform)
        # the mean over the element's cross-section, and all heat, follow the uniform eigenfunction alone
        temperatures, flows = stack_profile(layers, "isothermal", s[:, None], np.zeros(1))
        drop = (temperatures[sensed] - temperatures[sensed + 1])[:, 0] / geometry.element_section.area
        lost = (1 - flows[-1][:, 0]) / s
        return np.stack(
            (
                drop * flow,
                flow,
                np.einsum("c,scd,sd->s", uniform, element, flux),
                np.einsum("c,scd,sd->s", uniform, plate, flux),
                -lost * flow,
                flow / s,
            ),
            axis=1,
        )

    return transform


def _bonded(geometry: Geometry, conductance: float) -> Transform:
    """O mode: as _element_first. The element is bonded to the object over its whole face; the flux there is unknown."""
    layers, section = geometry.stack.layers, geometry.element_section
    top, bond = geometry.patch, geometry.face
    on_top = lateral_sum(section, top, top)
    on_bond = lateral_sum(section, bond, bond)
    across_element = lateral_sum(section, bond, top)
    over_object = lateral_sum(geometry.object_section, bond, bond)
    uniform, area = top.uniform, top.area
    contact = np.eye(len(uniform)) / conductance
    sensed, count = geometry.stack.sensed, len(layers)

    def transform(s: np.ndarray) -> np.ndarray:
        impedance = on_top(lambda at, kappa2: stack_impedance(layers, "adiabatic", at, kappa2), s)
        below = on_bond(lambda at, kappa2: stack_impedance(layers[::-1], "adiabatic", at, kappa2), s)
        below = below + over_object(
            lambda at, kappa2: stack_impedance((geometry.plate,), "adiabatic", at, kappa2), s
        )
        across = across_element(lambda at, kappa2: stack_profile(layers, "adiabatic", at, kappa2)[0][-1], s)
        passed = np.linalg.solve(below, across)  # flux over the bond per flux over the contact
        impedance = impedance - np.einsum("sbc,sbd->scd", across, passed)
        flux = _solve(impedance + contact, uniform) / s[:, None]
        flow = area * (flux @ uniform)
        out = np.sqrt(area * bond.area) * np.einsum("b,sbc,sc->s", bond.uniform, passed, flux)
        down, _ = stack_profile(layers, "adiabatic", s[:, None], np.zeros(1))
        up, _ = stack_profile(layers[::-1], "adiabatic", s[:, None], np.zeros(1))
        from_top = (down[sensed] - down[sensed + 1])[:, 0] / section.area
        from_bond = (up[count - sensed] - up[count - sensed - 1])[:, 0] / section.area
        return np.stack(
            (
                from_top * flow - from_bond * out,
                flow,
                np.zeros_like(flow),
                np.einsum("c,scd,sd->s", uniform, impedance, flux),
                (flow - out) / s,
                out / s,
            ),
            axis=1,
        )

    return transform


def _solve(matrices: np.ndarray, uniform: np.ndarray) -> np.ndarray:
    """(S, C): each matrix (S, C, C) solved for the uniform pattern."""
    return np.linalg.solve(matrices, np.broadcast_to(uniform, matrices.shape[:2])[..., None])[..., 0]
