"""Work that makes somebody wait says so: one line on a terminal, the log otherwise."""

from __future__ import annotations

import logging
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

PATIENCE = 1.0  # s that nothing is said

_LOG = logging.getLogger(__name__)


@contextmanager
def busy(doing: str) -> Iterator[None]:
    """Says what is being done where the block takes longer than PATIENCE. doing: as in "building the networks"."""
    timer = threading.Timer(PATIENCE, notice, (f"{doing} ...",))
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()  # a thread of it is never left behind


def notice(text: str) -> None:
    """One line on stderr where that is a terminal, a log record of level INFO otherwise."""
    try:
        on_terminal = sys.stderr is not None and sys.stderr.isatty()
    except ValueError:  # it was closed
        on_terminal = False
    if on_terminal:
        print(f"thermograsp: {text}", file=sys.stderr, flush=True)
    else:
        _LOG.info(text)
