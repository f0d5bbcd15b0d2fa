"""Faults of an emulated gripper by name, at a time: NAME[=VALUE][@SECONDS]."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace

from thermograsp.errors import InvalidValueError, non_negative, unknown_name

from ..drivers import Fault
from ..lines import LineFaults
from .robotiq import EmulatedGripper

_LINE = tuple(field.name for field in fields(LineFaults))
_STATES = {fault.name.lower(): fault for fault in Fault if fault}
_NAMES = (*_LINE, *_STATES, "exception", "power_cycle", "stall")


def plan_gripper_fault(device: EmulatedGripper, text: str) -> None:
    """Has a fault happen. Names: the chances of LineFaults, such as corrupt=0.01; those of gFLT, such as overcurrent;
    exception with the Modbus code to refuse everything with; stall with its s; power_cycle. SECONDS: of the device's
    time, now where not given. Raises UnknownNameError and InvalidValueError."""
    what, _, when = text.partition("@")
    name, _, value = what.partition("=")
    if name not in _NAMES:
        raise unknown_name("fault", name, _NAMES)
    time = _number(text, when) if when else 0.0
    device.plan(time, _action(device, text, name, value, time))


def _action(device: EmulatedGripper, text: str, name: str, value: str, time: float) -> Callable[[], None]:
    if name in _STATES:
        return lambda: device.fail(_STATES[name])
    if name == "power_cycle":
        return device.power_cycle
    number = _number(text, value)
    if name in _LINE:
        LineFaults(**{name: number})  # tells now what is wrong with it

    def happen() -> None:
        if name in _LINE:
            device.line = replace(device.line, **{name: number})
        elif name == "stall":
            device.stall_until = time + number
        else:
            device.exception = int(number)

    return happen


def _number(text: str, number: str) -> float:
    try:
        return non_negative(f"fault {text!r}", float(number))
    except ValueError:
        raise InvalidValueError(f"fault {text!r}: {number!r} is no number of 0 or above") from None
