"""A session in a process of its own: one visitor's load, memory and mishaps are not another's."""

from __future__ import annotations

import json
import multiprocessing
import signal
import sys
import time
from collections.abc import Sequence
from multiprocessing.connection import Connection, wait
from typing import Any

from thermograsp.envs.sensing import start_compiling
from thermograsp.errors import SimulationError
from thermograsp.studio.control import Choices, Stock

_LEAVING = 2.0  # s that a process is given to end by itself
_PRELOADED = ["thermograsp.studio.session.session"]


class Worker:
    """A running process with a session. `exchange` blocks; call it from one thread at a time."""

    def __init__(self, stock: Stock, choices: Choices) -> None:
        context = _context()
        self._pipe, far_end = context.Pipe()
        leaving, self._stay = context.Pipe(duplex=False)  # its other end shows that we leave
        self._process = context.Process(target=_serve, args=(far_end, leaving, stock, choices), daemon=True)
        try:
            self._process.start()
        except BaseException:
            self._pipe.close()
            self._stay.close()
            raise
        finally:
            far_end.close()
            leaving.close()

    @property
    def pid(self) -> int | None:
        """The process's number."""
        return self._process.pid

    def exchange(self, messages: Sequence[dict[str, Any]]) -> list[str]:
        """Hands over the visitor's messages, lets the time since the last call pass, and returns what the page is to
        hear, as JSON. Raises SimulationError where the process has ended."""
        try:
            self._pipe.send(list(messages))
            return self._pipe.recv()
        except (EOFError, OSError) as error:
            self._process.join(_LEAVING)
            code = self._process.exitcode
            raise SimulationError(f"the simulation has ended unexpectedly (exit code {code})") from error

    def stop(self) -> None:
        """Has the session closed and the process end, by force where it does not; may be called while another thread
        waits in `exchange`."""
        self._stay.close()
        for force in (self._process.terminate, self._process.kill):
            self._process.join(_LEAVING)
            if self._process.is_alive():
                force()
        self._process.join()
        self._pipe.close()


def warm_up() -> None:
    """Loads what a session needs, once for all that follow, where the system can hand it on. What is not compiled yet
    begins to be."""
    start_compiling(boxes=False)
    context = _context()
    process = context.Process(target=int, daemon=True)
    process.start()
    process.join()


def _context() -> Any:
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(_PRELOADED)
    return context


def _serve(pipe: Connection, leaving: Connection, stock: Stock, choices: Choices) -> None:
    """Answers until the other end of either is gone, and closes the session, which may hold ports of a gripper."""
    from thermograsp.studio.session import Session

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the server, which then closes the pipes
    signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(128 + number))  # by way of `finally`
    session = Session(stock, choices)
    last = time.monotonic()
    try:
        while True:
            ready = wait([pipe, leaving], 0.0 if session.paced else None)
            if leaving in ready:
                break
            requested = pipe in ready
            messages = pipe.recv() if requested else ()
            for message in messages:
                session.handle(message)
            preparing, now = session.preparing, time.monotonic()
            session.advance(now - last)
            last = time.monotonic() if preparing else now  # what took long to set up begins at its beginning
            if requested:
                pipe.send([json.dumps(message, separators=(",", ":")) for message in session.messages()])
    except (EOFError, OSError):
        pass
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)  # it is closing; what hangs is killed
        session.close()
