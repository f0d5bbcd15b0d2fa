"""The time that a serial plant keeps: the host's, or that of virtual lines."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Protocol

from ..lines import VirtualLine


class Pace(Protocol):
    """Times in s."""

    def now(self) -> float:
        """What time it is."""
        ...

    def until(self, when: float) -> None:
        """Waits for that time; returns at once where it has passed."""
        ...


class RealTime:
    """The host's monotonic clock."""

    def now(self) -> float:
        """See Pace."""
        return time.monotonic()

    def until(self, when: float) -> None:
        """See Pace."""
        left = when - time.monotonic()
        if left > 0:
            time.sleep(left)


class VirtualTime:
    """Lets time go on for several virtual lines together. The first one tells what time it is and is moved last, so
    that it meets what the others have done; one that is ahead, as after an answer that took its time, is waited for."""

    def __init__(self, lines: Sequence[VirtualLine]) -> None:
        self._lines = tuple(lines)

    def now(self) -> float:
        """See Pace."""
        return self._lines[0].now

    def until(self, when: float) -> None:
        """See Pace."""
        for line in reversed(self._lines):
            if when > line.now:
                line.advance(when - line.now)
