"""What a device in software offers to whoever serves it: VirtualLine in virtual time, PtyDevice in real time."""

from __future__ import annotations

from typing import Protocol, TypeVar


class Emulated(Protocol):
    """The device's end of a line. It has no clock, input or output of its own. Times are since its start, s."""

    @property
    def due(self) -> float:
        """When `advance` next has something to do; later than the last advance."""
        ...

    def advance(self, now: float) -> None:
        """Does all that is due up to time `now`."""
        ...

    def receive(self, data: bytes) -> None:
        """Bytes from the host, now."""
        ...

    def outgoing(self) -> list[bytes]:
        """What to send, in pieces that belong together."""
        ...


Device = TypeVar("Device", bound=Emulated)
