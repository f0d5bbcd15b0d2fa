"""Parts of other materials in an object: a core under a sleeve, a shaft in a handle."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, get_args

from thermograsp.errors import InvalidValueError, finite, length, numbers, unknown_name

from ...thermal import Material, material

RoundShape = Literal["box", "cylinder", "sphere"]
Size = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Part:
    """A part of another material in an object, whose own material fills what its parts leave.

    material: a name or a Material. size: m, full extents (x, y, z); shape: box, cylinder (standing) or sphere of that
    size, None for the object's own shape. mesh: a file of a closed surface in place of these, in the lengths and the
    coordinates of the object's file where that is a mesh. position: m, of the centre of a size in the object's frame;
    of a mesh, how far it is moved. Raises InvalidValueError and UnknownNameError (material, shape).
    """

    material: str | Material
    size: Size | None = None
    shape: RoundShape | None = None
    mesh: str | None = None
    position: Size = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        material(self.material)
        if (self.size is None) == (self.mesh is None):
            raise InvalidValueError(f"part of size {self.size} and mesh {self.mesh!r}: give one of the two")
        if self.mesh is not None and self.shape is not None:
            raise InvalidValueError(
                f"part of shape {self.shape!r} with mesh {self.mesh!r}: leave out the shape"
            )
        if self.shape is not None and self.shape not in get_args(RoundShape):
            raise unknown_name("shape of a part", self.shape, get_args(RoundShape))
        if self.size is not None:
            object.__setattr__(self, "size", checked_size(self.shape or "box", self.size))
        place = tuple(finite("part: position (m)", value) for value in self.position)
        if len(place) != 3:
            raise InvalidValueError(f"part: position {self.position}: give (x, y, z) in m")
        object.__setattr__(self, "position", place)

    @property
    def made_of(self) -> Material:
        """The part's material."""
        return material(self.material)

    def scaled(self, factor: float) -> Part:
        """In an object so many times as large; a mesh's file grows by the object's scale."""
        x, y, z = (factor * value for value in self.position)
        size = self.size and (factor * self.size[0], factor * self.size[1], factor * self.size[2])
        return replace(self, size=size, position=(x, y, z))


def checked_size(shape: str, size: Size) -> Size:
    """The full extents m as floats. Raises InvalidValueError for what is no size of that shape."""
    extents = numbers("size, the full extents (x, y, z) in m,", size, 3)
    x, y, z = (length("size", value) for value in extents)
    if (shape == "sphere" and not x == y == z) or (shape == "cylinder" and x != y):
        raise InvalidValueError(f"size {(x, y, z)} of a {shape}: the extents across its axis must be equal")
    return x, y, z
