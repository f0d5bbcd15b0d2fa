"""The arm that carries a serial plant's gripper: what of it the plant moves."""

from __future__ import annotations

from contextlib import ExitStack

import numpy as np

from thermograsp.errors import InvalidValueError
from thermograsp.plant import Command

from ..drivers import Axis
from .limited_axis import LATERAL, LIFT, LimitedAxis


class Arm:
    """lift: raises the gripper. lateral: moves it along the table. Either may be None. Times are of one clock, s.
    Raises InvalidValueError as LimitedAxis does, and where both are the same."""

    def __init__(self, lift: Axis | None, lateral: Axis | None) -> None:
        if lift is not None and lift is lateral:
            raise InvalidValueError(
                f"lift and lateral are the same axis, {lift!r}: give the one that raises the gripper as lift and the "
                "one that moves it along the table as lateral"
            )
        self.lift, self.lateral = LimitedAxis(lift, LIFT), LimitedAxis(lateral, LATERAL)
        self._axes = (self.lift, self.lateral)

    @property
    def unknown(self) -> tuple[str, ...]:
        """Values of a reading that this arm has no axis for."""
        both = zip(("height", "lateral"), self._axes, strict=True)
        return tuple(name for name, axis in both if axis.axis is None)

    @property
    def height(self) -> np.ndarray:
        """(1,) m, as last read."""
        return np.array([self.lift.place])

    @property
    def place(self) -> np.ndarray | None:
        """(1,) m along the table, as last read; None for an arm without such an axis."""
        return None if self.lateral.axis is None else np.array([self.lateral.place])

    def move(self, command: Command, now: float, seconds: float) -> None:
        """Goes on at the command's rates for a step of that length. Raises InvalidValueError for rates that no command
        may ask for, and what the axes raise."""
        self.lift.move(float(command.lift_rate[0]), now, seconds)
        sideways = command.lateral_rate
        self.lateral.move(0.0 if sideways is None else float(sideways[0]), now, seconds)

    def possible(self, command: Command) -> Command:
        """The command without rates of axes that are not there."""
        return command._replace(
            lift_rate=np.zeros_like(command.lift_rate) if self.lift.axis is None else command.lift_rate,
            lateral_rate=None if self.lateral.axis is None else command.lateral_rate,
        )

    def read(self, now: float) -> None:
        """Where it is. Raises DeviceError where an axis does not tell it, and what the axes raise."""
        for axis in self._axes:
            axis.read(now)

    def stop(self) -> None:
        """Stands still. Raises what an axis raises, after both have been told."""
        with ExitStack() as each:
            for axis in reversed(self._axes):
                each.callback(axis.stop)

    def halt(self, again: bool = False) -> None:
        """The same, but raises nothing. again: only those that have not heard it before."""
        for axis in self._axes:
            if not (again and axis.heard):
                axis.halt()

    @property
    def heard(self) -> bool:
        """Whether all have heard it when they were to `halt`."""
        return all(axis.heard for axis in self._axes)

    def close(self) -> None:
        """Stands still and releases its axes."""
        with ExitStack() as each:
            for axis in reversed(self._axes):
                each.callback(axis.close)
