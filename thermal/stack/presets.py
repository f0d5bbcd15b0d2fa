"""Heated stacks of assets/sensors.toml and of files in its form: a sensor's layers and its `touch` table."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

from thermograsp.errors import InvalidValueError, unknown_name
from thermograsp.files import read_toml

from ...assets import asset
from ..matter import SensorStack, load_sensors, sensor
from .design import Backing, ForceContact, HeatedStack, Place
from .laws import ConstantPower, CutAtContact, HeaterLaw, Held, Off, Pid
from .recorder import Divider, Recorder

_LAWS: Mapping[str, type[HeaterLaw]] = MappingProxyType(
    {"off": Off, "constant": ConstantPower, "cut_at_contact": CutAtContact, "held": Held, "pid": Pid}
)
_KEYS = ("readout", "heater", "contact", "law", "backing", "recorder", "divider")


@cache
def heated_stacks() -> Mapping[str, HeatedStack]:
    """The presets by name, read-only."""
    return load_heated_stacks(asset("sensors.toml"))


def heated_stack(name: str | os.PathLike[str] | HeatedStack) -> HeatedStack:
    """The preset of that name, the one of a file (a path, or a name that ends in .toml), or the stack itself. Raises
    UnknownNameError with near names, InvalidValueError for a file that does not hold one."""
    if isinstance(name, HeatedStack):
        return name
    if isinstance(name, os.PathLike) or name.endswith(".toml"):
        stacks = load_heated_stacks(name)
        if len(stacks) != 1:
            raise InvalidValueError(
                f"{name} holds {len(stacks)} sensors with a `touch` table: keep one in the file"
            )
        return next(iter(stacks.values()))
    try:
        return heated_stacks()[name]
    except KeyError:
        raise unknown_name("heated sensor", name, heated_stacks()) from None


def any_sensor(name: str | os.PathLike[str] | SensorStack | HeatedStack) -> SensorStack | HeatedStack:
    """What a keyword `sensor` stands for: a preset, or the one sensor of a file, is heated by its own law where it
    has a `touch` table, and an element on a thermostat where it has none. Raises UnknownNameError and
    InvalidValueError."""
    if isinstance(name, SensorStack | HeatedStack):
        return name
    plain = sensor(name)
    is_file = isinstance(name, os.PathLike) or name.endswith(".toml")
    heated = load_heated_stacks(name) if is_file else heated_stacks()
    return heated.get(plain.name, plain)


def load_heated_stacks(path: str | os.PathLike[str]) -> Mapping[str, HeatedStack]:
    """The sensors of a TOML file that have a `touch` table, by name. Raises InvalidValueError, naming the file."""
    sensors = load_sensors(path)
    entries = read_toml(path)["sensors"]
    found = {}
    for name, entry in entries.items():
        if "touch" in entry:
            try:
                found[name] = _heated(sensors[name], entry["touch"])
            except (TypeError, LookupError, AttributeError, ValueError) as error:
                raise InvalidValueError(
                    f"{path}: sensor {name!r}, touch: {error}; see heated_thermistor in assets/sensors.toml"
                ) from error
    return MappingProxyType(found)


def _heated(sensor: SensorStack, touch: dict[str, Any]) -> HeatedStack:
    for key in touch:
        if key not in _KEYS:
            raise unknown_name("entry", key, _KEYS)
    law = dict(touch.get("law", {"kind": "off"}))
    kind = law.pop("kind", None)
    if kind not in _LAWS:
        raise unknown_name("heater law", kind, _LAWS)
    return HeatedStack(
        sensor.name,
        sensor.layers,
        readout=Place(**touch["readout"]),
        heater=Place(**touch["heater"]),
        contact=ForceContact(**touch["contact"]),
        law=_LAWS[kind](**law),
        backing=Backing(**touch.get("backing", {})),
        recorder=Recorder(**touch.get("recorder", {})),
        divider=Divider(**touch.get("divider", {})),
        width=sensor.width,
    )
