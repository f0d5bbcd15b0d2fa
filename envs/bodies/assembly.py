"""An object of several materials: the surfaces of its parts, what they weigh together, and which of them is touched.

n: parts, the object itself the first.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

import numpy as np

from thermograsp.errors import InvalidValueError

from ...thermal import Material
from ...thermal.surfaces import (
    BENEATH,
    NEARLY_ALL,
    crossings,
    hosts,
    shares_within,
)
from .mesh_files import read_surface
from .meshes import load_mesh
from .parts import Part, Size, checked_size
from .primitives import primitive_surface, unit_inertia
from .solids import Triangles

_ACROSS = np.array([-0.003, 0.0, 0.003])  # m, from a face's middle, where it is asked what is touched


@dataclass(frozen=True, slots=True, eq=False)
class Assembly:
    """The surfaces of an object and of its parts, and how they nest. surfaces: (n,) in the object's frame. within: (n,)
    the part that each lies in, None for the object itself. volumes: (n,) m3 that each encloses, with what lies in it.
    middles: (n, 3) m and unit_inertia: (n, 3, 3) m2 about them, of the same for a uniform kilogram."""

    surfaces: tuple[Triangles, ...]
    within: tuple[int | None, ...]
    volumes: np.ndarray
    middles: np.ndarray
    unit_inertia: np.ndarray

    def weight(self, materials: Sequence[Material]) -> float:
        """kg, each part of its material (n,)."""
        return float(self._masses(materials).sum())

    def inertia(self, materials: Sequence[Material]) -> tuple[np.ndarray, np.ndarray]:
        """Centre of mass (3,) m, and inertia (3, 3) kg m2 about it."""
        masses = self._masses(materials)
        centre = masses @ self.middles / masses.sum()
        away = self.middles - centre
        moved = (
            np.einsum("ni,ni->n", away, away)[:, None, None] * np.eye(3) - away[:, :, None] * away[:, None, :]
        )
        return centre, np.einsum("n,nij->ij", masses, self.unit_inertia + moved)

    def _masses(self, materials: Sequence[Material]) -> np.ndarray:
        """(n,) kg that each adds to what it lies in; below 0 where it is lighter."""
        densities = [each.density for each in materials]
        around = [0.0 if host is None else densities[host] for host in self.within]
        return self.volumes * (np.array(densities) - around)

    def touched(self, middle: np.ndarray, along: np.ndarray, reach: float) -> int:
        """The part that most of two faces meets which close on `middle` (3,) m along `along` (3,), a unit vector across
        z, from `reach` m away; 0 where they meet nothing. What is within BENEATH of the surface is at it."""
        across = np.array([-along[1], along[0], 0.0])
        triangles = [surface.vertices[surface.faces] for surface in self.surfaces]
        votes = np.zeros(len(triangles), int)
        for side, y, z in np.stack(np.meshgrid((-1.0, 1.0), _ACROSS, _ACROSS), axis=-1).reshape(-1, 3):
            origin = middle + reach * side * along + y * across + (0.0, 0.0, z)
            outermost = np.array(
                [crossings(part, origin, side * along).max(initial=-math.inf) for part in triangles]
            )
            if np.isfinite(outermost[0]):
                votes[np.flatnonzero(outermost >= outermost[0] - BENEATH)[-1]] += 1
        return int(np.argmax(votes))


@lru_cache(maxsize=256)
def assembly(
    shape: str, size: Size, mesh: str | None, scale: float, pieces: int, parts: tuple[Part, ...]
) -> Assembly:
    """The assembly of an ObjectSpec's shape and parts. Raises InvalidValueError for parts that do not lie in the
    object, or lie partly in each other, and MeshError for files and surfaces that cannot serve."""
    if mesh is None:
        outline, origin = primitive_surface(shape, size), np.zeros(3)
    else:
        whole = load_mesh(mesh, scale, pieces)
        outline, origin = Triangles(*whole.surface), np.array(whole.origin)
    surfaces = (outline, *(_surface(part, shape, scale, origin) for part in parts))
    within = shares_within([surface.vertices[surface.faces] for surface in surfaces])
    for number, part in enumerate(parts, 1):
        if within[number, 0] < NEARLY_ALL:
            raise InvalidValueError(
                f"part {number} of {part.made_of.name} lies outside the object with {1 - within[number, 0]:.0%} of its "
                "surface: the object's shape is the outline of all its parts"
            )
    found = hosts(within)
    if found is None:
        pairs = combinations(range(1, len(within)), 2)
        first, second = next(pair for pair in pairs if hosts(within[np.ix_(pair, pair)]) is None)
        raise InvalidValueError(
            f"part {second} of {parts[second - 1].made_of.name} overlaps part {first} of "
            f"{parts[first - 1].made_of.name}: place it beside that part, or inside it and later in the list"
        )
    kinds = ((shape, None if mesh else size), *((part.shape or shape, part.size) for part in parts))
    moments = [_moments(surface, *kind) for surface, kind in zip(surfaces, kinds, strict=True)]
    volumes, middles, inertia = (np.array(values) for values in zip(*moments, strict=True))
    return Assembly(surfaces, found, volumes, middles, inertia)


def _surface(part: Part, shape: str, scale: float, origin: np.ndarray) -> Triangles:
    """In the object's frame. origin: (3,) m there of its file."""
    place = np.array(part.position)
    if part.mesh is not None:
        surface = read_surface(part.mesh)
        return Triangles(surface.vertices * scale + origin + place, surface.faces)
    assert part.size is not None
    if part.shape is None and shape == "mesh":
        raise InvalidValueError(
            f"part of size {part.size} in a mesh: give it a shape, box, cylinder or sphere"
        )
    kind = part.shape or shape
    vertices, faces = primitive_surface(kind, checked_size(kind, part.size))
    return Triangles(vertices + place, faces)


def _moments(surface: Triangles, shape: str, size: Size | None) -> tuple[float, np.ndarray, np.ndarray]:
    """Volume m3, its middle (3,) m, and inertia (3, 3) m2 about that of a uniform kilogram; of the true solid where it
    has a size."""
    import trimesh

    mesh = trimesh.Trimesh(*surface, process=False)
    inertia = mesh.moment_inertia / mesh.mass if size is None else unit_inertia(shape, size)
    return float(mesh.volume), np.array(mesh.center_mass), inertia
