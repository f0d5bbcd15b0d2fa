"""A press on a plain uniform grid, as one would write it: matrices for whichever method steps them in time.

Cell-centred finite volumes in radius and depth; square faces are discs of equal area. With one cell across, it is the
one-dimensional column. Cells are equally long, without the grading toward the contact's edge of the package's grids.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from thermograsp.thermal import PressProblem


@dataclass(frozen=True, slots=True)
class SemiDiscrete:
    """mass @ u' + stiffness @ u = load with u (n,) K above the object's first temperature.

    mass J/K, stiffness W/K: (n, n). load: (n,) W. drop: (n,) row of the temperature drop. first: (n,) u at the touch.
    """

    mass: sparse.csc_matrix
    stiffness: sparse.csc_matrix
    load: np.ndarray
    drop: np.ndarray
    first: np.ndarray


def disc_press(problem: PressProblem, cell: float, lateral: bool = True) -> SemiDiscrete:
    """The press with cells of about `cell` m. lateral: False for the column under the sensor alone, in depth only.

    The contact must be the whole face, its conductance a number, the sensed layer between two others, without air.
    """
    assert not callable(problem.conductance) and problem.air == 0
    layers = problem.stack.layers
    face, plate = problem.stack.face_area, problem.object_size[0] * problem.object_size[1]
    if lateral:
        inner = uniform(0.0, np.sqrt(face / np.pi), cell)
        radius = np.append(inner, uniform(inner[-1], np.sqrt(plate / np.pi), cell)[1:])
    else:
        inner = radius = np.array([0.0, np.sqrt(face / np.pi)])
    parts = [uniform(0.0, layer.thickness, cell) for layer in layers]
    heights = np.concatenate([np.diff(part) for part in parts])
    layer_of = np.repeat(np.arange(len(layers)), [len(part) - 1 for part in parts])
    depths = np.diff(uniform(0.0, problem.object_size[2], cell))
    material = problem.material
    sensor = _Block(
        inner,
        heights,
        np.array([layer.conductivity for layer in layers])[layer_of],
        np.array([layer.volumetric_heat_capacity for layer in layers])[layer_of],
        0,
    )
    body = _Block(
        radius,
        depths,
        np.full(len(depths), material.conductivity),
        np.full(len(depths), material.volumetric_heat_capacity),
        sensor.number.size,
    )
    resistance = 1 / problem.conductance
    between = sensor.half[-1] + body.half[0] + (resistance if problem.mode == "T" else 0.0)
    above = sensor.half[0] + (resistance if problem.mode == "O" else 0.0)
    rows = sensor.number.shape[1]
    pairs = [
        *sensor.links(),
        *body.links(),
        (sensor.number[-1], body.number[0, :rows], sensor.area / between),
    ]
    n = sensor.number.size + body.number.size
    stiffness = sparse.csc_matrix((n, n))
    for first, second, link in pairs:
        i, j, g = first.ravel(), second.ravel(), link.ravel()
        at = (np.concatenate((i, j, i, j)), np.concatenate((i, j, j, i)))
        stiffness = stiffness + sparse.csc_matrix((np.concatenate((g, g, -g, -g)), at), shape=(n, n))
    film, load = np.zeros(n), np.zeros(n)
    film[sensor.number[0]] = sensor.area / above
    load[sensor.number[0]] = sensor.area / above * problem.temperature_difference
    drop = np.zeros(n)
    sensed = np.flatnonzero(layer_of == problem.stack.sensed)
    for cell_below, sign in ((sensed[0], 1.0), (sensed[-1] + 1, -1.0)):
        upper, lower = sensor.half[cell_below - 1], sensor.half[cell_below]
        share = sign * sensor.area / sensor.area.sum() / (upper + lower)
        drop[sensor.number[cell_below - 1]] += share * lower
        drop[sensor.number[cell_below]] += share * upper
    first = np.zeros(n)
    if problem.mode == "T":
        first[sensor.number] = problem.temperature_difference
    return SemiDiscrete(
        sparse.csc_matrix(sparse.diags(np.concatenate((sensor.capacity.ravel(), body.capacity.ravel())))),
        sparse.csc_matrix(stiffness + sparse.diags(film)),
        load,
        drop,
        first,
    )


class _Block:
    """One body's cells, numbered (D, I) with I along the radius, and the links between them."""

    def __init__(
        self, radius: np.ndarray, heights: np.ndarray, k: np.ndarray, heat: np.ndarray, start: int
    ) -> None:
        self.radius, self.heights, self.k = radius, heights, k
        self.area = np.pi * np.diff(radius**2)
        self.half = heights / (2 * k)
        self.capacity = np.outer(heights * heat, self.area)
        self.number = start + np.arange(self.capacity.size).reshape(self.capacity.shape)

    def links(self) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """(cells, their neighbours, W/K between them): along the radius, and in depth."""
        widths = np.diff(self.radius)
        along = np.outer(self.heights * self.k, 4 * np.pi * self.radius[1:-1] / (widths[1:] + widths[:-1]))
        down = np.outer(1 / (self.half[:-1] + self.half[1:]), self.area)
        return [(self.number[:, :-1], self.number[:, 1:], along), (self.number[:-1], self.number[1:], down)]


def uniform(start: float, stop: float, cell: float) -> np.ndarray:
    """Bounds from start to stop of equal cells of about `cell`, all m; one cell at least."""
    return np.linspace(start, stop, max(1, round((stop - start) / cell)) + 1)
