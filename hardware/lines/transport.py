"""What carries bytes between a driver and a device: a serial port, a virtual line, or anything else of this form."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol


class Transport(Protocol):
    """Both directions of a line. Every method but close raises LinkLostError when the other side is gone."""

    def read(self, timeout: float) -> bytes:
        """What has come, without waiting for more; where nothing has, waits up to about timeout s. b"": nothing."""
        ...

    def write(self, data: bytes) -> None:
        """Sends all of it."""
        ...

    def close(self) -> None:
        """Releases the line; does nothing the second time."""
        ...


Opener = Callable[[], Transport]
"""Opens a line, and again after it was lost."""
