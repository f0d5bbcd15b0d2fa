"""Faults of an emulated device by name, at a time: NAME[=VALUE][@SECONDS]."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields, replace

from thermograsp.errors import InvalidValueError, non_negative, unknown_name

from ..lines import LineFaults, PtyDevice

_SIDES = {"left": 0, "right": 1}
_LINE = tuple(field.name for field in fields(LineFaults))
_LASTING = {"stall": 1.0, "unplug": 1.0}  # s, unless given
_SIDED = ("open_thermistor", "break_heater", "break_converter", "saturate", "overheat")
_NAMES = (*_LINE, *_LASTING, *_SIDED, "reboot")


def plan_fault(served: PtyDevice, text: str) -> None:
    """Has a fault happen. Names: the chances of LineFaults, such as corrupt=0.01; stall and unplug with their s;
    open_thermistor, break_heater, break_converter, saturate, overheat with left or right; reboot. SECONDS: of the
    device's time, now where not given. Raises UnknownNameError and InvalidValueError."""
    name, value, time = parsed_fault(text, _NAMES)
    with served.paused():
        served.device.plan(time, _action(served, text, name, value))


def _action(served: PtyDevice, text: str, name: str, value: str) -> Callable[[], None]:
    device = served.device
    if name == "reboot":
        return device.reboot
    if name in _LINE:
        line = {name: fault_number(text, value)}
        LineFaults(**line)  # tells now what is wrong with it

        def spoil() -> None:
            device.line = replace(device.line, **line)

        return spoil
    if name in _LASTING:
        seconds = fault_number(text, value) if value else _LASTING[name]
        return _stall(served, seconds) if name == "stall" else _unplug(served, seconds)
    if value not in _SIDES:
        raise InvalidValueError(f"fault {text!r}: give {name}=left or {name}=right")
    side = _SIDES[value]
    if name == "overheat":
        return lambda: device.overheat(side)
    broken = {
        "open_thermistor": device.broken_thermistors,
        "break_heater": device.broken_heaters,
        "break_converter": device.broken_converters,
        "saturate": device.saturated,
    }
    return lambda: broken[name].add(side)


def _stall(served: PtyDevice, seconds: float) -> Callable[[], None]:
    def stall() -> None:
        served.device.stall_until = served.now + seconds

    return stall


def _unplug(served: PtyDevice, seconds: float) -> Callable[[], None]:
    def unplug() -> None:
        served.unplug()
        served.device.plan(served.now + seconds, served.plug)

    return unplug


def parsed_fault(text: str, names: Sequence[str]) -> tuple[str, str, float]:
    """Name, value ("" for none) and time s of NAME[=VALUE][@SECONDS]. Raises UnknownNameError for a name that is not
    one of those, and InvalidValueError."""
    fault, _, when = text.partition("@")
    name, _, value = fault.partition("=")
    if name not in names:
        raise unknown_name("fault", name, names)
    return name, value, fault_number(text, when) if when else 0.0


def fault_number(text: str, number: str) -> float:
    """A number of 0 or above in a fault's text. Raises InvalidValueError."""
    try:
        return non_negative(f"fault {text!r}", float(number))
    except ValueError:
        raise InvalidValueError(f"fault {text!r}: {number!r} is not a number of 0 or above") from None
