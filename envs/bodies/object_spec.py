"""One object that a gripper may grasp: shape, size, materials, contents and place."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from thermograsp.errors import (
    LONGEST,
    InvalidValueError,
    celsius,
    distinct_text,
    finite,
    non_negative,
    numbers,
    positive,
    unknown_name,
    within,
)

from ...thermal import Material, Reservoir, material
from ..limits import (
    CLEARANCE,
    MAX_OPENING,
    PAD_SIDE,
    REACH,
)
from .meshes import MeshShape, load_mesh
from .parts import Part, checked_size
from .primitives import unit_inertia

if TYPE_CHECKING:
    from .assembly import Assembly

DEFAULT_MASS = 0.1  # kg
DEFAULT_FRICTION = 0.8
_MOST_MASS = 1e3  # kg: of some tonnes MuJoCo's contacts let go
_MOST_TURN = 10.0  # rad, more than one and a half turns
_SHAPES = ("box", "cylinder", "sphere", "mesh")


@dataclass(frozen=True, slots=True)
class ObjectSpec:
    """One object on the table. Hashable; the frame is the centre of its bounding box.

    shape: box, cylinder (standing), sphere or mesh. size: m, full extents (x, y, z) in the object's frame; a mesh
    takes them from its file. mass: kg, or density: kg/m3 (at most one; neither means 0.1 kg). friction: sliding
    coefficient of every contact of the object (None: 0.8). position: m, (x, y) of its centre on the table, the
    gripper's is (0, 0). yaw: rad about z. rgba: 0..1. mesh, scale, pieces: see `load_mesh`. elements: (side,
    thickness) m of square plates without mass glued on where the pads meet it, None for none. temperature: °C at first,
    None for the scene's. reservoir: what keeps it hot or cold, None for nothing. material: a name or a Material whose
    density and friction hold where nothing else is said; environments take it where they are not told another one.
    parts: what of it is of other materials (T mode); it has a material of its own then and no density, its mass and
    inertia are those of all, and its friction is that of what the pads meet.
    Raises InvalidValueError, UnknownNameError (shape, material), or MeshError (file).
    """

    name: str = "object"
    shape: Literal["box", "cylinder", "sphere", "mesh"] = "box"
    size: tuple[float, float, float] = (0.04, 0.04, 0.04)
    mass: float | None = None
    density: float | None = None
    friction: float | None = None
    position: tuple[float, float] = (0.0, 0.0)
    yaw: float = 0.0
    rgba: tuple[float, float, float, float] = (0.55, 0.65, 0.75, 1.0)
    mesh: str | None = None
    scale: float = 1.0
    pieces: int = 1
    elements: tuple[float, float] | None = None
    temperature: float | None = None
    reservoir: Reservoir | None = None
    material: str | Material | None = None
    parts: tuple[Part, ...] = ()

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name.isprintable():
            raise InvalidValueError(f"name must be a printable string, got {self.name!r}")
        colour = numbers("rgba (each 0 to 1)", self.rgba, 4)
        if not all(0 <= share <= 1 for share in colour):
            raise InvalidValueError(f"rgba must be four numbers, each 0 to 1, got {self.rgba!r}")
        if self.shape not in _SHAPES:
            raise unknown_name("shape", self.shape, _SHAPES)
        if (self.mesh is None) == (self.shape == "mesh"):
            raise InvalidValueError(
                f"shape {self.shape!r} with mesh {self.mesh!r}: give a file for shape 'mesh' only"
            )
        if self.mass is not None and self.density is not None:
            raise InvalidValueError(f"mass {self.mass} kg and density {self.density} kg/m3: give one of them")
        for field in ("mass", "density"):
            if getattr(self, field) is not None:
                positive(field, getattr(self, field))
        if self.mass is not None:
            within("mass", self.mass, 0.0, _MOST_MASS, "kg")
        if self.friction is not None:
            non_negative("friction", self.friction)
        within("yaw", finite("yaw", self.yaw), -_MOST_TURN, _MOST_TURN, "rad")
        if self.elements and abs(math.sin(self.yaw)) > math.sqrt(0.5):
            raise InvalidValueError(
                f"object {self.name!r} is turned by {self.yaw:.2f} rad: in mode O elements are glued to its sides "
                "along x, which no pad meets then; swap its width and depth in place of the turn, or use mode T"
            )
        for value in numbers("position", self.position, 2):
            within("position", value, -LONGEST, LONGEST, "m")
        set_ = object.__setattr__
        extents = self.geometry.extents if self.mesh else self.size
        set_(self, "size", checked_size(self.shape, extents))
        if self.temperature is not None:
            celsius("temperature", self.temperature)
        if self.material is not None:
            material(self.material)
        parts = tuple(self.parts) if isinstance(self.parts, Iterable) else (None,)
        if not all(isinstance(each, Part) for each in parts):
            raise InvalidValueError(f"parts {self.parts!r}: give a list of envs.Part(material, size=...)")
        set_(self, "parts", parts)
        if self.parts:
            if self.material is None or self.density is not None or self.elements:
                raise InvalidValueError(
                    f"parts in an object of material {self.material!r}, density {self.density} kg/m3 and elements "
                    f"{self.elements}: give the material that is around them, no density, and no elements"
                )
            _ = self.assembly  # checks them
        if self.elements:
            self._check_elements()
        room = MAX_OPENING - CLEARANCE
        if self.width > room:
            raise InvalidValueError(
                f"object {self.name!r} is {distinct_text(1e3 * self.width, 1e3 * room)} mm wide along x, the gripper "
                f"opens {1e3 * MAX_OPENING:.0f} mm: make it at most {1e3 * room:.0f} mm or turn it (yaw)"
            )

    @property
    def geometry(self) -> MeshShape:
        """The mesh's shape (cached by file). Raises InvalidValueError when the object has none."""
        if self.mesh is None:
            raise InvalidValueError(f"object {self.name!r} is a {self.shape}, not a mesh")
        return load_mesh(self.mesh, self.scale, self.pieces)

    @property
    def assembly(self) -> Assembly:
        """The object and its parts together, the object first (cached)."""
        from .assembly import assembly  # nothing that parts need is loaded without them

        return assembly(self.shape, self.size, self.mesh, self.scale, self.pieces, self.parts)

    @property
    def materials(self) -> tuple[Material, ...]:
        """The object's own material, where it has one, and its parts'."""
        first = () if self.material is None else (material(self.material),)
        return (*first, *(part.made_of for part in self.parts))

    @property
    def touched_part(self) -> int:
        """What most of both pads' faces meet that close on it: 0 for its own material, else the number of a part."""
        if not self.parts:
            return 0
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        x, y = self.position
        middle = np.array([-x * cos - y * sin, x * sin - y * cos, self.grasp_height - self.size[2] / 2])
        return self.assembly.touched(middle, np.array([cos, -sin, 0.0]), sum(self.size))

    @property
    def touched(self) -> Material | None:
        """The material of that, None where it has none."""
        return self.materials[self.touched_part] if self.material is not None else None

    @property
    def hulls(self) -> int:
        """Number of convex geoms."""
        return len(self.geometry.hulls) if self.mesh else 1

    @property
    def width(self) -> float:
        """m, extent along x (between the fingers) at this yaw; of the bounding box for a mesh."""
        glued = 2 * self.elements[1] if self.elements else 0.0
        if self.shape in ("sphere", "cylinder"):
            return self.size[0] + glued
        return (self.size[0] + glued) * abs(math.cos(self.yaw)) + self.size[1] * abs(math.sin(self.yaw))

    @property
    def element_places(self) -> np.ndarray:
        """(2, 3) m in the object's frame: the outer faces' middles of the left and the right element."""
        thickness = self.elements[1] if self.elements else 0.0
        height = self.grasp_height - self.size[2] / 2
        return np.array([[side * (self.size[0] / 2 + thickness), 0.0, height] for side in (-1, 1)])

    @property
    def volume(self) -> float:
        """Volume, m3."""
        x, y, z = self.size
        if self.shape == "mesh":
            return self.geometry.volume
        return x * y * z * {"box": 1.0, "cylinder": math.pi / 4, "sphere": math.pi / 6}[self.shape]

    @property
    def surface(self) -> float:
        """m2 of its surface, of a mesh with its cavities'."""
        x, y, z = self.size
        if self.shape == "mesh":
            vertices, faces = self.geometry.surface
            a, b, c = (vertices[faces[:, i]] for i in range(3))
            return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()) / 2
        return {
            "box": 2 * (x * y + y * z + x * z),
            "cylinder": math.pi * x * (x / 2 + z),
            "sphere": math.pi * x * x,
        }[self.shape]

    @property
    def weight(self) -> float:
        """kg, the mass given or that of the density, given or the materials'; else 0.1."""
        if self.mass is not None:
            return self.mass
        if self.parts:
            return self.assembly.weight(self.materials)
        if self.density is not None:
            return self.density * self.volume
        return DEFAULT_MASS if self.material is None else material(self.material).density * self.volume

    @property
    def sliding_friction(self) -> float:
        """The coefficient of sliding friction of every contact: what is given, else that of the material that is
        touched, else 0.8."""
        if self.friction is not None:
            return self.friction
        touched = self.touched
        return DEFAULT_FRICTION if touched is None or touched.friction is None else touched.friction

    @property
    def inertia(self) -> tuple[np.ndarray, np.ndarray]:
        """Centre of mass (3,) m and inertia matrix about it (3, 3) kg m2, in the object's frame, of uniform
        materials."""
        if self.parts:
            centre, inertia = self.assembly.inertia(self.materials)
            return centre, self.weight / self.assembly.weight(self.materials) * inertia
        if self.shape == "mesh":
            shape = self.geometry
            return np.array(shape.centre_of_mass), self.weight * np.array(shape.unit_inertia)
        return np.zeros(3), self.weight * unit_inertia(self.shape, self.size)

    @property
    def pose(self) -> np.ndarray:
        """(7,) position of the centre in m and unit quaternion (w, x, y, z), resting on the table."""
        half = self.yaw / 2
        return np.array([*self.position, self.size[2] / 2, math.cos(half), 0.0, 0.0, math.sin(half)])

    @property
    def grasp_height(self) -> float:
        """m over the table of the grasp centre when the gripper is down.

        The middle of the side faces, but the pads stay off the table and the palm off the object's top.
        """
        lowest = PAD_SIDE / 2 + CLEARANCE
        return max(self.size[2] / 2, lowest, self.size[2] + CLEARANCE - REACH)

    def _check_elements(self) -> None:
        """Raises InvalidValueError where they would stick out over the object's edge: only what lies on it conducts."""
        what = "elements (side, thickness)"
        side, _ = (positive(what, value) for value in numbers(what, self.elements, 2))
        for name, given, least in (
            ("high", self.size[2], self.grasp_height + side / 2),
            ("deep along y", self.size[1], side),
        ):
            if given < least * (1 - 1e-9):
                raise InvalidValueError(
                    f"object {self.name!r} is {distinct_text(1e3 * given, 1e3 * least)} mm {name}: in mode O elements "
                    f"of {1e3 * side:g} mm are glued to its sides, their middles {1e3 * self.grasp_height:g} mm above "
                    f"the table, and would stick out; make it {1e3 * least:g} mm at least, or use mode T"
                )


def scaled(spec: ObjectSpec, size: float = 1.0, *, mass: float = 1.0, friction: float = 1.0) -> ObjectSpec:
    """The object with its size, mass and friction times these factors. A larger one of given density or materials is
    heavier; one of given mass is not."""
    if size == mass == friction == 1.0:
        return spec
    extents = (
        {"scale": spec.scale * size} if spec.mesh else {"size": tuple(size * side for side in spec.size)}
    )
    heavier = {"density": spec.density * mass} if spec.density is not None else {"mass": spec.weight * mass}
    rougher = {"friction": spec.sliding_friction * friction}
    if spec.parts:
        extents |= {"scale": spec.scale * size, "parts": tuple(part.scaled(size) for part in spec.parts)}
        heavier = {"mass": spec.weight * mass * (1.0 if spec.mass is not None else size**3)}
    return replace(spec, **extents, **heavier, **rougher)


def placeless(spec: ObjectSpec) -> ObjectSpec:
    """The same object at the origin: what the compiled model depends on (the pose is state, heat is not its affair)."""
    return replace(spec, position=(0.0, 0.0), yaw=0.0, temperature=None, reservoir=None)
