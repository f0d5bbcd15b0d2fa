"""Whose turn it is on a line that several threads use: in the order in which they come, a stop before all who wait."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager


class Turns:
    """A lock that is handed over: whoever gives it back and asks again at once does not get it before those who wait,
    as with threading.Lock. Take a turn for one transaction on the line at most."""

    def __init__(self) -> None:
        self._guard = threading.Lock()
        self._waiting: deque[threading.Event] = deque()
        self._taken = False

    @contextmanager
    def take(self, first: bool = False) -> Iterator[None]:
        """A turn for the block. first: it is the next one, whoever else waits."""
        self._enter(first)
        try:
            yield
        finally:
            self._leave()

    def _enter(self, first: bool) -> None:
        with self._guard:
            if not self._taken:
                self._taken = True
                return
            turn = threading.Event()
            (self._waiting.appendleft if first else self._waiting.append)(turn)
        try:
            turn.wait()
        except BaseException:  # such as Ctrl-C
            with self._guard:
                waiting = turn in self._waiting
                if waiting:
                    self._waiting.remove(turn)
            if not waiting:  # the turn has come meanwhile
                self._leave()
            raise

    def _leave(self) -> None:
        with self._guard:
            if self._waiting:
                self._waiting.popleft().set()
            else:
                self._taken = False
