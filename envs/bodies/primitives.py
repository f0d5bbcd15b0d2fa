"""Boxes, cylinders and spheres: their surfaces and their inertia."""

from __future__ import annotations

import numpy as np

from .solids import (
    Triangles,
    cut,
    ellipsoid,
    turned,
)


def primitive_surface(shape: str, size: tuple[float, float, float]) -> Triangles:
    """The surface of a box, a cylinder or a sphere of that size m, about its centre."""
    x, y, z = size
    if shape == "box":
        return cut(np.array([[-y / 2, -z / 2, z / 2], [y / 2, -z / 2, z / 2]]), x)
    if shape == "sphere":
        return ellipsoid(size)
    return turned(np.array([[0.0, -z / 2], [x / 2, -z / 2], [x / 2, z / 2], [0.0, z / 2]]))


def unit_inertia(shape: str, size: tuple[float, float, float]) -> np.ndarray:
    """(3, 3) m2 about its centre of a uniform kilogram: a box, cylinder or sphere of that size m."""
    x, y, z = (s * s for s in size)
    across, along = {
        "box": ((y + z) / 12, (x + y) / 12),
        "cylinder": (x / 16 + z / 12, x / 8),
        "sphere": (x / 10, x / 10),
    }[shape]
    second = (x + z) / 12 if shape == "box" else across
    return np.diag((across, second, along))
