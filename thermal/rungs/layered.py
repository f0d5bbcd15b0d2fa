"""Rung "layered": the layered sensor, the contact and an object of finite thickness, in one dimension, exact in time.

Neglects: heat spreading sideways in the object, whose column is as wide as the patch (the contact's area in T mode, the
bonded face in O mode) and adiabatic at its back and sides. So metals and thick plates cool it too little after the heat
front has passed the patch's width. Any constant conductance, 0 included.
"""

from __future__ import annotations

import numpy as np

from .column import (
    Column,
    constant_conductance,
    layer_on_insulation,
    no_air,
    press_curves,
    untouched,
)
from .problem import PressCurves, PressProblem


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
