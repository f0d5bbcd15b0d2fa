"""The layered heat flux sensor of a fingertip and its presets."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache

from thermograsp.errors import InvalidValueError, positive, unknown_name

from ..assets import asset


@dataclass(frozen=True, slots=True)
class Layer:
    """One homogeneous layer of a sensor.

    thickness: m. conductivity: W/(m K). density: kg/m3. specific_heat: J/(kg K).
    Raises InvalidValueError when one of them is not a positive finite number.
    """

    name: str
    thickness: float
    conductivity: float
    density: float
    specific_heat: float

    def __post_init__(self) -> None:
        for field in ("thickness", "conductivity", "density", "specific_heat"):
            positive(f"{self.name}: {field}", getattr(self, field))

    @property
    def volumetric_heat_capacity(self) -> float:
        """J/(m3 K)."""
        return self.density * self.specific_heat


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


@cache
def sensors() -> dict[str, SensorStack]:
    """Presets of assets/sensors.toml by name."""
    table = tomllib.loads(asset("sensors.toml").read_text(encoding="utf-8"))
    return {
        name: SensorStack(
            name=name,
            layers=tuple(Layer(**layer) for layer in entry["layers"]),
            width=entry["width"],
            sensed=entry["sensed"],
            seebeck=entry["seebeck"],
        )
        for name, entry in table["sensors"].items()
    }


def sensor(name: str | SensorStack) -> SensorStack:
    """The preset of that name, or the stack itself. Raises UnknownNameError with near names."""
    if isinstance(name, SensorStack):
        return name
    try:
        return sensors()[name]
    except KeyError:
        raise unknown_name("sensor", name, sensors()) from None
