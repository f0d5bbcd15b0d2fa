"""What a visitor chooses: an episode's object and temperatures, which need a new scene, and what acts while it runs.

Both are read from messages of the outside world: every name, type and range is checked.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any

from thermograsp.envs import (
    STAKES,
    ObjectSpec,
    library_object,
    objects,
)
from thermograsp.envs.limits import MAX_FORCE, MAX_HEIGHT, MAX_OPENING
from thermograsp.errors import InvalidValueError, finite, unknown_name
from thermograsp.thermal import Material, Mode, materials

MODES: tuple[Mode, ...] = ("T", "O")
SHAPES = ("box", "cylinder", "sphere", "heavy box", "mesh")
DRIVERS = ("scripted", "sliders", "feeling", "trained")
SPEEDS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0)
MOST_MATERIALS = 2  # side by side


@dataclass(frozen=True, slots=True)
class Range:
    """What a number may be, and the step of its slider. unit: as it is shown. scale: shown units in one of SI. log:
    whether equal ways on the slider are equal factors."""

    low: float
    high: float
    step: float
    unit: str
    scale: float = 1.0
    log: bool = False


RANGES: Mapping[str, Range] = {
    "width": Range(0.015, 0.07, 0.005, "mm", 1e3),
    "object_temperature": Range(-10.0, 60.0, 1.0, "°C"),
    "ambient": Range(-10.0, 60.0, 1.0, "°C"),
    "thermostat": Range(10.0, 50.0, 1.0, "°C"),
    "roughness": Range(0.1, 10.0, 0.1, "×", log=True),
    "tolerance": Range(0.01, 1.0, 0.01, "K", log=True),
    "force": Range(1.0, MAX_FORCE, 0.5, "N"),
    "opening": Range(0.0, MAX_OPENING, 0.001, "mm", 1e3),
    "height": Range(0.0, MAX_HEIGHT, 0.005, "mm", 1e3),
}
_OF_SIMULATION = ("material", "other", "shape", "width", "roughness", "ambient", "tolerance")
_MOST_SEED = 2**31 - 1


@dataclass(frozen=True, slots=True)
class Stock:
    """What visitors may choose from besides the package's own. materials: by name. mesh: an object of a file, or None.
    network: a trained policy's file, or None for the package's. recording: a CSV file
    to play instead of simulating. plant: URL of a real gripper to drive instead. Picklable."""

    materials: Mapping[str, Material] = field(default_factory=lambda: dict(materials()))
    mesh: ObjectSpec | None = None
    network: str | None = None
    recording: str | None = None
    plant: str | None = None

    @property
    def drivers(self) -> tuple[str, ...]:
        """The drivers that can act here: a real gripper has no arm that lifts."""
        return DRIVERS if self.plant is None else DRIVERS[:2]

    @property
    def fixed(self) -> tuple[str, ...]:
        """Controls of the page that do nothing here."""
        if self.recording is not None:
            return (*_OF_SIMULATION, "driver", "force", "opening", "height")
        return (*_OF_SIMULATION, "height", "play", "step", "speed") if self.plant is not None else ()

    @property
    def shapes(self) -> tuple[str, ...]:
        """The shapes of objects."""
        return (*(SHAPES if self.mesh is not None else SHAPES[:-1]), *objects())


@dataclass(frozen=True, slots=True)
class Choices:
    """An episode. materials: one name, or two to set side by side. shape: one of SHAPES, or an everyday object, which
    has a material and a temperature of its own. width: m, between the fingers, of what has no size of its own. ambient:
    of the air. Temperatures: °C. roughness: a factor on the object's. tolerance: K of the temperature drop. seed: of
    the object's place and the noise."""

    materials: tuple[str, ...] = ("glass",)
    mode: Mode = "T"
    shape: str = "box"
    width: float = 0.04
    object_temperature: float = 24.0
    ambient: float = 24.0
    thermostat: float = 36.0
    roughness: float = 1.0
    tolerance: float = 0.05
    seed: int = 0

    def changed(self, message: Mapping[str, Any], stock: Stock) -> Choices:
        """With the message's fields in place of these. Raises InvalidValueError and UnknownNameError."""
        known = {one.name: one for one in fields(self)}
        new: dict[str, Any] = {}
        for name, value in message.items():
            if name not in known:
                raise unknown_name("choice", name, known)
            new[name] = _READ[name](value, stock) if name in _READ else number(name, value)
        return replace(self, **new)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of what is grasped, one or two side by side."""
        return (self.shape,) if self.everyday else self.materials

    @property
    def everyday(self) -> bool:
        """Whether it is an object of the library, with a material and a temperature of its own."""
        return self.shape in objects()

    def object(self, stock: Stock) -> ObjectSpec:
        """The shape. Density and friction are the material's."""
        if self.everyday:
            return library_object(self.shape).spec()
        if self.shape == "mesh" and stock.mesh is not None:
            return stock.mesh
        if self.shape == "heavy box":
            return STAKES["objects"]
        return ObjectSpec(shape=self.shape, size=(self.width,) * 3)  # pyright: ignore[reportArgumentType]

    @property
    def colours(self) -> tuple[float, float]:
        """°C, the range of the colours: a kelvin more than what occurs."""
        around = (self.object_temperature, self.ambient, self.thermostat)
        return min(around) - 1.0, max(around) + 1.0

    def message(self) -> dict[str, Any]:
        """For the page."""
        return asdict(self)


@dataclass(frozen=True, slots=True)
class Controls:
    """What can change while an episode runs. driver: one of DRIVERS. force: N, the gripper's limit. opening, height: m,
    targets of the driver "sliders". playing: whether time passes, `speed` times as fast as the wall's."""

    driver: str = "scripted"
    force: float = 10.0
    opening: float = MAX_OPENING
    height: float = 0.0
    playing: bool = True
    speed: float = 1.0

    def changed(self, message: Mapping[str, Any]) -> Controls:
        """With the message's fields in place of these. Raises InvalidValueError and UnknownNameError."""
        known = {one.name for one in fields(self)}
        new: dict[str, Any] = {}
        for name, value in message.items():
            if name not in known:
                raise unknown_name("control", name, known)
            if name == "driver":
                new[name] = one_of("driver", value, DRIVERS)
            elif name == "playing":
                if not isinstance(value, bool):
                    raise InvalidValueError(f"playing must be true or false, got {value!r}")
                new[name] = value
            elif name == "speed":
                if value not in SPEEDS:
                    raise InvalidValueError(f"speed must be one of {SPEEDS}, got {value!r}")
                new[name] = float(value)
            else:
                new[name] = number(name, value)
        return replace(self, **new)

    def message(self) -> dict[str, Any]:
        """For the page."""
        return asdict(self)


def number(name: str, value: object) -> float:
    """The value, in SI units. Raises InvalidValueError for what is no number or not within RANGES[name]."""
    allowed = RANGES[name]
    given = finite(name, value)
    if not allowed.low <= given <= allowed.high:
        raise InvalidValueError(f"{name} must be {allowed.low:g} to {allowed.high:g}, got {given:g}")
    return given


def one_of(kind: str, value: object, known: tuple[str, ...]) -> str:
    """The value. Raises UnknownNameError."""
    if not isinstance(value, str) or value not in known:
        raise unknown_name(kind, value, known)
    return value


def _materials(value: object, stock: Stock) -> tuple[str, ...]:
    if not isinstance(value, list | tuple) or not 1 <= len(value) <= MOST_MATERIALS:
        raise InvalidValueError(f"materials must be a list of 1 to {MOST_MATERIALS} names, got {value!r}")
    return tuple(one_of("material", name, tuple(stock.materials)) for name in value)


def _seed(value: object, _: Stock) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= _MOST_SEED:
        raise InvalidValueError(f"seed must be a whole number from 0 to {_MOST_SEED}, got {value!r}")
    return value


_READ: Mapping[str, Any] = {
    "materials": _materials,
    "mode": lambda value, _: one_of("mode", value, MODES),
    "shape": lambda value, stock: one_of("shape", value, stock.shapes),
    "seed": _seed,
}
