"""Rung "full axisymmetric grid": finite volumes in radius and depth."""

from __future__ import annotations

import numpy as np

from ..numerics import Grid, radial_axis, single_cell
from .grid import (
    STEP_PER_TIME,
    contact_edges,
    finest,
    march,
    press_grid,
)
from .problem import PressCurves, PressProblem


def grid(problem: PressProblem, resolution: int = 2) -> Grid:
    """Grid of round patch, round sensor and disc, each of the area of its counterpart in the problem.

    resolution: divides every cell's sides. A square patch or a rectangular plate is replaced by the disc of equal area.
    """
    contact, sensor, plate = (
        np.sqrt(area / np.pi)
        for area in (
            min(problem.area, problem.stack.face_area),
            problem.stack.face_area,
            problem.object_size[0] * problem.object_size[1],
        )
    )
    film = problem.air / problem.material.conductivity
    face = contact_edges(problem, contact, sensor, sensor, resolution)
    disc = contact_edges(problem, contact, sensor, plate, resolution)
    axes = ((radial_axis(face), single_cell()), (radial_axis(disc, film), single_cell()))
    touching = int(np.searchsorted(face, contact * (1 - 1e-12)))
    return press_grid(problem, axes, (touching, 1), finest(contact), resolution)


def solve(
    problem: PressProblem, t: np.ndarray, resolution: int = 2, step_per_time: float = STEP_PER_TIME
) -> PressCurves:
    """Curves at the times t (n,) s by finite volumes in r, z and SDIRK2 in time.

    resolution: 1, 2, ...; step_per_time: length of a step over the time since the touch or the last jump of the
    conductance. Both errors fall with the square of the step: .02 K of the drop at resolution 1, .005 K at 2, .001 K at
    4 for the seed's sensor and a disc of the area of its plate. For shape="square" the disc of equal area changes the
    drop by up to another .06 K (glass, 20 s).
    """
    return march(problem, grid(problem, resolution), t, step_per_time)
