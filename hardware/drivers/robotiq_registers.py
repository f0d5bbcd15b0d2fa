"""The registers of a Robotiq 2F-85: six bytes to it, six from it (2F-85 & 2F-140 Instruction Manual, Control)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from types import MappingProxyType

COMMAND = 0x03E8  # first of three registers to the gripper
STATUS = 0x07D0  # first of three registers from it
COUNT = 3
SLAVE = 9
BAUD = 115_200


class ObjectSeen(IntEnum):
    """gOBJ: meaningful while it is told to go to a position."""

    MOVING = 0
    WHILE_OPENING = 1
    WHILE_CLOSING = 2
    AT_POSITION = 3


class Activation(IntEnum):
    """gSTA."""

    RESET = 0
    RUNNING = 1
    DONE = 3


class Fault(IntEnum):
    """The fault register gFLT: 5 and 7 report commands in a wrong order, 8 and 9 clear by themselves, and from 0xA on a
    reset is needed."""

    NONE = 0x0
    ACTION_DELAYED = 0x5
    NOT_ACTIVATED = 0x7
    OVERHEATED = 0x8
    NO_COMMUNICATION = 0x9
    UNDERVOLTAGE = 0xA
    RELEASE_RUNNING = 0xB
    INTERNAL = 0xC
    ACTIVATION = 0xD
    OVERCURRENT = 0xE
    RELEASED = 0xF


FIRST_MAJOR = Fault.UNDERVOLTAGE

CURES: Mapping[int, str] = MappingProxyType(
    {
        Fault.ACTION_DELAYED: "told to move while it activates; wait for activate() to return",
        Fault.NOT_ACTIVATED: "told to move before it was activated; call activate()",
        Fault.OVERHEATED: "hotter than 85 °C; let it cool, with less force and fewer grasps a minute",
        Fault.NO_COMMUNICATION: "it heard nothing for 1 s; check the cable, or command it more often",
        Fault.UNDERVOLTAGE: "its supply is below the minimum; check the 24 V, then call clear_faults()",
        Fault.RELEASE_RUNNING: "its automatic release is under way; wait for its end, then call clear_faults()",
        Fault.INTERNAL: "its controller failed; power it off and on, and see Robotiq's support if that returns",
        Fault.ACTIVATION: "its fingers could not travel; free them, then call clear_faults()",
        Fault.OVERCURRENT: "its motor drew too much; free the fingers, then call clear_faults()",
        Fault.RELEASED: "it has released automatically; call clear_faults()",
    }
)


@dataclass(frozen=True, slots=True)
class Action:
    """A command to the gripper: counts 0 .. 255 for position (0 open), speed and force. release_opens: which way the
    automatic release goes."""

    activate: bool = False
    go: bool = False
    release: bool = False
    release_opens: bool = False
    position: int = 0
    speed: int = 0
    force: int = 0

    def registers(self) -> list[int]:
        """The values for the three registers from COMMAND on."""
        bits = self.activate | self.go << 3 | self.release << 4 | self.release_opens << 5
        return [bits << 8, self.position, self.speed << 8 | self.force]


def action(registers: Sequence[int]) -> Action:
    """What the three registers from COMMAND on tell."""
    bits = registers[0] >> 8
    return Action(
        activate=bool(bits & 0x01),
        go=bool(bits & 0x08),
        release=bool(bits & 0x10),
        release_opens=bool(bits & 0x20),
        position=registers[1] & 0xFF,
        speed=registers[2] >> 8,
        force=registers[2] & 0xFF,
    )


@dataclass(frozen=True, slots=True)
class State:
    """The gripper's status. going: it goes to the requested position. requested, position, current: counts. driver:
    the upper half of the fault byte, for Robotiq's other controllers."""

    activated: bool
    going: bool
    activation: int
    seen: ObjectSeen
    fault: int
    requested: int
    position: int
    current: int
    driver: int = 0

    def registers(self) -> list[int]:
        """The three registers from STATUS on."""
        bits = self.activated | self.going << 3 | self.activation << 4 | self.seen << 6
        fault = self.driver << 4 | self.fault
        return [bits << 8, fault << 8 | self.requested, self.position << 8 | self.current]


def state(registers: Sequence[int]) -> State:
    """What the three registers from STATUS on say."""
    bits, fault = registers[0] >> 8, registers[1] >> 8
    return State(
        activated=bool(bits & 0x01),
        going=bool(bits & 0x08),
        activation=bits >> 4 & 0x3,
        seen=ObjectSeen(bits >> 6 & 0x3),
        fault=fault & 0xF,
        requested=registers[1] & 0xFF,
        position=registers[2] >> 8,
        current=registers[2] & 0xFF,
        driver=fault >> 4,
    )


def fault_text(fault: int) -> str:
    """A fault's name, cause and cure; "" for none."""
    if fault == Fault.NONE:
        return ""
    name = (
        Fault(fault).name.lower().replace("_", " ") if fault in CURES else "a fault the manual does not name"
    )
    return f"{name} (gFLT {fault:#x}): {CURES.get(fault, 'call clear_faults()')}"
