"""What takes long says so: on a terminal in one line, in the log otherwise."""

from __future__ import annotations

import io
import logging
import threading
import time

import pytest

from thermograsp import notice


class Terminal(io.StringIO):
    """Somebody's."""

    def isatty(self) -> bool:
        """It is one."""
        return True


def wait_for_notice(noticed: threading.Event) -> None:
    """Work that goes on until it has been said."""
    with notice.busy("building"):
        assert noticed.wait(30.0)


def test_on_a_terminal_one_line_says_what_takes_long(monkeypatch: pytest.MonkeyPatch) -> None:
    noticed = threading.Event()

    class Watched(Terminal):
        def flush(self) -> None:
            noticed.set()

    stream = Watched()
    monkeypatch.setattr("sys.stderr", stream)
    monkeypatch.setattr(notice, "PATIENCE", 0.0)
    wait_for_notice(noticed)
    assert stream.getvalue() == "thermograsp: building ...\n"


def test_elsewhere_the_log_says_it(monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO, "thermograsp")
    monkeypatch.setattr(notice, "PATIENCE", 0.0)
    with notice.busy("building"):
        until = time.monotonic() + 30.0
        while not caplog.records and time.monotonic() < until:
            time.sleep(0.001)
    assert [record.getMessage() for record in caplog.records] == ["building ..."]
    assert caplog.records[0].name == "thermograsp.notice"


def test_what_is_done_soon_says_nothing_and_leaves_no_thread(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.INFO, "thermograsp")
    monkeypatch.setattr(notice, "PATIENCE", 1e6)
    stream = Terminal()
    monkeypatch.setattr("sys.stderr", stream)
    before = threading.active_count()
    with pytest.raises(ZeroDivisionError), notice.busy("building"):
        _ = 1 / 0
    assert threading.active_count() == before and not stream.getvalue() and not caplog.records


def test_a_closed_stderr_is_no_reason_to_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = io.StringIO()
    stream.close()
    monkeypatch.setattr("sys.stderr", stream)
    notice.notice("building ...")
    monkeypatch.setattr("sys.stderr", None)
    notice.notice("building ...")
