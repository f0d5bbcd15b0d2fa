"""The solids in which an object conducts heat: its closed surface, filled with its material and its parts."""

from __future__ import annotations

from functools import lru_cache

from ...thermal import (
    Material,
    Solid,
    SolidPart,
    solid,
)
from .object_spec import ObjectSpec
from .primitives import primitive_surface


@lru_cache(maxsize=256)
def object_solid(spec: ObjectSpec, material: Material) -> Solid:
    """In the object's frame; cylinders and spheres are polyhedra of their volume. spec: without its place."""
    if spec.parts:
        each = zip(spec.assembly.surfaces, (material, *(part.made_of for part in spec.parts)), strict=True)
        return Solid(tuple(SolidPart(*surface, made_of) for surface, made_of in each))
    if spec.mesh is not None:
        return solid(*spec.geometry.surface, material)
    return solid(*primitive_surface(spec.shape, spec.size), material)
