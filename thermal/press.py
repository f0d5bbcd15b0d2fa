"""One press of the sensor on an object, by any rung of the ladder."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermograsp.errors import InvalidValueError, positive

from .ladder import Rung, solve_rung
from .layers import SensorStack
from .layers import sensor as sensor_preset
from .materials import Material
from .materials import material as named_material
from .problem import Conductance, Mode, PressCurves, PressProblem, Shape
from .thermostat import Thermostat

_MOST_SAMPLES = 10_000_000


@dataclass(frozen=True, slots=True)
class Press:
    """What the sensor and the object do after a touch at t = 0.

    t: (n,) s. temperature_drop: (n,) K over the element, mean over its face. voltage: (n,) V, the Seebeck coefficient
    times the drop, before amplifier and ADC. heat_flow: (n,) W through the opening contact (T: element to object, O:
    thermostat to element). sensor_surface, object_surface: (n,) °C, means on the two sides of that contact.
    stored_heat: (n, 2) J gained by the sensor's element and by the object. rung: the model that was used, its orders
    and error bound. A quantity that the rung does not know is NaN.
    """

    t: np.ndarray
    temperature_drop: np.ndarray
    voltage: np.ndarray
    heat_flow: np.ndarray
    sensor_surface: np.ndarray
    object_surface: np.ndarray
    stored_heat: np.ndarray
    rung: Rung


def press(
    material: str | Material,
    *,
    mode: Mode = "T",
    sensor: str | SensorStack = "seed",
    conductance: Conductance = 1e4,
    area: float = 81e-6,
    shape: Shape = "square",
    object_size: tuple[float, float, float] = (0.04, 0.04, 0.01),
    air: float = 0.0,
    sensor_temperature: float = 36.0,
    object_temperature: float = 24.0,
    seconds: float = 10.0,
    dt: float = 0.02,
    tolerance: float = 0.05,
    rung: str | Rung = "auto",
    opposite: Conductance | None = None,
    thermostat: Thermostat | None = None,
    cache: bool = True,
) -> Press:
    """Presses the sensor on the middle of a face of an object, both uniform at first.

    material: a name of thermal.materials() or a Material. mode: "T" or "O". sensor: a preset's name, a .toml file of
    one sensor, or a SensorStack. conductance: W/(m2 K) of the contact, a number or a function of time in s (0 = apart).
    area: m2 of the contact, at most the sensor's face. shape: "square" or "round". object_size: (width, depth,
    thickness) m. air: W/(m2 K) on the object's free faces. Temperatures in °C. seconds, dt: samples at 0, dt, 2 dt, ...
    up to seconds. tolerance: K of temperature drop from 0.05 s on, which rung="auto" (and "network") keeps. rung: a
    name of thermal.RUNGS, "auto", "network:ORDERS" as a Rung prints itself, or a Rung. opposite: conductance of a
    second fingertip of the same kind on the opposite face, None for none; the curves are the first one's. thermostat:
    one of finite power, at sensor_temperature at first, None for an ideal one. cache: keep networks on disk.

    Raises UnknownNameError for names and InvalidValueError for values that make no sense, or that the rung cannot do.
    """
    problem = PressProblem(
        stack=sensor_preset(sensor),
        material=named_material(material),
        mode=mode,
        conductance=conductance,
        area=area,
        shape=shape,
        object_size=tuple(object_size),  # pyright: ignore[reportArgumentType]
        air=air,
        sensor_temperature=sensor_temperature,
        object_temperature=object_temperature,
        opposite=opposite,
        thermostat=thermostat,
    )
    positive("tolerance (K)", tolerance)
    t = sample_times(seconds, dt)
    used, curves = solve_rung(str(rung), problem, t, tolerance, cache)
    return as_felt(problem, t, curves, used)


def sample_times(seconds: float, dt: float) -> np.ndarray:
    """0, dt, 2 dt, ... up to seconds. Raises InvalidValueError for values that make no sense."""
    positive("dt (s)", dt)
    positive("seconds", seconds)
    count = int(np.floor(seconds / dt * (1 + 1e-12))) + 1
    if count > _MOST_SAMPLES:
        raise InvalidValueError(f"{seconds:g} s at dt {dt:g} s are {count} samples: give a larger dt")
    return np.arange(count) * dt


def as_felt(problem: PressProblem, t: np.ndarray, curves: PressCurves, rung: Rung) -> Press:
    """A rung's curves with the sensor's voltage."""
    return Press(
        t=t,
        temperature_drop=curves.temperature_drop,
        voltage=problem.stack.seebeck * curves.temperature_drop,
        heat_flow=curves.heat_flow,
        sensor_surface=curves.sensor_surface,
        object_surface=curves.object_surface,
        stored_heat=curves.stored_heat,
        rung=rung,
    )
