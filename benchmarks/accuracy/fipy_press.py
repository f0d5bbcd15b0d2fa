"""A press with FiPy, as one would write it (optional extra `bench`): finite volumes in radius and depth.

One cylindrical grid holds the plate and the sensor on it; beside the sensor is a filling that conducts nothing. The
contact is a lower conductivity of the faces between the two, FiPy's own way to have a thermal contact. The cells are
those of semi_discrete, and FiPy's TransientTerm steps them by backward Euler.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from importlib.util import find_spec
from typing import Any

import numpy as np

from thermograsp.bench.accuracy.semi_discrete import uniform
from thermograsp.errors import MissingDependencyError, install
from thermograsp.thermal import PressProblem

_NOTHING = 1e-12  # W/(m K), of the filling


def available() -> bool:
    """Whether FiPy is installed."""
    return find_spec("fipy") is not None


def fipy_press(problem: PressProblem, spacing: float, count: int, cell: float) -> Callable[[], np.ndarray]:
    """The march that returns the temperature drop (count + 1,) K at 0, spacing, 2 spacing, ... s, on cells of about
    `cell` m.

    The contact must be the whole face, its conductance a number, the sensed layer between two others, without air.
    Raises MissingDependencyError without FiPy.
    """
    try:
        fipy: Any = importlib.import_module("fipy")  # its types are inferred, and wrong
    except ImportError as error:
        raise MissingDependencyError(f"this method needs FiPy: {install('bench')}") from error
    assert not callable(problem.conductance) and problem.air == 0
    face, plate = problem.stack.face_area, problem.object_size[0] * problem.object_size[1]
    inner = uniform(0.0, np.sqrt(face / np.pi), cell)
    radius = np.append(inner, uniform(inner[-1], np.sqrt(plate / np.pi), cell)[1:])
    layers = problem.stack.layers[::-1]  # upwards, as z
    parts = [np.diff(uniform(0.0, layer.thickness, cell)) for layer in layers]
    depths = np.diff(uniform(0.0, problem.object_size[2], cell))
    layer_of = np.repeat(np.arange(len(layers)), [len(part) for part in parts])
    mesh = fipy.CylindricalGrid2D(dx=np.diff(radius), dy=np.concatenate((depths, *parts)))

    under, rows = len(inner) - 1, len(depths)
    shape = (rows + len(layer_of), len(radius) - 1)
    k, heat = np.full(shape, _NOTHING), np.full(shape, problem.material.volumetric_heat_capacity)
    k[:rows] = problem.material.conductivity
    k[rows:, :under] = np.array([layer.conductivity for layer in layers])[layer_of, None]
    heat[rows:, :under] = np.array([layer.volumetric_heat_capacity for layer in layers])[layer_of, None]
    first = np.zeros(shape)
    if problem.mode == "T":
        first[rows:, :under] = problem.temperature_difference

    u = fipy.CellVariable(mesh=mesh, value=first.ravel(), hasOld=True)
    conductivity = fipy.FaceVariable(
        mesh=mesh, value=fipy.CellVariable(mesh=mesh, value=k.ravel()).harmonicFaceValue
    )
    x, y = mesh.faceCenters
    top = mesh.facesTop & (x < inner[-1])
    at_face = (abs(y - problem.object_size[2]) < 1e-9) & (x < inner[-1]) & (mesh.faceNormals[1] != 0)
    contact = np.asarray(at_face if problem.mode == "T" else top)
    # k/d of a face with the contact's resistance in series
    distance = np.linalg.norm(np.asarray(mesh.cellDistanceVectors), axis=0)
    value = np.asarray(conductivity.value)
    series = distance / (distance / value + 1 / problem.conductance)
    conductivity.setValue(np.where(contact, series, value))
    u.constrain(problem.temperature_difference, where=top)
    equation = fipy.TransientTerm(
        coeff=fipy.CellVariable(mesh=mesh, value=heat.ravel())
    ) == fipy.DiffusionTerm(coeff=conductivity)
    solver = fipy.LinearLUSolver()
    read = _reader(problem, inner, rows, shape, np.concatenate(parts), k)

    def march() -> np.ndarray:
        u.setValue(first.ravel())
        drops = [read(first)]
        for _ in range(count):
            u.updateOld()
            equation.solve(var=u, dt=spacing, solver=solver)
            drops.append(read(np.asarray(u.value).reshape(shape)))
        return np.array(drops)

    return march


def _reader(
    problem: PressProblem,
    inner: np.ndarray,
    rows: int,
    shape: tuple[int, int],
    heights: np.ndarray,
    k: np.ndarray,
) -> Callable[[np.ndarray], float]:
    """The drop over the sensed layer, between the mean temperatures of its bounds, of a field (rows, columns) K."""
    under = len(inner) - 1
    weights = np.diff(inner**2) / inner[-1] ** 2
    half = heights / (2 * k[rows:, 0])
    bounds = np.append(0.0, np.cumsum(heights))
    layers = problem.stack.layers[::-1]
    tops = np.cumsum([layer.thickness for layer in layers])
    sensed = len(layers) - 1 - problem.stack.sensed
    levels = [
        int(np.argmin(np.abs(bounds - tops[sensed]))),
        int(np.argmin(np.abs(bounds - tops[sensed - 1]))),
    ]

    def read(field: np.ndarray) -> float:
        ends = []
        for level in levels:
            below, above = field[rows + level - 1, :under], field[rows + level, :under]
            at = (below * half[level] + above * half[level - 1]) / (half[level] + half[level - 1])
            ends.append(float(weights @ at))
        return ends[0] - ends[1]

    return read
