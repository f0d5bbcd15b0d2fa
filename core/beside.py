"""Processes that compile at once compile nothing twice, and a second process that compiles beside the first one."""

from __future__ import annotations

import atexit
import contextlib
import importlib
import os
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

ALONE = "THERMOGRASP_COMPILE_ALONE"
"""The variable that forbids second processes. They have it, so that none of them starts another."""

_PATIENCE = 120.0  # s to wait for another process, which may have been stopped
_PAUSE = 0.005  # s
_LOCK = "compiling.lock"
_OPEN: dict[str, int] = {}
"""Descriptors of lock files. They stay open: to close one would end all that this process holds in the file."""


@contextmanager
def turn(folder: str, number: int, wait: bool = True) -> Iterator[bool]:
    """A block that one process enters at a time for that number >= 0 and that folder. wait=False: whoever would have to
    wait enters at once. Yields whether it is this process's turn: not where another process takes longer than two
    minutes, nor where the system or the folder has no locks; nobody waits there.

    The system frees what a process held when it ends in whatever way."""
    handle = _handle(folder)
    if handle is None or fcntl is None:
        yield False
        return
    until = time.monotonic() + (_PATIENCE if wait else 0.0)
    taken = False
    while not taken:
        try:
            fcntl.lockf(handle, fcntl.LOCK_EX | fcntl.LOCK_NB, 1, number)
            taken = True
        except (BlockingIOError, PermissionError):  # another process's turn
            if time.monotonic() >= until:
                break
            time.sleep(_PAUSE)
        except OSError:  # a network drive without locks
            break
    try:
        yield taken
    finally:
        if taken:
            with suppress(OSError):
                fcntl.lockf(handle, fcntl.LOCK_UN, 1, number)


def _handle(folder: str) -> int | None:
    if folder not in _OPEN:
        try:
            _OPEN[folder] = os.open(os.path.join(folder, _LOCK), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
        except (OSError, AttributeError):  # not there, not writable, or not POSIX
            return None
    return _OPEN[folder]


def start_beside(module: str, folder: str, function: str = "compile_ahead") -> None:
    """Starts a second process that calls a function of a module, and ends with it or with this process.

    None is started where $THERMOGRASP_COMPILE_ALONE is set, where there is one processor, where Python is part of a
    frozen program, where processes cannot take turns in the folder, or where one is at work already."""
    frozen = not sys.executable or getattr(sys, "frozen", False)  # it would be the program again, not Python
    if frozen or os.environ.get(ALONE) or _processors() < 2:
        return
    with turn(folder, 0, wait=False) as free:
        if not free:
            return
    code = f"from thermograsp.beside import _main; _main({module!r}, {folder!r}, {function!r})"
    try:
        process = subprocess.Popen(
            [sys.executable, "-P", "-W", "ignore", "-c", code],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={**os.environ, ALONE: "1", "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)},
        )
    except OSError:  # no more processes here, or no interpreter: this one compiles alone
        return
    atexit.register(_end, process)


def _end(process: subprocess.Popen[bytes]) -> None:
    process.kill()
    process.wait()
    if process.stdin is not None:
        with suppress(OSError):
            process.stdin.close()


def _processors() -> int:
    """How many this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _main(module: str, folder: str, function: str) -> None:
    """The second process."""
    threading.Thread(target=_end_with_parent, daemon=True).start()
    with turn(folder, 0, wait=False) as free:
        if free:
            getattr(importlib.import_module(module), function)()


def _end_with_parent() -> None:
    with contextlib.closing(sys.stdin):
        sys.stdin.buffer.read()
    os._exit(0)
