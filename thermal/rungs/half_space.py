"""Rung "half_space": the contact of two semi-infinite bodies, the quickest there is, right for the first moments only.

T mode: element and object are half-spaces; O mode: the element is one under an ideal thermostat. The surfaces jump to

    fall of the sensor's side = dT b_M/(b_S + b_M) (1 - erfcx(eta)),   eta = h sqrt(t) (1/b_S + 1/b_M)

(b effusivities, h conductance; Carslaw & Jaeger, Conduction of Heat in Solids, 2nd ed., section 2.7), and for
perfect contact to the contact temperature. The drop is read from the field at the two depths of the sensed layer.
"""

from __future__ import annotations

import numpy as np
from scipy.special import erfc, erfcx

from .closed_form import equivalent_slab
from .layered import (
    constant_conductance,
    no_air,
    sample_times,
    untouched,
)
from .problem import PressCurves, PressProblem


def solve(problem: PressProblem, t: np.ndarray) -> PressCurves:
    """Curves at t (n,) s, >= 0.

    The element is a half-space of its equivalent homogeneous layer (closed_form.equivalent_slab), the sensed layer
    at the depths to which heat diffuses in the same time: a layer of thickness d and diffusivity alpha is
    d sqrt(alpha_equivalent/alpha) thick. Neglects: the element's far side (the
    thermostat in T mode, the object in O mode), so it holds while t << R C of the element (R, C its resistance and
    capacity: 7 s for the seed's); differences between the layers; the object's thickness; heat spreading sideways.
    In O mode the object gains nothing.
    Raises InvalidValueError when the conductance is a function of time or air is not 0.
    """
    conductance = constant_conductance(problem, "half_space")
    no_air(problem, "half_space")
    if conductance == 0:
        return untouched(problem, t)
    t = sample_times(t)
    slab, stack = equivalent_slab(problem.stack), problem.stack
    element = slab.effusivity * stack.face_area  # W s^0.5 / K
    contact = conductance * problem.area  # W/K
    if problem.mode == "T":
        share = 1 / (1 + element / (problem.material.effusivity * problem.area))
    else:
        share = 1.0
    rate = contact / (element * share)  # s^-0.5: element * share is the two effusances in series
    eta = rate * np.sqrt(t)
    jump = problem.temperature_difference
    flow = jump * contact * erfcx(eta)
    heat = _heat(contact, rate, t) * jump
    near, far = (
        _temperature(depth, slab.diffusivity, rate, t) for depth in _depths(problem, slab.diffusivity)
    )
    element_side = jump * share * (1 - erfcx(eta))
    if problem.mode == "T":
        sensor_surface = problem.sensor_temperature - element_side
        object_surface = problem.object_temperature + jump * (1 - share) * (1 - erfcx(eta))
        stored = np.stack([-heat, heat], axis=1)
    else:
        sensor_surface = np.full(len(t), problem.sensor_temperature)
        object_surface = problem.object_temperature + element_side
        stored = np.stack([heat, np.zeros_like(heat)], axis=1)
    return PressCurves(
        temperature_drop=jump * share * (near - far),
        heat_flow=flow,
        sensor_surface=sensor_surface,
        object_surface=object_surface,
        stored_heat=stored,
    )


def _depths(problem: PressProblem, diffusivity: float) -> tuple[float, float]:
    """m, the sensed layer's nearer and farther face below the opening contact, at equal diffusion time."""
    sensed = problem.stack.sensed
    depth = [layer.thickness * np.sqrt(diffusivity / layer.diffusivity) for layer in problem.stack.layers]
    near = sum(depth[sensed + 1 :] if problem.mode == "T" else depth[:sensed])
    return near, near + depth[sensed]


def _temperature(depth: float, diffusivity: float, rate: float, t: np.ndarray) -> np.ndarray:
    """Share of the surface's final jump that has come to the depth."""
    result = np.zeros_like(t)
    later = t > 0
    x = depth / (2 * np.sqrt(diffusivity * t[later]))
    result[later] = erfc(x) - np.exp(-(x**2)) * erfcx(x + rate * np.sqrt(t[later]))
    return result


def _heat(contact: float, rate: float, t: np.ndarray) -> np.ndarray:
    """J per kelvin, the integral of contact * erfcx(rate sqrt t)."""
    eta = rate * np.sqrt(t)
    return contact / rate**2 * (erfcx(eta) - 1 + 2 * eta / np.sqrt(np.pi))
