"""A gripper and fingertips that know of each other, emulated in virtual time or on ports, and their serial plant."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from thermograsp.hardware import (
    Contact,
    EmulatedFingertips,
    EmulatedGripper,
    Feel,
    Fingertips,
    GripperModel,
    GripperStatus,
    PtyDevice,
    RobotiqGripper,
    RobotiqUnits,
    SpringFingers,
    VirtualLine,
)
from thermograsp.hardware.plant import SerialConfig
from thermograsp.hardware.plant.pacing import VirtualTime
from thermograsp.hardware.plant.serial import SerialPlant
from thermograsp.plant import Command, Reading

WIDTH = 0.04  # m, of the object
CLOSE = Command(np.array([0.0]), np.array([30.0]), np.array([0.0]))


class Hand:
    """Devices that know of each other: the pads feel a force where the fingers are at the object."""

    def __init__(self, warm: bool = True, stroke: float = 0.085) -> None:
        self.units = RobotiqUnits(stroke=stroke)
        self.fingers = SpringFingers(stroke, WIDTH)
        self.gripper = EmulatedGripper(GripperModel(units=self.units, activation_speed=1.0), self.fingers)
        self.warm = warm
        self.fingertips = EmulatedFingertips(self.feel)

    def feel(self, now: float) -> Feel:
        force = 1e5 * max(0.0, WIDTH - self.fingers.opening)
        pad = (force, 0.0, 0.0)
        return Feel((now * 1e-4, -now * 1e-4), (0.0, 0.0), (pad, pad), (36.0, 36.0) if self.warm else None)


def in_step(hand: Hand, **config: float) -> tuple[SerialPlant, VirtualLine]:
    lines = VirtualLine(hand.fingertips), VirtualLine(hand.gripper)
    tips = Fingertips(lines[0].open, clock=lines[0].clock, background=False, rate=100, setpoint=36.0)
    gripper = RobotiqGripper(lines[1].open, units=hand.units, clock=lines[1].clock, sleep=lines[1].advance)
    return SerialPlant(tips, gripper, SerialConfig(**config), VirtualTime(lines)), lines[0]  # pyright: ignore[reportArgumentType]


def fresh(plant: SerialPlant) -> Reading:
    return plant.reset([0], [np.random.default_rng(0)], {})


@contextmanager
def on_ports(folder: Path, hand: Hand) -> Iterator[tuple[PtyDevice, PtyDevice]]:
    with (
        PtyDevice(hand.fingertips, folder / "tips") as tips,
        PtyDevice(hand.gripper, folder / "gripper") as gripper,
    ):
        yield tips, gripper


def eventually(true: Callable[[], bool], seconds: float = 3.0) -> bool:
    deadline = time.monotonic() + seconds
    while not true() and time.monotonic() < deadline:
        time.sleep(0.01)
    return true()


class Stubborn:
    """A gripper of another package, which raises what it likes."""

    stroke = 0.085

    def __init__(self) -> None:
        self.failures = 0
        self.moves: list[Any] = []

    def move(self, opening: float, force: float, speed: float) -> GripperStatus:
        if self.failures:
            self.failures -= 1
            raise OSError("the bus is busy")
        self.moves.append(opening)
        return self.status()

    def status(self) -> GripperStatus:
        opening = next((one for one in reversed(self.moves) if one != "stop"), 0.0)
        return GripperStatus(opening, opening, False, Contact.NONE, 0.0, True, "")

    def activate(self) -> None:
        pass

    def close(self) -> None:
        pass
