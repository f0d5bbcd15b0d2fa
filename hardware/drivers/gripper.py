"""What a gripper must do to serve as the hand of a serial plant, and how one is opened by URL."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from types import MappingProxyType, TracebackType
from typing import Any, Protocol

import numpy as np

from thermograsp.plant import named_by_scheme


class Contact(Enum):
    """What stopped the fingers short of their target."""

    NONE = 0
    OPENING = 1
    CLOSING = 2


@dataclass(frozen=True, slots=True)
class GripperStatus:
    """The state of a gripper. opening: m between the pads. target: m, the last one commanded. moving: whether the
    fingers move. contact: what stopped them. current: A of the motor. active: whether it accepts commands to move.
    fault: a description of the fault, "" for none."""

    opening: float
    target: float
    moving: bool
    contact: Contact
    current: float
    active: bool
    fault: str


class Gripper(Protocol):
    """Two fingers on a line of their own. opening: m, force: N, speed: m/s, of one pad relative to the other.

    Methods raise DeviceError or one of its kinds within 1 s, except where they say that they wait for motion. Several
    threads may call them.
    """

    @property
    def stroke(self) -> float:
        """m between the pads of the open gripper. A class from before this was asked for may lack it: the serial plant
        then opens it as far as an observation can tell."""
        ...

    def __enter__(self) -> Gripper: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...

    def activate(self) -> None:
        """Makes it ready to move and waits for that; the fingers may travel their whole range. Nothing where it is."""
        ...

    def move(self, opening: float, force: float, speed: float) -> GripperStatus:
        """Sets a target and returns at once; force limits what the fingers press with."""
        ...

    def wait(self, seconds: float = 6.0) -> GripperStatus:
        """Waits until the fingers have arrived or are stopped by something."""
        ...

    def stop(self) -> GripperStatus:
        """The fingers stay where they are. It goes before what other threads wait for, after one transaction on the
        line at most, and what they have asked for before is not carried out after it: they get a StoppedError, and
        `wait` returns."""
        ...

    def status(self) -> GripperStatus:
        """The gripper's status."""
        ...

    def clear_faults(self) -> None:
        """Brings it back from a fault, as activate does; what it holds may fall."""
        ...

    def quantised(self, opening: Any, force: Any, speed: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """What it really does when told so, elementwise: pure, so that a simulation can do the same."""
        ...

    def close(self) -> None:
        """Releases the line; the fingers stay as they are."""
        ...


ENTRY_POINTS = "thermograsp.grippers"  # where another package names its own: scheme = module:function
_SCHEMES: Mapping[str, str] = MappingProxyType(
    {"robotiq": "thermograsp.hardware.drivers.robotiq:robotiq_from_url"}
)


def open_gripper(url: str, **keywords: Any) -> Gripper:
    """Opens the gripper of a URL such as "robotiq:///dev/ttyUSB0". keywords: its factory's.

    Other packages add theirs as an entry point of the group `thermograsp.grippers`, the scheme its name: a function of
    the URL and keywords. Raises UnknownNameError with the known schemes, and what the factory raises.
    """
    return named_by_scheme("gripper", url, _SCHEMES, ENTRY_POINTS)(url, **keywords)
