"""A line to an emulated device in virtual time: nothing waits, and everything happens in one thread, in one order."""

from __future__ import annotations

from .emulator import EmulatedFingertips


class VirtualLine:
    """Opener, transport and clock of a driver: Fingertips(line.open, clock=line.clock, background=False).

    Time goes on by `advance`, and while the driver waits for an answer.
    """

    def __init__(self, device: EmulatedFingertips) -> None:
        self.device = device
        self._now = 0.0

    def clock(self) -> float:
        """Virtual time, s."""
        return self._now

    def open(self) -> VirtualLine:
        """The line itself: it has two ends only."""
        return self

    def advance(self, seconds: float) -> None:
        """Lets time go on; what the device sends meanwhile waits to be read."""
        self._until(self._now + seconds)

    def read(self, timeout: float) -> bytes:
        """See Transport."""
        deadline = self._now + timeout
        while not (frames := self.device.outgoing()) and self._now < deadline:
            self._until(min(deadline, max(self.device.due, self._now)))
        return b"".join(frames)

    def write(self, data: bytes) -> None:
        """See Transport."""
        self.device.receive(data)

    def close(self) -> None:
        """See Transport; there is nothing to release."""

    def _until(self, now: float) -> None:
        self._now = now
        self.device.advance(now)
