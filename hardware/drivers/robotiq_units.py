"""SI units and the counts of a Robotiq 2F-85, elementwise and pure: a simulation can quantise as the gripper does."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from thermograsp.errors import InvalidValueError, finite, positive, within

TOP = 255  # highest count of every quantity
_MOST_STROKE = 1.0  # m; the widest of Robotiq's two-fingered grippers opens .142 m
CURRENT_STEP = 0.01  # A a count of gCU (instruction manual, register CURRENT)


@dataclass(frozen=True, slots=True)
class RobotiqUnits:
    """Straight lines between counts and SI units. stroke: m, opening of the open gripper. open_count, closed_count:
    positions at which the fingers are open and meet. slowest, fastest: m/s at speed 0 and 255. weakest, strongest: N at
    force 0 and 255.

    Stroke, speed and force are the 2F-85's (Robotiq 2F-85 & 2F-140 Instruction Manual, specifications: 85 mm, 20 to 150
    mm/s, 20 to 235 N). Of the counts the manual gives the range 0 .. 255; Robotiq's support pages name about 3 open and
    230 closed, where the pads meet. They differ between grippers: RobotiqGripper.measure_counts finds them. The manual
    calls none of the three exactly linear.
    Raises InvalidValueError for a gripper that cannot be.
    """

    stroke: float = 0.085
    open_count: int = 3
    closed_count: int = 230
    slowest: float = 0.020
    fastest: float = 0.150
    weakest: float = 20.0
    strongest: float = 235.0

    def __post_init__(self) -> None:
        if positive("Robotiq: stroke (m)", self.stroke) > _MOST_STROKE:
            raise InvalidValueError(
                f"Robotiq: stroke {self.stroke:g} m: give at most {_MOST_STROKE:g} m; is it in mm?"
            )
        if not 0 <= self.open_count < self.closed_count <= TOP:
            raise InvalidValueError(
                f"Robotiq: open_count {self.open_count!r} and closed_count {self.closed_count!r} must rise within "
                f"0 .. {TOP}"
            )
        for low, high in ((self.slowest, self.fastest), (self.weakest, self.strongest)):
            if not 0 < finite("Robotiq: limit", low) < finite("Robotiq: limit", high):
                raise InvalidValueError(f"Robotiq: limits {low!r} and {high!r} must be positive and rise")

    def position_counts(self, opening: Any) -> np.ndarray:
        """rPR nearest to an opening, m; what is 0 or full is sent as 255 or 0, so that the fingers reach their ends.
        Raises InvalidValueError outside 0 .. stroke."""
        metres = within("opening", opening, 0.0, self.stroke, "m")
        span = self.closed_count - self.open_count
        counts = np.rint(self.closed_count - metres * (span / self.stroke))
        counts = np.where(counts >= self.closed_count, TOP, counts)
        return np.where(counts <= self.open_count, 0, counts).astype(int)

    def opening(self, counts: Any) -> np.ndarray:
        """m of a position gPO or rPR; beyond the ends the fingers do not move."""
        span = self.closed_count - self.open_count
        part = np.clip((self.closed_count - _counts("position", counts)) / span, 0.0, 1.0)
        return self.stroke * part

    def speed_counts(self, speed: Any) -> np.ndarray:
        """rSP nearest to a speed, m/s. One below the slowest is taken as that. Raises InvalidValueError outside 0 ..
        fastest."""
        metres = within("speed", speed, 0.0, self.fastest, "m/s")
        return np.rint(
            (np.maximum(metres, self.slowest) - self.slowest) * TOP / (self.fastest - self.slowest)
        ).astype(int)

    def speed(self, counts: Any) -> np.ndarray:
        """m/s of rSP."""
        return self.slowest + _counts("speed", counts) * ((self.fastest - self.slowest) / TOP)

    def force_counts(self, force: Any) -> np.ndarray:
        """rFR of a force limit, N: the highest that is not above it. The gripper cannot press with less than its
        weakest, which any lower limit becomes. Raises InvalidValueError outside 0 .. strongest."""
        newtons = within("force", force, 0.0, self.strongest, "N")
        part = (np.maximum(newtons, self.weakest) - self.weakest) / (self.strongest - self.weakest)
        return np.floor(part * TOP + 1e-9).astype(int)

    def force(self, counts: Any) -> np.ndarray:
        """N of rFR."""
        return self.weakest + _counts("force", counts) * ((self.strongest - self.weakest) / TOP)

    def quantised(self, opening: Any, force: Any, speed: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(opening m, force N, speed m/s) that the gripper makes of a command, elementwise."""
        return (
            self.opening(self.position_counts(opening)),
            self.force(self.force_counts(force)),
            self.speed(self.speed_counts(speed)),
        )


def _counts(name: str, value: Any) -> np.ndarray:
    return within(name, value, 0, TOP, "counts")
