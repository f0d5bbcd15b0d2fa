"""What moves in an emulated gripper: two fingers and, maybe, something springy between them."""

from __future__ import annotations

from typing import Protocol

from thermograsp.errors import non_negative, positive

from ..drivers import Contact

_MOVING_CURRENT = 0.1  # A, an estimate; at rest the manual's examples show 0


class Fingers(Protocol):
    """Simulated fingers. opening: m between the pads. contact: what has stopped them. current: A of the motor. A
    simulation of more than this, such as of a whole scene, has the same form."""

    opening: float
    contact: Contact
    current: float

    def move(self, target: float, force: float, speed: float, seconds: float) -> None:
        """Time goes on, with the fingers on their way to target (m) at no more than speed (m/s) and force (N)."""
        ...


class SpringFingers:
    """Fingers of constant speed without mass; an object of `width` m pushes back with stiffness (N/m) times its
    compression.

    width None: nothing is there. Attributes may be changed at any time. Raises InvalidValueError for a width or
    stiffness below 0.
    """

    def __init__(self, opening: float, width: float | None = None, stiffness: float = 1e5) -> None:
        self.opening = non_negative("fingers: opening (m)", opening)
        self.width = None if width is None else non_negative("fingers: width (m)", width)
        self.stiffness = positive("fingers: stiffness (N/m)", stiffness)
        self.contact = Contact.NONE
        self.current = 0.0

    def move(self, target: float, force: float, speed: float, seconds: float) -> None:
        """See Fingers. Fingers that press more than `force` stay: the drive locks itself."""
        goal, blocked = target, False
        if self.width is not None and target < self.opening:
            least = min(self.width - force / self.stiffness, self.opening)
            blocked = least > target
            goal = max(target, least)
        step = min(abs(goal - self.opening), speed * seconds)
        self.opening += step if goal > self.opening else -step
        arrived = abs(goal - self.opening) < 1e-9
        self.contact = Contact.CLOSING if blocked and arrived else Contact.NONE
        self.current = 0.0 if arrived else _MOVING_CURRENT
