"""What the fingertips of a simulated plant are made of: sensor, skin, and the pad around the sensor.

Each raises UnknownNameError for a name that is none, and InvalidValueError for what cannot be together.
"""

from __future__ import annotations

from collections.abc import Iterable

from thermograsp.errors import InvalidValueError

from ...thermal import Material, Mode, SensorStack, Skin, Surround
from ...thermal.matter import USUAL_SKIN
from ...thermal.matter import skin as named_skin
from ...thermal.matter import surround as named_surround
from ...thermal.stack import HeatedStack, any_sensor, highest_voltage
from ..bodies import ObjectSpec
from ..footprint import PAD
from ..limits import MOST_VOLTAGE

AUTO = "auto"
"""A skin where one is needed, heat that knows where it enters where that matters; see SimulationConfig."""


def usual_skin(mode: Mode, sensor: str | SensorStack | HeatedStack, plain_boxes: bool) -> Skin | None:
    """What the fingertips wear where "auto" is asked for. plain_boxes: whether all objects are boxes whose material is
    SimulationConfig's `material`."""
    if plain_boxes or mode == "O" or isinstance(any_sensor(sensor), HeatedStack):
        return None
    return named_skin(USUAL_SKIN)


def pad_around(
    surround: str | Material | Surround | None, mode: Mode, stack: SensorStack | HeatedStack
) -> Surround | None:
    """The pad around the sensor, with its depth."""
    found = named_surround(surround, mode)
    if found is None:
        return None
    if isinstance(stack, HeatedStack):
        raise InvalidValueError(
            f"sensor {stack.name!r} has a heater of its own, which goes with no surround: leave surround out"
        )
    if found.width > PAD.width * (1 + 1e-9):
        raise InvalidValueError(
            f"surround is {found.width:g} m wide, and the pad {PAD.width:g} m: give Surround(width=) at most that"
        )
    return found.around(stack)


def check_touched_by_pad(surround: object, shapes: Iterable[ObjectSpec]) -> None:
    """The heat of a pad around the sensor is known on objects of one material."""
    for shape in shapes:
        if shape.parts or shape.reservoir is not None:
            what = "parts" if shape.parts else "contents"
            raise InvalidValueError(
                f"surround {surround!r}: object {shape.name!r} has {what}, and the heat of a pad around the "
                "sensor is known on objects of one material: leave surround out, or give these"
            )


def checked_heated(
    stack: SensorStack | HeatedStack, *, on_thermostat: bool, mapped: bool
) -> HeatedStack | None:
    """The sensor, where it has a heater of its own. on_thermostat: whether something else holds its temperature.
    mapped: whether the temperature over its face is mapped."""
    if not isinstance(stack, HeatedStack):
        return None
    if on_thermostat:
        raise InvalidValueError(
            f"sensor {stack.name!r} has a heater of its own: leave thermostat out, and mode at 'T'"
        )
    if mapped:
        raise InvalidValueError(
            f"sensor {stack.name!r}: face_temperature maps an element on a thermostat; leave it out"
        )
    if highest_voltage(stack) > MOST_VOLTAGE:
        raise InvalidValueError(
            f"sensor {stack.name!r}: its divider sends up to {highest_voltage(stack):.3g} V, and observations hold "
            f"{MOST_VOLTAGE:g} V: give the divider a supply of "
            f"{stack.divider.supply * MOST_VOLTAGE / highest_voltage(stack):.2g} V"
        )
    return stack
