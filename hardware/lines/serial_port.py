"""A serial port as a transport, on pyserial, and the ports of this machine."""

from __future__ import annotations

import errno
import logging
import os
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from thermograsp.errors import MissingDependencyError, install

from ..errors import (
    LinkLostError,
    PortBusyError,
    PortError,
    PortForbiddenError,
    PortMissingError,
)

_LOG = logging.getLogger(__name__)
BAUD = 500_000  # a 16 MHz AVR meets it exactly; 115200 is 2.1 % off there
_READ_WITHIN = 0.02  # s; to change it later costs several system calls each time
_OLD_WITHIN = 0.05  # s after the opening, in which bytes that waited have come
_WRITE_WITHIN = 0.25  # s, for a frame that takes about 1 ms
_BY_ID = Path("/dev/serial/by-id")


def _serial() -> Any:
    try:
        import serial
    except ImportError:
        raise MissingDependencyError(
            f"a serial port needs pyserial, which is not installed: {install('hardware')}"
        ) from None
    return serial


def _lost() -> tuple[type[BaseException], ...]:
    """What pyserial lets through when a device is unplugged or its port closed by another thread."""
    kinds: tuple[type[BaseException], ...] = (OSError, TypeError)
    with suppress(ImportError):  # not on Windows
        import termios

        kinds += (termios.error,)
    return kinds


class SerialPort:
    """An open serial port, locked against other programs that ask for a lock. Raises PortError or one of its kinds."""

    def __init__(self, path: str, baud: int = BAUD) -> None:
        serial = _serial()
        self.path = path
        self._lost = _lost()
        try:
            self._port = serial.Serial(
                path, baud, timeout=_READ_WITHIN, write_timeout=_WRITE_WITHIN, exclusive=True
            )
        except (*self._lost, ValueError) as error:
            raise _open_error(path, baud, error) from error
        self._ask_for_low_latency()
        try:
            self._discard()
        except LinkLostError:
            self.close()
            raise

    def read(self, timeout: float) -> bytes:
        """See Transport; never waits longer than 0.02 s, nor, unless timeout is 0, for less."""
        try:
            waiting = self._port.in_waiting
            if not waiting and not timeout:
                return b""
            data = self._port.read(max(1, waiting))
            if len(data) == 1 and (more := self._port.in_waiting):
                data += self._port.read(more)
            return data
        except self._lost as error:
            raise self._lost_error(error) from error

    def write(self, data: bytes) -> None:
        """See Transport."""
        try:
            self._port.write(data)
        except self._lost as error:
            raise self._lost_error(error) from error

    def close(self) -> None:
        """See Transport."""
        with suppress(*self._lost):
            self._port.close()

    def _discard(self) -> None:
        """Drops what came while nobody listened and waits in the adapter or the system: its samples would seem new."""
        until = time.monotonic() + _OLD_WITHIN
        while time.monotonic() < until:
            self.read(_READ_WITHIN)

    def _ask_for_low_latency(self) -> None:
        """An FTDI adapter holds bytes back for 16 ms otherwise; most others have no such mode."""
        mode = getattr(self._port, "set_low_latency_mode", None)  # none in pyserial on Windows
        if mode is None:
            return
        try:
            mode(True)
        # of another system than Linux; refused by the port
        except (NotImplementedError, ValueError) as error:
            _LOG.info("%s: bytes may come late, it has no low latency mode (%s)", self.path, error)

    def _lost_error(self, error: BaseException) -> LinkLostError:
        return LinkLostError(
            f"{self.path}: the line is lost ({error}); is the device plugged in and powered?"
        )


def _open_error(path: str, baud: int, error: BaseException) -> PortError:
    code = getattr(error, "errno", None)
    if isinstance(error.__context__, OSError) and code is None:
        code = error.__context__.errno
    if code in (errno.ENOENT, errno.ENODEV, errno.ENXIO) or not os.path.exists(path):
        return PortMissingError(
            f"{path}: there is no such port; plug the device in, or look for its name with "
            "`thermograsp device list`"
        )
    if code in (errno.EBUSY, errno.EAGAIN):
        return PortBusyError(f"{path}: another program has this port; close it")
    if code in (errno.EACCES, errno.EPERM):
        return PortForbiddenError(
            f"{path}: this user may not open it; join the group that owns it (dialout on Debian), log in again"
        )
    return PortError(f"{path}: cannot open it at {baud} baud: {error}")


@dataclass(frozen=True, slots=True)
class PortInfo:
    """A serial port of this machine. path: a name that stays when the device is plugged in again, where the system has
    one. device: the port itself. description: what the adapter calls itself."""

    path: str
    device: str
    description: str


def ports() -> list[PortInfo]:
    """The serial ports of this machine, except pseudo-terminals. Raises MissingDependencyError without pyserial."""
    _serial()
    from serial.tools import list_ports

    stable = {str(link.resolve()): str(link) for link in sorted(_BY_ID.glob("*"))}
    return [
        PortInfo(stable.get(os.path.realpath(port.device), port.device), port.device, port.description)
        for port in sorted(list_ports.comports())
    ]
