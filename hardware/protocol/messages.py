"""The messages of the fingertips' link: what they say in SI units, and their layout on the wire.

Per fingertip: two values, left and right. docs/protocol.md is the same for those who write a device.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from enum import IntEnum, IntFlag
from types import MappingProxyType
from typing import Any, ClassVar, Protocol

import numpy as np

from thermograsp.errors import InvalidValueError

from .fields import Field, Layout

Pair = tuple[float, float]
Triple = tuple[float, float, float]

PROTOCOL = (2, 0)  # major, minor
MODEL = 0x5447  # what a device of this protocol says that it is

_NANOVOLT, _CENTIKELVIN, _CENTINEWTON, _MILLIWATT, _PPM, _E4 = 1e9, 100, 100, 1e3, 1e6, 1e4


class Code(IntEnum):
    """Message codes; the highest bit is set on the way to the device."""

    SAMPLE = 0x01
    THERMOSTAT = 0x02
    STATUS = 0x03
    IDENTITY = 0x04
    CALIBRATION = 0x05
    SELF_TEST = 0x06
    ACKNOWLEDGEMENT = 0x07
    CONDITION = 0x08
    IDENTIFY = 0x81
    REQUEST = 0x82
    SET_RATE = 0x83
    SET_SETPOINT = 0x84
    SET_CALIBRATION = 0x85
    RUN_SELF_TEST = 0x86
    CLEAR_FAULTS = 0x87
    KEEP_ALIVE = 0x88


class Flag(IntFlag):
    """The device's condition when a frame was made, in its header. A saturated voltage is an end of the converter's
    range; an open thermistor's temperature is NaN; off the setpoint is by more than 1 K while the heater is on; latched
    off are both heaters, for a reason that CONDITION tells, until CLEAR_FAULTS; unidentified is a device since its boot
    until IDENTIFY.

    From 0x100 on: not on the wire; the driver adds them to samples whose voltage, or one of whose three forces, is
    missing, NaN: the converter gave none, or the load cell is at an end of its range."""

    SATURATED_LEFT = 0x01
    SATURATED_RIGHT = 0x02
    OPEN_LEFT = 0x04
    OPEN_RIGHT = 0x08
    OFF_SETPOINT_LEFT = 0x10
    OFF_SETPOINT_RIGHT = 0x20
    LATCHED_OFF = 0x40
    OVER_TEMPERATURE = 0x40  # its name in protocol 1
    UNIDENTIFIED = 0x80
    NO_VOLTAGE_LEFT = 0x100
    NO_VOLTAGE_RIGHT = 0x200
    NO_FORCE_LEFT = 0x400
    NO_FORCE_RIGHT = 0x800


class HeatersOff(IntFlag):
    """The reasons why heaters are off. All but a silent host are latched: both heaters stay off until CLEAR_FAULTS. A
    runaway is a heater that was on without its plate becoming warmer; a silent host's setpoints have expired."""

    TOO_HOT_LEFT = 0x01
    TOO_HOT_RIGHT = 0x02
    RUNAWAY_LEFT = 0x04
    RUNAWAY_RIGHT = 0x08
    HOST_SILENT = 0x10


LATCHING = HeatersOff(0x0F)


class Reset(IntFlag):
    """What made the device start: several causes if they came together, none if the device cannot tell."""

    POWER_ON = 0x01
    EXTERNAL = 0x02
    BROWN_OUT = 0x04
    WATCHDOG = 0x08


class Check(IntFlag):
    """What a self-test looks at."""

    CONVERTER = 0x01
    LEFT_THERMISTOR = 0x02
    RIGHT_THERMISTOR = 0x04
    LEFT_HEATER = 0x08
    RIGHT_HEATER = 0x10
    LOAD_CELLS = 0x20
    MEMORY = 0x40
    BROWN_OUT = 0x80


EVERY_CHECK = Check(0xFF)


class Result(IntEnum):
    """How a command went."""

    DONE = 0
    BAD_VALUE = 1
    BUSY = 2
    FAILED = 3


@dataclass(frozen=True, slots=True)
class Sample:
    """One sample of both fingertips. voltage: V of each Peltier element, after the converter, before calibration.
    thermostat: °C. force: N on each pad, normal (> 0 when pressing) and two tangential, pad frame."""

    voltage: Pair
    thermostat: Pair
    force: tuple[Triple, Triple]


@dataclass(frozen=True, slots=True)
class ThermostatReport:
    """The state of both thermostats. setpoint, temperature: °C, NaN for a heater that is off and for an open
    thermistor. power: W of each heater."""

    setpoint: Pair
    temperature: Pair
    power: Pair


@dataclass(frozen=True, slots=True)
class Status:
    """The device's counters and supply. uptime: s. samples: sent since boot. overruns: samples lost for want of room to
    send. bad_frames: received with a wrong checksum or length. repeats: commands received again and not executed.
    supply: V. rate: Hz of samples."""

    uptime: int
    samples: int
    overruns: int
    bad_frames: int
    repeats: int
    supply: float
    rate: int


@dataclass(frozen=True, slots=True)
class Identity:
    """How a device identifies itself. protocol: (major, minor) of this session, major 0 if host and device share none.
    firmware: (major, minor). boots: how often it has started. max_rate: Hz. serial: number of this device.
    voltage_step, voltage_limit: V, of the converter, referred to the element."""

    model: int
    protocol: tuple[int, int]
    firmware: tuple[int, int]
    boots: int
    max_rate: int
    serial: int
    voltage_step: float
    voltage_limit: float


@dataclass(frozen=True, slots=True)
class Calibration:
    """Constants that the device keeps and the host applies: true = (reported - offset) x (1 + gain). date: Unix time of
    the calibration in s, 0 for none. Offsets in V, °C, N; gains relative. The thermostat has an offset only."""

    date: int = 0
    voltage_offset: Pair = (0.0, 0.0)
    voltage_gain: Pair = (0.0, 0.0)
    thermostat_offset: Pair = (0.0, 0.0)
    force_offset: tuple[Triple, Triple] = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    force_gain: tuple[Triple, Triple] = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@dataclass(frozen=True, slots=True)
class SelfTest:
    """The result of a self-test. checks: those that were performed. failed: those that failed. voltage_noise: V rms of
    each channel. heater_current: A of each heater when on."""

    checks: int
    failed: int
    voltage_noise: Pair
    heater_current: Pair


@dataclass(frozen=True, slots=True)
class Acknowledgement:
    """The device's answer to a command. command: sequence number of the command's frame. code: its code. result: how it
    went, a Result."""

    command: int
    code: int
    result: int


@dataclass(frozen=True, slots=True)
class Condition:
    """The device's condition. reset: what made it start, a Reset. heaters_off: why heaters are off, HeatersOff."""

    reset: int
    heaters_off: int


@dataclass(frozen=True, slots=True)
class Identify:
    """The host asks the device who it is. oldest, newest: protocol majors that the host speaks. session: a number drawn
    when the host connects."""

    oldest: int
    newest: int
    session: int


@dataclass(frozen=True, slots=True)
class Request:
    """The host asks for one message. wanted: code of the message to send: THERMOSTAT, STATUS, CALIBRATION or
    CONDITION."""

    wanted: int


@dataclass(frozen=True, slots=True)
class SetRate:
    """The host sets the rate of samples. rate: samples a second, 0 to stop."""

    rate: int


@dataclass(frozen=True, slots=True)
class SetSetpoint:
    """The host sets both thermostats. setpoint: °C of each thermostat as it reports temperature; NaN turns its heater
    off."""

    setpoint: Pair


@dataclass(frozen=True, slots=True)
class SetCalibration(Calibration):
    """The constants to keep through a loss of power."""


@dataclass(frozen=True, slots=True)
class RunSelfTest:
    """The host starts a self-test. checks: what to look at."""

    checks: int


@dataclass(frozen=True, slots=True)
class ClearFaults:
    """The host clears latched faults. faults: of HeatersOff, what is to be latched no longer; the heaters go on where
    nothing else is."""

    faults: int


@dataclass(frozen=True, slots=True)
class KeepAlive:
    """The host says that it is there. session: of the host's IDENTIFY. Not acknowledged; without it the heaters go off
    after 10 s."""

    session: int


class Message(Protocol):
    """Any of the dataclasses above."""

    __dataclass_fields__: ClassVar[dict[str, Any]]


_CONSTANTS = Layout(
    Field("date", "u4"),
    Field("voltage_offset", "i4", _NANOVOLT, (2,)),
    Field("voltage_gain", "i4", _PPM, (2,)),
    Field("thermostat_offset", "i2", _CENTIKELVIN, (2,)),
    Field("force_offset", "i2", _CENTINEWTON, (2, 3)),
    Field("force_gain", "i2", _E4, (2, 3)),
)

LAYOUTS: Mapping[type, Layout] = MappingProxyType(
    {
        Sample: Layout(
            Field("voltage", "i4", _NANOVOLT, (2,)),
            Field("thermostat", "i2", _CENTIKELVIN, (2,)),
            Field("force", "i2", _CENTINEWTON, (2, 3)),
        ),
        ThermostatReport: Layout(
            Field("setpoint", "i2", _CENTIKELVIN, (2,)),
            Field("temperature", "i2", _CENTIKELVIN, (2,)),
            Field("power", "u2", _MILLIWATT, (2,)),
        ),
        Status: Layout(
            Field("uptime", "u4"),
            Field("samples", "u4"),
            Field("overruns", "u2"),
            Field("bad_frames", "u2"),
            Field("repeats", "u2"),
            Field("supply", "u2", 1e3),
            Field("rate", "u2"),
        ),
        Identity: Layout(
            Field("model", "u2"),
            Field("protocol", "u1", shape=(2,)),
            Field("firmware", "u1", shape=(2,)),
            Field("boots", "u2"),
            Field("max_rate", "u2"),
            Field("serial", "u8"),
            Field("voltage_step", "u4", 1e12),
            Field("voltage_limit", "u4", _NANOVOLT),
        ),
        Calibration: _CONSTANTS,
        SelfTest: Layout(
            Field("checks", "u2"),
            Field("failed", "u2"),
            Field("voltage_noise", "u4", _NANOVOLT, (2,)),
            Field("heater_current", "u2", 1e3, (2,)),
        ),
        Acknowledgement: Layout(Field("command", "u2"), Field("code", "u1"), Field("result", "u1")),
        Condition: Layout(Field("reset", "u1"), Field("heaters_off", "u1")),
        Identify: Layout(Field("oldest", "u1"), Field("newest", "u1"), Field("session", "u2")),
        Request: Layout(Field("wanted", "u1")),
        SetRate: Layout(Field("rate", "u2")),
        SetSetpoint: Layout(Field("setpoint", "i2", _CENTIKELVIN, (2,))),
        SetCalibration: _CONSTANTS,
        RunSelfTest: Layout(Field("checks", "u2")),
        ClearFaults: Layout(Field("faults", "u1")),
        KeepAlive: Layout(Field("session", "u2")),
    }
)

CODES: Mapping[type, Code] = MappingProxyType(dict(zip(LAYOUTS, Code, strict=True)))
MESSAGES: Mapping[int, type] = MappingProxyType({int(code): kind for kind, code in CODES.items()})
LENGTHS: Mapping[int, int] = MappingProxyType(
    {int(code): LAYOUTS[kind].struct.size for kind, code in CODES.items()}
)


def code_of(message: Message) -> Code:
    """The message's code."""
    return CODES[type(message)]


def encode_message(message: Message) -> bytes:
    """The payload of a message. Raises InvalidValueError for a value that does not fit its field."""
    return LAYOUTS[type(message)].pack(message)


def decode_message(code: int, payload: bytes) -> Message:
    """The message of a code that the decoder let through."""
    kind = MESSAGES[code]
    return kind(**LAYOUTS[kind].unpack(payload))


def constants_command(calibration: Calibration) -> SetCalibration:
    """The command that makes a device keep these constants. Raises InvalidValueError for some that leave nothing of a
    measurement."""
    for field in fields(calibration):
        values = np.asarray(getattr(calibration, field.name), float)
        least = -1.0 if field.name.endswith("_gain") else -np.inf
        if not (np.isfinite(values) & (values > least)).all():
            what = "finite and above -1" if field.name.endswith("_gain") else "finite"
            raise InvalidValueError(f"{field.name} must be {what}, got {values.tolist()}")
    return SetCalibration(**{field.name: getattr(calibration, field.name) for field in fields(calibration)})
