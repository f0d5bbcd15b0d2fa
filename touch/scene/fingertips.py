"""Fingertips as they are named, and their pads as they are found."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from thermograsp.errors import InvalidValueError, celsius, length, numbers

from ...thermal import Material, Pad, SensorStack, Skin, Surface, Surround, Thermostat
from ...thermal.contact import NARROW, touching
from ...thermal.stack import HeatedStack

_LEANING = 10.0  # degrees of a straight fingertip, beyond which its sensor's face is off what it touches


@dataclass(frozen=True, slots=True)
class Fingertip:
    """A fingertip that feels heat. name: of a geom, a site or a body. sensor: a preset's name, a .toml file or a
    SensorStack, or a HeatedStack, whose heater follows its own law; None for a bare thermostat, which touches elements
    that are glued on objects (O mode). temperature: °C of its thermostat, or of a heated sensor before anything is
    touched. thermostat: one of finite power, whose setpoint is that temperature; None for one that stays there. skin:
    over the sensor's face, a name of thermal.SKINS or a Skin, None for bare alumina. Heat passes it, the
    contact's conductance is its own, and bodies press its springs; bare, what is curved touches a rigid face.
    surround: the pad around the sensor, which gives heat to the sensor's sides and to objects: its material by name or
    a Material, as wide as a square of the pad's area, or a Surround that is no wider; None for a sensor by itself. A
    fingertip with one is flat and sits on an ideal thermostat.

    The pad is the largest flat face of the geom or of the body's geoms that looks at the other fingertips of its hand;
    where these are more than 25 degrees off it, the way in which the fingertip's own joint closes it; or at the objects
    where there is one fingertip or no such face. Of a round geom it is where that direction leaves it, and as curved as
    that is there. A site's pad lies in its y and z and looks along its x. normal (3,), in the frame of the body that
    carries it: where the pad looks, in place of these; up to 20 degrees off a capsule's side that is the pad, and its
    round end beyond. With position (3,) m too the pad is flat and there. size: (2,) m."""

    name: str
    position: tuple[float, float, float] | None = None
    normal: tuple[float, float, float] | None = None
    size: tuple[float, float] | None = None
    sensor: str | SensorStack | HeatedStack | None = "seed"
    temperature: float = 36.0
    thermostat: Thermostat | None = None
    skin: str | Skin | None = None
    surround: str | Material | Surround | None = None

    def __post_init__(self) -> None:
        celsius(f"fingertip {self.name!r}: temperature (°C)", self.temperature)
        if self.surround is not None:
            for value, why in (
                (self.thermostat is not None, "a thermostat of finite power: leave thermostat out"),
                (
                    self.sensor is None,
                    "no sensor (sensor=None), around which it could be: leave surround out",
                ),
                (
                    isinstance(self.sensor, HeatedStack),
                    "a sensor with a heater of its own: leave surround out",
                ),
            ):
                if value:
                    raise InvalidValueError(f"fingertip {self.name!r}: no pad (surround) goes with {why}")
        if self.position is not None and self.normal is None:
            raise InvalidValueError(
                f"fingertip {self.name!r}: a position needs the pad's normal: give normal=(x, y, z)"
            )
        for field, count in (("position", 3), ("normal", 3), ("size", 2)):
            value = getattr(self, field)
            if value is None:
                continue
            numbers(f"fingertip {self.name!r}: {field}", value, count)
        for side in () if self.size is None else self.size:
            length(f"fingertip {self.name!r}: size (m)", side)
        if self.normal is not None and not np.linalg.norm(self.normal) > 0:
            raise InvalidValueError(f"fingertip {self.name!r}: its normal must not be zero")


@dataclass(frozen=True, slots=True, eq=False)
class PadPlace:
    """A fingertip's pad. label: the fingertip's. body: number of the MuJoCo body that carries it; geoms: whose contacts
    are its. position (3,) m and axes (3, 3), columns normal, y and z, in the body's frame. size (2,) m along y and z.
    stack: the sensor, or what of it is in front of its heater. temperature: °C of the thermostat or, at first, of the
    heater's place. heated: the whole sensor, where it has a heater of its own. bare: the thermostat
    itself, no sensor. glued: the number of the object that it is an element on, None for a fingertip. thermostat: of
    finite power, None for an ideal one. skin: over the sensor's face, whose last layer it is, None for a bare one.
    curvature: 1/m along y and z, of a pad that bulges out. surround: the pad around the sensor, with its depth."""

    label: str
    body: int
    geoms: tuple[int, ...]
    position: np.ndarray
    axes: np.ndarray
    size: np.ndarray
    stack: SensorStack
    temperature: float
    heated: HeatedStack | None = None
    bare: bool = False
    glued: int | None = None
    thermostat: Thermostat | None = None
    skin: Skin | None = None
    curvature: tuple[float, float] = (0.0, 0.0)
    surround: Surround | None = None

    @property
    def touched(self) -> tuple[int, ...]:
        """The geoms whose contacts are its."""
        return self.geoms

    @property
    def face(self) -> Surface:
        """What touches."""
        return touching(self.skin)

    @property
    def half_sides(self) -> np.ndarray:
        """(2,) m from its middle along y and z up to which contacts are on it. A capsule that leans touches with its
        round end, beyond its straight part."""
        (y, z), leaning = self.curvature, math.sin(math.radians(_LEANING))
        if y > 0 and z == 0:
            return self.size / 2 + (0.0, leaning / y)
        if z > 0 and y == 0:
            return self.size / 2 + (leaning / z, 0.0)
        return self.size / 2

    @property
    def silicone(self) -> Pad:
        """The pad without its skin, as wide as a square of its area. A sensor's face that is wider than a side of the
        pad touches with what the pad bears of it, a square of that area in its middle."""
        borne = self.size if self.bare else np.minimum(self.stack.width, self.size)
        face, whole = math.sqrt(borne.prod()), self.stack.width
        sensor = whole if face < whole * NARROW else None
        return Pad(width=math.sqrt(self.size.prod()), face=face, sensor=sensor)
