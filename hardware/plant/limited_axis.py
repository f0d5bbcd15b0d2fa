"""An axis of the arm that carries a serial plant's gripper, within its limits, or none."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass

from thermograsp.errors import InvalidValueError, positive, within
from thermograsp.plant import LATERAL_REACH, MAX_HEIGHT, MAX_LATERAL_RATE, MAX_LIFT_RATE

from ..drivers import Axis
from ..errors import DeviceError

_THERE = 5e-4  # m from position 0 that counts as there
_MEMBERS = ("travel", "move", "position", "stop", "close")  # of an Axis


@dataclass(frozen=True, slots=True)
class AxisLimits:
    """name: of a serial plant's keyword; a command has name_rate. words: what errors call it. low, high: m, the places
    that an observation tells. most_rate: m/s that a command may ask for."""

    name: str
    words: str
    low: float
    high: float
    most_rate: float


LIFT = AxisLimits("lift", "the lift", 0.0, MAX_HEIGHT, MAX_LIFT_RATE)
LATERAL = AxisLimits("lateral", "the lateral axis", -LATERAL_REACH, LATERAL_REACH, MAX_LATERAL_RATE)


class LimitedAxis:
    """axis: None for an arm that has none, whose place is 0 and which rates do not move. place: m, as last read.
    heard: whether the axis has heard it when it was to `halt`. Times are of one clock, s. Raises InvalidValueError for
    what is no axis, and for one without travel."""

    def __init__(self, axis: Axis | None, limits: AxisLimits) -> None:
        self.axis, self.place, self.heard = axis, 0.0, True
        self._limits = limits
        self._low = self._high = self._rate = self._read_at = 0.0
        if axis is not None:
            missing = [name for name in _MEMBERS if not hasattr(axis, name)]
            if missing:
                raise InvalidValueError(
                    f"{limits.name} must be a thermograsp.hardware.Axis; {type(axis).__name__} has no "
                    f"{', '.join(missing)}"
                )
            travel = positive(f"{limits.words}'s travel (m)", axis.travel)
            self._low, self._high = max(-travel, limits.low), min(travel, limits.high)

    def move(self, rate: float, now: float, seconds: float) -> None:
        """Goes on at that rate, m/s, or at the one that takes it to the end of its travel in the `seconds` of a step.
        Raises InvalidValueError for a rate that no command may ask for, and what the axis raises."""
        if self.axis is None:
            return
        most = self._limits.most_rate
        within(f"{self._limits.name}_rate", rate, -most, most, "m/s")
        here = self.place + self._rate * (now - self._read_at)
        up, down = max((self._high - here) / seconds, 0.0), min((self._low - here) / seconds, 0.0)
        self._rate = min(max(rate, down), up)
        self.axis.move(self._rate)

    def read(self, now: float) -> float:
        """m, the place. Raises DeviceError where the axis does not tell it, and what it raises."""
        if self.axis is not None:
            place = float(self.axis.position())
            if not math.isfinite(place):
                raise DeviceError(f"{self._limits.words} tells no position ({place!r} m)")
            self.place, self._read_at = place, now
        return self.place

    def returned(self, now: float, seconds: float) -> bool:
        """Whether it is at position 0; where not, it is sent there, and asked again in `seconds`."""
        place, most = self.read(now), self._limits.most_rate
        if self.axis is None:
            return True
        if abs(place) > _THERE:
            self.axis.move(min(max(-0.8 * place / seconds, -most), most))
            return False
        self.stop()
        return True

    def stop(self) -> None:
        """Stands still. Raises what the axis raises."""
        if self.axis is not None:
            self._rate = 0.0
            self.axis.stop()

    def halt(self) -> None:
        """The same, but raises nothing; `heard` says whether it worked."""
        self.heard = False
        with suppress(Exception):  # of whatever kind: another package's axis may raise anything
            self.stop()
            self.heard = True

    def close(self) -> None:
        """Stands still and releases the axis."""
        if self.axis is not None:
            self.halt()
            self.axis.close()
