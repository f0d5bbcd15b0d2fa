"""What an object's heat flows in: its closed surface, filled with its material."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..thermal import Material, Solid, solid
from .scene import ObjectSpec
from .solids import cut, ellipsoid, turned


@lru_cache(maxsize=256)
def object_solid(spec: ObjectSpec, material: Material) -> Solid:
    """In the object's frame; cylinders and spheres are polyhedra of their volume. spec: without its place."""
    if spec.mesh is not None:
        return solid(*spec.geometry.surface, material)
    x, y, z = spec.size
    if spec.shape == "box":
        surface = cut(np.array([[-y / 2, -z / 2, z / 2], [y / 2, -z / 2, z / 2]]), x)
    elif spec.shape == "sphere":
        surface = ellipsoid(spec.size)
    else:
        surface = turned(np.array([[0.0, -z / 2], [x / 2, -z / 2], [x / 2, z / 2], [0.0, z / 2]]))
    return solid(surface.vertices, surface.faces, material)
