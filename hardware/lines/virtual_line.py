"""A line to an emulated device in virtual time: nothing waits, and everything happens in one thread, in one order."""

from __future__ import annotations

from collections import deque
from typing import Generic

from thermograsp.errors import non_negative

from .emulated import Device


class VirtualLine(Generic[Device]):
    """The opener, transport and clock of a driver in virtual time: Fingertips(line.open, clock=line.clock,
    background=False).

    Time goes on by `advance`, and while the driver waits for an answer. The driver's clock follows as it reads: each
    frame comes at the moment when the device sent it.
    """

    def __init__(self, device: Device) -> None:
        self.device = device
        self._now = self._read = 0.0
        self._sent: deque[tuple[float, bytes]] = deque()

    def clock(self) -> float:
        """Virtual time, s, up to which the driver has read."""
        return self._read

    @property
    def now(self) -> float:
        """Virtual time, s, up to which the device has acted."""
        return self._now

    def open(self) -> VirtualLine:
        """The line itself: it has two ends only."""
        return self

    def advance(self, seconds: float) -> None:
        """Lets time go on; what the device sends meanwhile waits to be read. Raises InvalidValueError for a time that
        does not go on."""
        self._until(self._now + non_negative("seconds", seconds))

    def read(self, timeout: float) -> bytes:
        """See Transport."""
        deadline = self._now + timeout
        while not self._sent and self._now < deadline:
            self._until(min(deadline, self.device.due))
        self._read, data = self._sent.popleft() if self._sent else (self._now, b"")
        return data

    def write(self, data: bytes) -> None:
        """See Transport."""
        self.device.receive(data)
        self._collect()

    def close(self) -> None:
        """See Transport; there is nothing to release."""

    def _until(self, now: float) -> None:
        while (due := self.device.due) < now:
            self.device.advance(due)
            self._now = max(self._now, due)
            self._collect()
        self._now = max(self._now, now)
        self.device.advance(self._now)
        self._collect()

    def _collect(self) -> None:
        self._sent.extend((self._now, frame) for frame in self.device.outgoing())
