"""An object of any shape to its heat: closed surfaces of materials, and the patches where it is touched."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from thermograsp.errors import LONGEST, InvalidValueError, MeshError, positive

from ..matter import Material
from .check import open_edges, wrongly_enclosed
from .nesting import hosts, shares_within

_SMALLEST = 0.5e-3  # m, of an object's longest side
_TWICE = 1e-3  # of the volume that may be enclosed twice or inside out


@dataclass(frozen=True, slots=True, eq=False)
class SolidPart:
    """One closed surface and what fills it.

    vertices: (V, 3) m. faces: (F, 3) indices, counter-clockwise seen from outside; cavities are faces turned inward.
    Raises MeshError where it is not closed, inside out or empty, or InvalidValueError for shapes and indices that do
    not fit.
    """

    vertices: np.ndarray
    faces: np.ndarray
    material: Material

    def __post_init__(self) -> None:
        vertices = np.ascontiguousarray(self.vertices, float)
        faces = np.ascontiguousarray(self.faces, np.int64)
        if vertices.ndim != 2 or vertices.shape[1] != 3 or faces.ndim != 2 or faces.shape[1] != 3:
            raise InvalidValueError(
                f"a part is vertices (V, 3) m and faces (F, 3), got {vertices.shape} and {faces.shape}"
            )
        if not len(faces):
            raise MeshError("the part has no faces: give a closed surface")
        if faces.min() < 0 or faces.max() >= len(vertices):
            raise InvalidValueError(
                f"faces name vertices {faces.min()} .. {faces.max()}, there are {len(vertices)}"
            )
        if not np.isfinite(vertices).all():
            raise MeshError("the part has vertices that are not finite: export it again")
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", faces)
        loose = open_edges(faces, len(vertices))
        if loose:
            raise MeshError(
                f"the part is not closed, {loose} of its edges have no face on their other side, or one "
                "that is turned the wrong way: merge its vertices, close its holes and turn its faces outward"
            )
        if not self.volume > 0:
            raise MeshError(
                f"the part encloses {self.volume:.3g} m3: turn its faces outward, or give a solid, not a sheet"
            )

    @property
    def triangles(self) -> np.ndarray:
        """(F, 3, 3) m, corners of each face."""
        return self.vertices[self.faces]

    @property
    def area_vectors(self) -> np.ndarray:
        """(F, 3) m2, outward normal times area of each face."""
        a, b, c = np.moveaxis(self.triangles, 1, 0)
        return np.cross(b - a, c - a) / 2

    @property
    def volume(self) -> float:
        """m3 enclosed, negative where the surface is inside out."""
        corners = self.triangles - self.vertices.mean(axis=0)
        return float(np.einsum("fi,fi->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6)


@dataclass(frozen=True, slots=True, eq=False)
class Solid:
    """A conducting object in its own frame: parts that are bonded wherever they meet. Where parts overlap, the later
    one's material counts: a core is given after the body that it sits in."""

    parts: tuple[SolidPart, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "parts", tuple(self.parts))
        if not self.parts:
            raise InvalidValueError("an object needs at least one part")

    @property
    def hosts(self) -> tuple[int | None, ...] | None:
        """The last of the earlier parts that each lies in, None where in none. None in all where parts cross."""
        return _hosts(self)

    @property
    def outside(self) -> np.ndarray:
        """(F, 3, 3) m, faces of the parts that lie in no other: all that can be touched."""
        return _outside(self)

    @property
    def surface(self) -> float:
        """m2 of the outside, walls of cavities included; where parts meet side by side, both count."""
        a, b, c = np.moveaxis(self.outside, 1, 0)
        return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()) / 2

    @property
    def bounds(self) -> np.ndarray:
        """(2, 3) m, the lowest and the highest corner."""
        used = np.concatenate([part.triangles.reshape(-1, 3) for part in self.parts])
        return np.stack((used.min(axis=0), used.max(axis=0)))


@lru_cache(maxsize=256)
def _hosts(body: Solid) -> tuple[int | None, ...] | None:
    return hosts(shares_within([part.triangles for part in body.parts]))


@lru_cache(maxsize=64)
def _outside(body: Solid) -> np.ndarray:
    within = body.hosts or (None,) * len(body.parts)
    shown = [part.triangles for part, host in zip(body.parts, within, strict=True) if host is None]
    found = np.concatenate(shown)
    found.flags.writeable = False
    return found


@dataclass(frozen=True, slots=True)
class SurfacePatch:
    """A square place on an object's surface that is touched. centre: (3,) m, in the object's frame; where it is not on
    the surface, the surface is looked for along the normal. normal: (3,) outward, of any length. area: m2."""

    centre: tuple[float, float, float]
    normal: tuple[float, float, float]
    area: float = 81e-6

    def __post_init__(self) -> None:
        for name in ("centre", "normal"):
            value = tuple(float(x) for x in getattr(self, name))
            if len(value) != 3 or not np.isfinite(value).all():
                raise InvalidValueError(f"a patch's {name} must be three finite numbers, got {value}")
            object.__setattr__(self, name, value)
        if not np.linalg.norm(self.normal) > 0:
            raise InvalidValueError("a patch's normal must not be zero")
        positive("area of a patch (m2)", self.area)

    @property
    def direction(self) -> np.ndarray:
        """(3,) the normal, of length 1."""
        return np.array(self.normal) / np.linalg.norm(self.normal)

    @property
    def half_width(self) -> float:
        """m, half the square's side."""
        return float(np.sqrt(self.area)) / 2


def checked(body: Solid) -> Solid:
    """The object. Raises MeshError where it is far larger or smaller than what a fingertip touches, or where a part
    encloses volume twice or inside out, with how much."""
    longest = float(np.ptp(body.bounds, axis=0).max())
    if not _SMALLEST <= longest <= LONGEST:
        advice = "lengths are metres: multiply them by 0.001 if yours are millimetres"
        raise MeshError(f"the object is {longest:.4g} m long, not {_SMALLEST:g} .. {LONGEST:g} m; {advice}")
    for number, part in enumerate(body.parts):
        twice, inside_out = wrongly_enclosed(part.triangles)
        for volume, how in ((twice, "twice"), (inside_out, "inside out")):
            if volume > _TWICE * part.volume:
                raise MeshError(
                    f"part {number} encloses {1e6 * volume:.3g} of its {1e6 * part.volume:.3g} cm3 {how}, since its "
                    "surfaces cross: unite them (Blender: Boolean, union; trimesh: trimesh.boolean.union)"
                )
    return body


def solid(vertices: np.ndarray, faces: np.ndarray, material: Material) -> Solid:
    """An object of one part; see SolidPart."""
    return Solid((SolidPart(vertices, faces, material),))


def surface_patches(patches: Sequence[SurfacePatch]) -> tuple[SurfacePatch, ...]:
    """The patches, at least one."""
    if not len(patches):
        raise InvalidValueError("give at least one patch: a body that nothing touches needs no network")
    return tuple(patches)
