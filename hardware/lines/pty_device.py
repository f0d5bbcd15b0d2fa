"""An emulated device in real time on a pseudo-terminal, which any serial driver opens. Linux and macOS."""

from __future__ import annotations

import os
import secrets
import select
import threading
import time
from contextlib import AbstractContextManager, suppress
from pathlib import Path
from typing import Generic

from thermograsp.errors import InvalidValueError

from .emulated import Device

_LONGEST_WAIT = 0.05  # s
_SHORTEST_WAIT = 0.0005  # s
_CHUNK = 4096


class PtyDevice(Generic[Device]):
    """Serves an emulated device on a pseudo-terminal until `close` or the end of its `with` block. path: of the port.
    link: a stable name to create for it; an existing link of that name is replaced. The device's time 0 is when this
    object was created.

    A host that doesn't read fills the kernel's buffer; then the device drops whole samples, as a real one does. Use
    `with served.paused():` around whatever changes the device. Raises InvalidValueError for a link that cannot be.
    """

    def __init__(self, device: Device, link: str | os.PathLike[str] | None = None) -> None:
        self.device = device
        self.link = None if link is None else Path(link)
        if self.link is not None and self.link.exists() and not self.link.is_symlink():
            raise InvalidValueError(f"{link} exists and is not a link; choose another name or remove it")
        if self.link is not None and not self.link.parent.is_dir():
            raise InvalidValueError(f"there is no folder {self.link.parent}; create it first")
        self._begun = time.monotonic()
        self._pending = b""
        self._lock = threading.RLock()
        self._closing = False
        self._failure: Exception | None = None
        self._ends: tuple[int, int] | None = None
        self._terminal = ""
        self._wake_read, self._wake_write = os.pipe()
        self.plug()
        self._thread = threading.Thread(target=self._serve, name="pty device", daemon=True)
        self._thread.start()

    def __enter__(self) -> PtyDevice:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def path(self) -> str:
        """The stable name where there is one, else the port's own."""
        return self._terminal if self.link is None else str(self.link)

    @property
    def now(self) -> float:
        """The device's time, s."""
        return time.monotonic() - self._begun

    def paused(self) -> AbstractContextManager[bool]:
        """Held while the device's state is changed."""
        return self._lock

    def plug(self) -> None:
        """Makes the port, again after `unplug`, maybe under another number."""
        import pty
        import tty

        with self._lock:
            master, slave = pty.openpty()
            for end in (master, slave):
                tty.setraw(end)
            os.set_blocking(master, False)
            self._ends = (master, slave)
            self._terminal = os.ttyname(slave)
            self._pending = b""
            if self.link is not None:
                fresh = self.link.with_name(f".{secrets.token_hex(8)}")
                fresh.symlink_to(self._terminal)
                os.replace(fresh, self.link)
        os.write(self._wake_write, b"!")

    def unplug(self) -> None:
        """Takes the port away under whoever has it open; the device itself keeps its power."""
        with self._lock:
            self._drop()
        os.write(self._wake_write, b"!")

    def close(self) -> None:
        """Ends the thread, removes port and link, and raises what broke the thread, such as an error of the device's
        source. Does nothing the second time."""
        if self._closing:
            return
        self._closing = True
        os.write(self._wake_write, b"!")
        self._thread.join()
        self._drop()
        os.close(self._wake_read)
        os.close(self._wake_write)
        if self._failure is not None:
            raise self._failure

    def _drop(self) -> None:
        if self._ends is None:
            return
        for end in self._ends:
            os.close(end)
        self._ends = None
        if self.link is not None:
            self.link.unlink(missing_ok=True)

    def _serve(self) -> None:
        try:
            self._work()
        except Exception as error:  # noqa: BLE001  (raised by close)
            self._failure = error
            self.unplug()

    def _work(self) -> None:
        while not self._closing:
            with self._lock:
                master = self._step()
                wait = min(max(self.device.due - self.now, _SHORTEST_WAIT), _LONGEST_WAIT)
            watched = [self._wake_read] if master is None else [self._wake_read, master]
            writing = [master] if self._pending and master is not None else []
            try:
                ready, _, _ = select.select(watched, writing, [], wait)
            except OSError:  # unplugged while waiting
                continue
            if self._wake_read in ready:
                os.read(self._wake_read, _CHUNK)

    def _step(self) -> int | None:
        """Moves bytes both ways; the end to wait for."""
        self.device.advance(self.now)
        if self._ends is None:
            self.device.outgoing()  # into the air
            return None
        master = self._ends[0]
        with suppress(BlockingIOError):
            self.device.receive(os.read(master, _CHUNK))
        if not self._pending:
            self._pending = b"".join(self.device.outgoing())
        if self._pending:
            with suppress(BlockingIOError):
                self._pending = self._pending[os.write(master, self._pending) :]
        return master
