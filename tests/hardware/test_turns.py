"""Turns on a line: in the order of arrival, a stop first, and none lost by an interrupt."""

import threading
import time

import pytest

from thermograsp.hardware.lines.turns import Turns


def queued(turns: Turns, count: int) -> None:
    while len(turns._waiting) < count:
        time.sleep(0.001)


def test_a_stop_is_next_and_the_others_keep_their_order() -> None:
    turns, order = Turns(), []

    def work(name: str, first: bool) -> None:
        with turns.take(first):
            order.append(name)

    threads = []
    with turns.take():
        for count, name in enumerate(("a", "b", "c", "stop"), 1):
            threads.append(threading.Thread(target=work, args=(name, name == "stop")))
            threads[-1].start()
            queued(turns, count)
    for thread in threads:
        thread.join()
    assert order == ["stop", "a", "b", "c"]


def test_whoever_asks_again_at_once_waits_for_the_others() -> None:
    """What threading.Lock does not do: there a thread that polls keeps all others out."""
    turns, order = Turns(), []

    def poll() -> None:
        for _ in range(3):
            with turns.take():
                order.append("poll")
                queued(turns, 1) if "other" not in order else None

    def other() -> None:
        with turns.take():
            order.append("other")

    polling = threading.Thread(target=poll)
    polling.start()
    while not order:
        time.sleep(0.001)
    other()
    polling.join()
    assert order == ["poll", "other", "poll", "poll"]


def test_an_interrupted_wait_leaves_the_queue(monkeypatch: pytest.MonkeyPatch) -> None:
    turns = Turns()

    class Interrupted(threading.Event):
        def wait(self, timeout: float | None = None) -> bool:
            raise KeyboardInterrupt

    class Late(threading.Event):
        """The turn comes, and the interrupt with it."""

        def wait(self, timeout: float | None = None) -> bool:
            turns._leave()
            raise KeyboardInterrupt

    for kind in (Interrupted, Late):
        monkeypatch.setattr("thermograsp.hardware.lines.turns.threading.Event", kind)
        turns._enter(False)
        with pytest.raises(KeyboardInterrupt), turns.take():
            pass
        if kind is Interrupted:
            turns._leave()
        assert not turns._taken and not turns._waiting
