"""What an object's heat flows in: its closed surface, filled with its material and its parts."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..thermal import Material, Solid, SolidPart, solid
from .scene import ObjectSpec
from .solids import Triangles, cut, ellipsoid, turned


@lru_cache(maxsize=256)
def object_solid(spec: ObjectSpec, material: Material) -> Solid:
    """In the object's frame; cylinders and spheres are polyhedra of their volume. spec: without its place."""
    if spec.parts:
        each = zip(spec.assembly.surfaces, (material, *(part.made_of for part in spec.parts)), strict=True)
        return Solid(tuple(SolidPart(*surface, made_of) for surface, made_of in each))
    if spec.mesh is not None:
        return solid(*spec.geometry.surface, material)
    return solid(*primitive_surface(spec.shape, spec.size), material)


def primitive_surface(shape: str, size: tuple[float, float, float]) -> Triangles:
    """Of a box, a cylinder or a sphere of that size m, about its centre."""
    x, y, z = size
    if shape == "box":
        return cut(np.array([[-y / 2, -z / 2, z / 2], [y / 2, -z / 2, z / 2]]), x)
    if shape == "sphere":
        return ellipsoid(size)
    return turned(np.array([[0.0, -z / 2], [x / 2, -z / 2], [x / 2, z / 2], [0.0, z / 2]]))
