"""Faults of an emulated gripper by name, at a time: NAME[=VALUE][@SECONDS]."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace

from ..drivers import Fault
from ..lines import LineFaults
from .planned_faults import fault_number, parsed_fault
from .robotiq import EmulatedGripper

_LINE = tuple(field.name for field in fields(LineFaults))
_STATES = {fault.name.lower(): fault for fault in Fault if fault}
_NAMES = (*_LINE, *_STATES, "exception", "power_cycle", "stall")


def plan_gripper_fault(device: EmulatedGripper, text: str) -> None:
    """Has a fault happen. Names: the chances of LineFaults, such as corrupt=0.01; those of gFLT, such as overcurrent;
    exception with the Modbus code to refuse everything with; stall with its s; power_cycle. SECONDS: of the device's
    time, now where not given. Raises UnknownNameError and InvalidValueError."""
    name, value, time = parsed_fault(text, _NAMES)
    device.plan(time, _action(device, text, name, value, time))


def _action(device: EmulatedGripper, text: str, name: str, value: str, time: float) -> Callable[[], None]:
    if name in _STATES:
        return lambda: device.fail(_STATES[name])
    if name == "power_cycle":
        return device.power_cycle
    number = fault_number(text, value)
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
