"""The layered heat flux sensor of a fingertip and its presets."""

from __future__ import annotations

import json
import math
import os
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

from thermograsp.errors import InvalidValueError, positive, unknown_name
from thermograsp.files import write_text

from ...assets import asset
from .layers import Layer

_HEADER = (
    "Layers run from the thermostat side to the object side.",
    "Thickness m, conductivity W/(m K), density kg/m3, specific_heat J/(kg K), width m, seebeck V/K.",
)
_REACH = 2.0  # diffusion lengths within a step, up to which layers answer to a change at their back


@dataclass(frozen=True, slots=True)
class SensorStack:
    """A heat flux sensor between the thermostat and the touched object.

    layers: from the thermostat side to the object side. width: m, side of the square cross-section.
    sensed: index of the layer across which the temperature drop is measured.
    seebeck: V/K, voltage per kelvin of that drop. Sides are adiabatic.
    """

    name: str
    layers: tuple[Layer, ...]
    width: float
    sensed: int
    seebeck: float

    def __post_init__(self) -> None:
        if not self.layers:
            raise InvalidValueError(f"sensor {self.name!r} has no layers: give at least one")
        if not 0 <= self.sensed < len(self.layers):
            raise InvalidValueError(
                f"sensor {self.name!r}: sensed layer {self.sensed} is not one of 0 .. {len(self.layers) - 1}"
            )
        positive(f"{self.name}: width", self.width)
        positive(f"{self.name}: seebeck", self.seebeck)

    @property
    def face_area(self) -> float:
        """m2."""
        return self.width**2

    @property
    def thickness(self) -> float:
        """m."""
        return sum(layer.thickness for layer in self.layers)

    @property
    def heat_capacity(self) -> float:
        """J/K."""
        return self.face_area * sum(layer.thickness * layer.volumetric_heat_capacity for layer in self.layers)

    def answering(self, dt: float) -> float:
        """J/K: what it takes within dt s when its back is suddenly 1 K warmer, or somewhat more."""
        reached, depth = 0.0, 0.0
        for layer in self.layers:
            if depth > _REACH * math.sqrt(dt):
                break
            reached = max(reached, math.sqrt(layer.conductivity * layer.volumetric_heat_capacity))
            depth += layer.thickness * math.sqrt(layer.volumetric_heat_capacity / layer.conductivity)
        return 2 / math.sqrt(math.pi) * reached * math.sqrt(dt) * self.face_area


@cache
def sensors() -> Mapping[str, SensorStack]:
    """Presets of assets/sensors.toml by name, read-only."""
    return load_sensors(asset("sensors.toml"))


def sensor(name: str | os.PathLike[str] | SensorStack) -> SensorStack:
    """The preset of that name, the one sensor of a file (a path, or a name that ends in .toml), or the stack itself.

    Raises UnknownNameError with near names, and InvalidValueError for a file that does not hold one sensor.
    """
    if isinstance(name, SensorStack):
        return name
    if isinstance(name, os.PathLike) or (isinstance(name, str) and name.endswith(".toml")):
        found = load_sensors(name)
        if len(found) != 1:
            raise InvalidValueError(
                f"{name} holds {len(found)} sensors, {', '.join(found)}: keep one in the file"
            )
        return next(iter(found.values()))
    try:
        return sensors()[name]
    except (KeyError, TypeError):  # a list is no name at all
        raise unknown_name("sensor", name, sensors()) from None


def load_sensors(path: str | os.PathLike[str]) -> Mapping[str, SensorStack]:
    """The sensors of a TOML file by name, read-only, in the form of assets/sensors.toml. Raises InvalidValueError,
    which names the file, for anything that does not fit."""
    try:
        entries = tomllib.loads(Path(path).read_text(encoding="utf-8"))["sensors"]
        return MappingProxyType({name: _stack(name, entry) for name, entry in entries.items()})
    except OSError as error:
        raise InvalidValueError(f"cannot read {path}: {error.strerror}") from error
    except KeyError as error:
        raise InvalidValueError(
            f"{path}: {error} is missing; see assets/sensors.toml for the form"
        ) from error
    except (ValueError, TypeError, AttributeError) as error:
        raise InvalidValueError(f"{path}: {error}; see assets/sensors.toml for the form") from error


def write_sensor(path: str | os.PathLike[str], stack: SensorStack, notes: Sequence[str] = ()) -> None:
    """A file of one sensor that `sensor` loads, written whole or not at all. notes: lines of a comment. Raises
    InvalidValueError where it cannot be written."""
    layers = [
        "    { " + ", ".join(f"{f.name} = {_toml(getattr(layer, f.name))}" for f in fields(Layer)) + " },"
        for layer in stack.layers
    ]
    lines = [
        *(f"# {note}".rstrip() for note in (*notes, *_HEADER)),
        f"[sensors.{_toml(stack.name)}]",
        *(f"{name} = {_toml(getattr(stack, name))}" for name in ("width", "sensed", "seebeck")),
        "layers = [",
        *layers,
        "]",
    ]
    write_text(path, "\n".join(lines) + "\n")


def _stack(name: str, entry: dict[str, Any]) -> SensorStack:
    for key in entry:
        if key not in ("layers", "width", "sensed", "seebeck", "touch"):
            raise InvalidValueError(f"sensor {name!r} has an unknown entry {key!r}")
    layers = tuple(Layer(**layer) for layer in entry["layers"])
    return SensorStack(name, layers, width=entry["width"], sensed=entry["sensed"], seebeck=entry["seebeck"])


def _toml(value: str | float) -> str:
    """JSON's strings and numbers are TOML's."""
    return json.dumps(value)
