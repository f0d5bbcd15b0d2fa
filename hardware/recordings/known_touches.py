"""The first touch of a recording, of a known object, as thermal.fit_sensor takes it."""

from __future__ import annotations

import numpy as np

from thermograsp.errors import InvalidValueError

from ...thermal import KnownTouch, Material, material
from ..protocol import Flag, Samples

SIDES = ("left", "right")
_TOUCHING = 0.5  # N
_HORIZON = 5.0  # s of a touch that are used
_BEFORE = 2.0  # s before it
_OF = (
    Flag.SATURATED_LEFT
    | Flag.OPEN_LEFT
    | Flag.OFF_SETPOINT_LEFT
    | Flag.NO_VOLTAGE_LEFT
    | Flag.NO_FORCE_LEFT
    | Flag.LATCHED_OFF,
    Flag.SATURATED_RIGHT
    | Flag.OPEN_RIGHT
    | Flag.OFF_SETPOINT_RIGHT
    | Flag.NO_VOLTAGE_RIGHT
    | Flag.NO_FORCE_RIGHT
    | Flag.LATCHED_OFF,
)


def known_touch(
    samples: Samples,
    of: str | Material,
    *,
    name: str = "recording",
    fingertip: int = 0,
    object_temperature: float = 24.0,
    object_size: tuple[float, float, float] = (0.04, 0.04, 0.01),
) -> KnownTouch:
    """The first touch in the samples, from when the normal force of the fingertip (0 left, 1 right) passes 0.5 N to
    its release, 5 s at most, with up to 2 s before it. of: the material of the object, which must be fresh,
    object_temperature °C and object_size m. The other fingertip counts as opposite where it presses as well.

    The touch lies between two samples, evenly: the more samples a second, the better a delay is told. Times are the
    device's. Raises InvalidValueError where there is no touch that can be used, SensorFaultError for faults of the
    fingertip, UnknownNameError for the material.
    """
    pressed = samples.force[:, :, 0] > _TOUCHING
    touching = pressed[:, fingertip]
    risen = np.flatnonzero(touching[1:] & ~touching[:-1]) + 1
    if not len(risen):
        raise InvalidValueError(
            f"{name}: no touch of the {SIDES[fingertip]} fingertip: its normal force never rises through "
            f"{_TOUCHING:g} N"
        )
    first = int(risen[0])
    time = samples.device_time
    touch = (time[first - 1] + time[first]) / 2
    released = np.flatnonzero(~touching[first:])
    end = first + int(released[0]) if len(released) else len(touching)
    end = first + int(np.searchsorted(time[first:end], touch + _HORIZON))
    begin = int(np.searchsorted(time[:first], touch - _BEFORE))
    used = samples[begin:end]
    used.require_healthy(but=~_OF[fingertip])
    before = slice(0, first - begin)
    return KnownTouch(
        name=name,
        t=used.device_time - touch,
        voltage=used.voltage[:, fingertip],
        material=material(of),
        difference=float(used.thermostat[before, fingertip].mean()) - object_temperature,
        object_size=object_size,
        fingertips=2 if pressed[first:end, 1 - fingertip].any() else 1,
        touch_error=float(time[first] - time[first - 1]) / np.sqrt(12),
    )
