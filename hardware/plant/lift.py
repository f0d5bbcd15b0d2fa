"""The lift of a serial plant: the arm's axis within its limits, or none."""

from __future__ import annotations

import math
from contextlib import suppress

from thermograsp.errors import InvalidValueError, finite, positive
from thermograsp.plant import MAX_HEIGHT, MAX_LIFT_RATE

from ..drivers import Axis
from ..errors import DeviceError

_LOWEST = 5e-4  # m from position 0 that counts as there
_MEMBERS = ("travel", "move", "position", "stop", "close")  # of an Axis


class Lift:
    """axis: None for an arm that has none, whose height is 0 and which rates do not move. height: m, as last read.
    heard: whether the axis has heard it when it was to `halt`. Times are of one clock, s. Raises InvalidValueError for
    what is no axis, and for one without travel."""

    def __init__(self, axis: Axis | None) -> None:
        self.axis, self.height, self.heard = axis, 0.0, True
        self._highest = self._rate = self._read_at = 0.0
        if axis is not None:
            missing = [name for name in _MEMBERS if not hasattr(axis, name)]
            if missing:
                raise InvalidValueError(
                    f"lift must be a thermograsp.hardware.Axis; {type(axis).__name__} has no {', '.join(missing)}"
                )
            self._highest = min(positive("the lift's travel (m)", axis.travel), MAX_HEIGHT)

    def move(self, rate: float, now: float, seconds: float) -> None:
        """Goes on at that rate, m/s, or at the one that takes it to the end of its travel in the `seconds` of a step.
        Raises InvalidValueError for what is no number, and what the axis raises."""
        if self.axis is None:
            return
        here = self.height + self._rate * (now - self._read_at)
        up, down = max((self._highest - here) / seconds, 0.0), min(-here / seconds, 0.0)
        self._rate = min(max(finite("lift_rate", rate), down), up)
        self.axis.move(self._rate)

    def read(self, now: float) -> float:
        """m, the height. Raises DeviceError where the axis does not tell it, and what it raises."""
        if self.axis is not None:
            height = float(self.axis.position())
            if not math.isfinite(height):
                raise DeviceError(f"the lift tells no position ({height!r} m)")
            self.height, self._read_at = height, now
        return self.height

    def lowered(self, now: float, seconds: float) -> bool:
        """Whether it is at position 0; where not, it is sent there, and asked again in `seconds`."""
        height = self.read(now)
        if self.axis is None:
            return True
        if abs(height) > _LOWEST:
            self.axis.move(min(max(-0.8 * height / seconds, -MAX_LIFT_RATE), MAX_LIFT_RATE))
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
