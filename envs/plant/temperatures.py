"""Which temperatures may come of what is drawn: the largest difference, and none that nothing can have."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from thermograsp.errors import celsius

from .randomization import Cause, ObjectTemperature, ThermostatError


def most_difference(
    randomize: Sequence[Cause], sensors: Sequence[float], moving: Sequence[float], still: Sequence[float] = ()
) -> float:
    """K between a sensor and what is around it, at most. sensors: °C of either. moving: °C of the object and of what is
    drawn with it. still: °C of what is not drawn."""
    shifts, errors = [0.0], [0.0]
    for cause in randomize:
        if isinstance(cause, ObjectTemperature):
            shifts += [cause.low, cause.high]
        elif isinstance(cause, ThermostatError):
            errors += [cause.low, cause.high]
    around = [*(start + shift for start in moving for shift in shifts), *still]
    return max(abs(sensor + error - other) for sensor in sensors for error in errors for other in around)


def check_drawn_temperatures(
    randomize: Sequence[Cause], objects: Iterable[float], thermostats: Iterable[float]
) -> None:
    """Raises InvalidValueError for a draw that would make an object or a thermostat, at these °C before it, too cold or
    too hot to be."""
    starts = {ObjectTemperature: set(objects), ThermostatError: tuple(thermostats)}
    for cause in randomize:
        for start in starts.get(type(cause), ()):
            for shift in (cause.low, cause.high):  # pyright: ignore[reportAttributeAccessIssue]
                celsius(f"{start:g} °C with randomize's {cause}", start + shift)
