"""What an axis of the arm that carries the gripper must do to serve a serial plant."""

from __future__ import annotations

from typing import Protocol


class Axis(Protocol):
    """One axis of an arm, which moves at a rate. travel: m from its position 0, where the gripper grasps or is in the
    middle between two objects, to the furthest one that it may be sent to, above 0 for a lift, and to either side for a
    lateral axis; the axis itself should refuse to go further, whatever it is told.

    Methods raise DeviceError or one of its kinds within 1 s. Several threads may call them.
    """

    @property
    def travel(self) -> float:
        """m."""
        ...

    def move(self, rate: float) -> None:
        """Goes on at that rate, m/s, towards positions above 0 where it is above 0, until it is told otherwise. Returns
        at once."""
        ...

    def position(self) -> float:
        """m, now. Returns within milliseconds: a control step waits for it."""
        ...

    def stop(self) -> None:
        """Stands still. Goes before what other threads wait for."""
        ...

    def close(self) -> None:
        """Releases its line; it stays where it is."""
        ...
