"""Everyday objects by name: shape, material, contents and temperature from assets/objects.toml.

Meshes are made when an object is first asked for and kept in the cache's folder under a hash of their vertices and
faces.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from thermograsp.errors import InvalidValueError, ThermograspError, celsius, finite, positive, unknown_name
from thermograsp.files import cached_file, read_toml

from ...assets import asset
from ...thermal import Reservoir, material
from .object_spec import ObjectSpec
from .parts import Part
from .recipes import Solid, make
from .solids import Triangles

ROOM = 24.0  # °C
LEAST_GRIP = 2.0  # N
GRIP_MARGIN = 1.6
FILM = 500.0
"""W/(m2 K) between contents and wall, free convection in water: Nu = .59 Ra^(1/4) over 5 cm with 10 K between the two
(Incropera et al., Fundamentals of Heat and Mass Transfer, equation 9.24)."""
_GRAVITY = 9.81  # m/s2
_KEYS = ("about", "recipe", "material", "temperature", "mass", "friction", "contents", "parts", "like")


@dataclass(frozen=True, slots=True)
class Contents:
    """What fills a hollow object. material: its name. level: share of the hollow's height, 0 .. 1."""

    material: str
    level: float

    def __post_init__(self) -> None:
        material(self.material)
        if not 0 <= finite("contents: level", self.level) <= 1:
            raise InvalidValueError(f"contents: level must be from 0 to 1, got {self.level!r}")


@dataclass(frozen=True)
class PartPreset:
    """A part of another material. material: a name. recipe and parameters: how its shape is made. position: m, of its
    recipe's origin in the object's. Raises UnknownNameError and InvalidValueError."""

    material: str
    recipe: str
    parameters: Mapping[str, Any] = field(default_factory=dict, repr=False)
    position: Sequence[float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        material(self.material)

    def part(self, origin: np.ndarray) -> Part:
        """As an ObjectSpec takes it. origin: (3,) m, where the object's recipe has its origin in the object's frame."""
        solid = make(self.recipe, self.parameters)
        if solid.surface is None:
            x, y, z = (np.array(self.position, float) + origin).tolist()
            return Part(self.material, solid.size, solid.shape, position=(x, y, z))  # pyright: ignore
        x, y, z = self.position
        return Part(self.material, mesh=str(_file(solid.surface)), position=(x, y, z))


@dataclass(frozen=True)
class ObjectPreset:
    """An object of the library. about: one line of description. recipe and parameters: how its shape is made, see
    recipes.py. material: a name. temperature: °C at the start. mass: kg, None for the weight of solid and contents.
    friction: None for the material's. contents: what it holds. parts: its parts of other materials. Raises
    UnknownNameError and InvalidValueError."""

    name: str
    about: str
    recipe: str
    material: str
    parameters: Mapping[str, Any] = field(default_factory=dict, repr=False)
    temperature: float = ROOM
    mass: float | None = None
    friction: float | None = None
    contents: Contents | None = None
    parts: tuple[PartPreset, ...] = ()

    def __post_init__(self) -> None:
        material(self.material)
        celsius("temperature (°C)", self.temperature)
        if self.mass is not None:
            positive("mass (kg)", self.mass)

    @cached_property
    def solid(self) -> Solid:
        """The object's shape. Raises InvalidValueError where the recipe's parameters make none."""
        return make(self.recipe, self.parameters)

    def spec(self) -> ObjectSpec:
        """As the scene takes it; a mesh is written to the cache where it is not there yet. Contents count as mass
        spread evenly and as a well mixed reservoir behind a film on the wetted wall."""
        spec, mass, inside = self._empty(), self.mass, None
        if self.contents is not None:
            holds = material(self.contents.material)
            weight = holds.density * self.solid.room(self.contents.level)
            film = FILM * self.solid.wetted(self.contents.level)
            inside = Reservoir(weight * holds.specific_heat, film)
            if mass is None:
                mass = spec.weight + weight
        return replace(spec, mass=mass, reservoir=inside)

    def _empty(self) -> ObjectSpec:
        """Without contents, of its own weight."""
        surface = self.solid.surface
        common: dict[str, Any] = {
            "friction": self.friction,
            "material": self.material,
            "temperature": self.temperature,
        }
        if surface is None:
            parts = tuple(each.part(np.zeros(3)) for each in self.parts)
            return ObjectSpec(shape=self.solid.shape, size=self.solid.size, parts=parts, **common)
        # the recipe's origin, where the fingers close, is not the middle of a cup with a handle
        middle = (surface.vertices.max(axis=0) + surface.vertices.min(axis=0)) / 2
        mesh, (x, y, _) = str(_file(surface)), middle.tolist()
        parts = tuple(each.part(-middle) for each in self.parts)
        return ObjectSpec(shape="mesh", mesh=mesh, position=(_zero(x), _zero(y)), parts=parts, **common)

    @property
    def grip_force(self) -> float:
        """N on each pad that holds it with a margin: GRIP_MARGIN times what Coulomb friction needs, LEAST_GRIP at
        least."""
        spec = self.spec()
        return max(LEAST_GRIP, GRIP_MARGIN * spec.weight * _GRAVITY / (2 * spec.sliding_friction))


@cache
def objects() -> Mapping[str, ObjectPreset]:
    """The library's objects by name, in the order of its table; read-only."""
    return load_objects(asset("objects.toml"))


def library_object(name: str) -> ObjectPreset:
    """The object of that name. Raises UnknownNameError with near names, and InvalidValueError for a file's name."""
    try:
        return objects()[name]
    except KeyError:
        if isinstance(name, str) and Path(name).suffix:
            raise InvalidValueError(
                f"{name!r} is the name of a file, not of an object: give ObjectSpec(shape='mesh', mesh={name!r}), or "
                "--mesh on the command line"
            ) from None
        raise unknown_name("object", name, objects()) from None


def load_objects(path: str | Path) -> Mapping[str, ObjectPreset]:
    """The objects of a TOML file by name, read-only; assets/objects.toml says how one is written. Raises
    InvalidValueError, which names the file and the object, for anything that does not fit."""
    table = read_toml(path).get("objects", {})
    try:
        return MappingProxyType({name: _preset(name, table) for name in table})
    except ThermograspError as error:
        raise InvalidValueError(f"{path}: {error}") from None


def _preset(name: str, table: Mapping[str, Any]) -> ObjectPreset:
    entry = _resolved(name, table, ())
    for key in ("about", "recipe", "material"):
        if not isinstance(entry.get(key), str):
            raise InvalidValueError(f'{name}: {key} is missing; give {key} = "..."')
    contents = entry.get("contents")
    try:
        preset = ObjectPreset(
            name,
            entry["about"],
            entry["recipe"],
            entry["material"],
            MappingProxyType({key: value for key, value in entry.items() if key not in _KEYS}),
            entry.get("temperature", ROOM),
            entry.get("mass"),
            entry.get("friction"),
            Contents(**contents) if contents else None,
            tuple(_part(**part) for part in entry.get("parts", ())),
        )
    except (ThermograspError, TypeError) as error:
        raise InvalidValueError(f"{name}: {error}") from None
    return preset


def _part(
    *, material: str, recipe: str, position: Sequence[float] = (0.0, 0.0, 0.0), **shape: Any
) -> PartPreset:
    return PartPreset(material, recipe, MappingProxyType(shape), tuple(position))


def _resolved(name: str, table: Mapping[str, Any], seen: tuple[str, ...]) -> dict[str, Any]:
    """The entry with what it is like filled in. seen: names that led here."""
    if name not in table or name in seen:
        raise InvalidValueError(f"{seen[-1]} is like {name!r}, which does not exist or is like itself")
    entry = dict(table[name])
    if "like" not in entry:
        return entry
    return _resolved(entry["like"], table, (*seen, name)) | entry


def _zero(value: float) -> float:
    """Rounded to a micrometre: a symmetric body stands at 0."""
    return round(float(value), 6) + 0.0


def _file(surface: Triangles) -> Path:
    """Of the surface in the cache, named by what is in it."""
    key = {"vertices": surface.vertices, "faces": surface.faces}
    return cached_file(key, ".ply", lambda path: _write(path, surface))


def _write(path: Path, surface: Triangles) -> None:
    import trimesh

    trimesh.Trimesh(*surface, process=False).export(path)
