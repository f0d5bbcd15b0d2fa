"""A heated sensor as the fit of sensors takes it: touches in kelvins of fall.

The voltage of a divider is not in proportion to temperature, but its temperature is known; so voltages become what a
sensor of the divider's slope would send of the fall below the reading before the touch, and that slope is held.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from thermograsp.errors import InvalidValueError

from ..matter import SensorStack
from ..stack import HeatedCore, HeatedStack, fallen, heated_core, require_linear
from .known_touch import KnownTouch

_STEP = 0.01  # s; a fit takes nothing of it


def fitted_core(sensor: HeatedStack) -> HeatedCore:
    """The sensor's core. Raises InvalidValueError for a sensor that a fit cannot serve, with the reason."""
    require_linear(sensor, "fit_sensor")
    core = heated_core(sensor, _STEP)
    if core.readout is not None:
        raise InvalidValueError(
            f"sensor {sensor.name!r} is read at its heater or behind it: fit_sensor fits the layer between heater and "
            "readout, and there is none; use thermal.measured.fit_stack"
        )
    if sensor.backing.loss:
        raise InvalidValueError(
            f"sensor {sensor.name!r} loses heat behind ({sensor.backing.loss:g} W/(m2 K)), and no touch of "
            "fit_sensor says how warm it is there; use thermal.measured.fit_stack, or leave the loss out for touches "
            "of some seconds"
        )
    if sensor.layers[-len(core.element.layers) :] != core.element.layers:
        raise InvalidValueError(
            f"sensor {sensor.name!r}: its heater or readout lies inside a layer, which fit_sensor does not divide; "
            "make it two layers"
        )
    return core


def as_drops(touches: Sequence[KnownTouch], core: HeatedCore) -> list[KnownTouch]:
    """The touches with the voltages that the fall of their readings would make in an element of the core's slope."""
    found = []
    for touch in touches:
        below_zero = fallen(core.sensor, touch.voltage, 0.0)
        fall = below_zero - below_zero[touch.t < 0].mean()
        found.append(replace(touch, voltage=core.element.seebeck * fall))
    return found


def with_element(sensor: HeatedStack, element: SensorStack) -> HeatedStack:
    """The sensor with its front layers those of a fitted element."""
    count = len(sensor.layers) - len(element.layers)
    return replace(sensor, layers=(*sensor.layers[:count], *element.layers))
