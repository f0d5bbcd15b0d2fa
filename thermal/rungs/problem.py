"""One press of the sensor on an object: what every rung of the ladder is asked, and what it answers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from thermograsp.errors import InvalidValueError, celsius, length, non_negative, positive

from ..matter import Material, Mode, SensorStack, Shape, Surround
from ..readout import Thermostat
from ..stack import HeatedStack

Conductance = float | Callable[[float], float]


@dataclass(frozen=True, slots=True)
class _Checked:
    """A function of time in s whose values are finite numbers, 0 or above; raises InvalidValueError for others."""

    name: str
    unit: str
    function: Callable[[float], float]

    def __call__(self, time: float) -> float:
        value = self.function(float(time))
        # libraries' own numbers, which have no axis, count as such
        number = value.item() if np.shape(value) == () and hasattr(value, "item") else value  # pyright: ignore[reportAttributeAccessIssue]
        return non_negative(f"{self.name} at t = {time:g} s ({self.unit})", number)


def checked(name: str, given: Conductance, unit: str = "W/(m2 K)") -> Conductance:
    """A number as it is, a function with its values checked when it is asked. Raises InvalidValueError."""
    if callable(given):
        return _Checked(name, unit, given)
    return non_negative(f"{name} ({unit})", given)


@dataclass(frozen=True, slots=True)
class PressProblem:
    """A patch in the middle of an object's face pressed on the sensor, both bodies uniform at first.

    mode: "T", the element sits on the thermostat and starts at sensor_temperature, contact opens between
    element and object; "O", the element is bonded to the object and starts at object_temperature, contact
    opens between thermostat and element. conductance: W/(m2 K) of that contact, a number or a function of
    time in s. area: m2 of the contact, at most the sensor's face. shape: of the contact patch ("round": the
    sensor's cross-section is round too, of the same area as the square one). object_size: (width, depth,
    thickness) m, the patch in the middle of a width x depth face. air: W/(m2 K) on the object's free faces,
    whose ambient is object_temperature. Temperatures in °C. opposite: W/(m2 K), a second fingertip of the
    same kind on the opposite face, None for none; the curves are the first one's. thermostat: one of finite power
    that is settled at sensor_temperature at first, None for an ideal one. heated: a sensor with a heater of its own in
    place of a thermostat, whose element `stack` then is. force: N on it, a number or a function of time in s. surround:
    around the element, with its depth; area is then of all of its front that touches. beside: W/(m2 K) of the
    surround's contact while the face's conducts, None for as much as the face's.
    """

    stack: SensorStack
    material: Material
    mode: Mode
    conductance: Conductance
    area: float
    shape: Shape
    object_size: tuple[float, float, float]
    air: float
    sensor_temperature: float
    object_temperature: float
    opposite: Conductance | None = None
    thermostat: Thermostat | None = None
    heated: HeatedStack | None = None
    force: Conductance = np.inf
    surround: Surround | None = None
    beside: float | None = None

    def __post_init__(self) -> None:
        if self.mode not in ("T", "O"):
            raise InvalidValueError(f"mode must be 'T' or 'O', got {self.mode!r}")
        if self.shape not in ("square", "round"):
            raise InvalidValueError(f"shape must be 'square' or 'round', got {self.shape!r}")
        object.__setattr__(self, "conductance", checked("conductance", self.conductance))
        if self.opposite is not None:
            object.__setattr__(self, "opposite", checked("opposite", self.opposite))
        positive("area (m2)", self.area)
        if self.surround is not None:
            self._check_surround()
        elif self.area > self.stack.face_area * (1 + 1e-9):
            raise InvalidValueError(
                f"area {self.area:g} m2 is more than the face of sensor {self.stack.name!r}, "
                f"{self.stack.face_area:g} m2: give at most that"
            )
        if len(self.object_size) != 3:
            raise InvalidValueError(
                f"object_size must be (width, depth, thickness) in m, got {self.object_size!r}"
            )
        for axis, size in zip(("width", "depth", "thickness"), self.object_size, strict=True):
            length(f"object_size: {axis} (m)", size)
        side = self.stack.width
        if min(self.object_size[:2]) < side * (1 - 1e-9):
            raise InvalidValueError(
                f"the object's face {self.object_size[0]:g} x {self.object_size[1]:g} m is smaller than the sensor's, "
                f"{side:g} m square: give a larger object_size or a smaller sensor"
            )
        non_negative("air (W/(m2 K))", self.air)
        if self.heated is not None and (self.thermostat is not None or self.mode == "O"):
            raise InvalidValueError(
                f"sensor {self.heated.name!r} has a heater of its own: leave thermostat out, and mode at 'T'"
            )
        celsius("sensor_temperature (°C)", self.sensor_temperature)
        celsius("object_temperature (°C)", self.object_temperature)

    def _check_surround(self) -> None:
        if self.mode == "O" or self.shape == "round":
            raise InvalidValueError(
                f"a surround is square, around the element of mode 'T': with mode {self.mode!r} and shape "
                f"{self.shape!r} leave it out"
            )
        if self.heated is not None or self.thermostat is not None:
            raise InvalidValueError(
                "a surround sits on an ideal thermostat: leave the surround out, or the thermostat of finite power and "
                "the sensor with a heater of its own"
            )

    @property
    def plain(self) -> bool:
        """Whether one fingertip without a surround presses, on an ideal thermostat."""
        return (
            self.opposite is None
            and self.thermostat is None
            and self.heated is None
            and self.surround is None
        )

    @property
    def temperature_difference(self) -> float:
        """K, sensor less object at first."""
        return self.sensor_temperature - self.object_temperature


@dataclass(frozen=True, slots=True)
class PressCurves:
    """What a rung answers at the times asked for, shape (n,) unless stated.

    temperature_drop: K, over the sensed layer, mean over the face, thermostat side less object side.
    heat_flow: W through the opening contact (T: element to object, O: thermostat to element).
    sensor_surface, object_surface: °C, means over the contact on its sensor side and its object side
    (O mode: thermostat and element). stored_heat: (n, 2) J gained by the sensor's element and by the object.
    A quantity that a rung cannot give is NaN. reading: °C at a heated sensor's readout, None of other sensors.
    """

    temperature_drop: np.ndarray
    heat_flow: np.ndarray
    sensor_surface: np.ndarray
    object_surface: np.ndarray
    stored_heat: np.ndarray
    reading: np.ndarray | None = None
