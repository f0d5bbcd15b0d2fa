"""An emulated device on a pseudo-terminal and an impatient driver for tests, and what they leave behind."""

import gc
import os
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from thermograsp.hardware import (
    EmulatedFingertips,
    Fingertips,
    LinkSettings,
    PtyDevice,
)
from thermograsp.hardware.errors import DeviceError

PATIENCE = 1.0  # s, in which a fault is repaired or told
COMING = 10.0  # s, in which samples come that are due, also where the machine is busy
QUICK = LinkSettings(open_within=0.7, stale_after=0.25, reopen_every=0.02)


@contextmanager
def serving(folder: Path, device: EmulatedFingertips | None = None) -> Iterator[PtyDevice]:
    with PtyDevice(device or EmulatedFingertips(), folder / "fingertips") as served:
        yield served


def driver(served: PtyDevice, **keywords: Any) -> Fingertips:
    return Fingertips(served.path, **{"rate": 200, "settings": QUICK, **keywords})


@contextmanager
def plugged_elsewhere(served: PtyDevice, before: str) -> Iterator[None]:
    """The unplugged device is back under another number than `before`, whoever else opens and closes terminals."""
    held = list(os.openpty())  # mostly the old number
    try:
        served.plug()
        while os.readlink(served.path) == before:
            served.unplug()
            held += os.openpty()
            served.plug()
        yield
    finally:
        for end in held:
            os.close(end)


@contextmanager
def nothing_left() -> Iterator[None]:
    """The block leaves no thread, no descriptor; what an earlier test left to the collector does not count."""
    threads, files = set(threading.enumerate()), descriptors()
    gc.freeze()  # what lives now is never searched again: that took most of a second in a run of all tests
    yield
    deadline = time.monotonic() + 1.0
    while set(threading.enumerate()) - threads and time.monotonic() < deadline:
        time.sleep(0.01)
    assert not set(threading.enumerate()) - threads
    assert not descriptors() - files


def descriptors() -> Counter[str]:
    """What this process holds open, and how often."""
    gc.collect()
    held: Counter[str] = Counter()
    for number in os.listdir("/proc/self/fd"):
        with suppress(FileNotFoundError):  # the listing's own
            held[os.readlink(f"/proc/self/fd/{number}")] += 1
    return held


def error_within(act: Callable[[], object], kind: type[DeviceError]) -> DeviceError:
    """The error that `act`, again and again, raises in time."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        try:
            act()
        except kind as error:
            return error
        except DeviceError:  # what comes before it
            pass
        time.sleep(0.002)
    raise AssertionError(f"no {kind.__name__} within {PATIENCE} s")


def healthy_within(tips: Fingertips) -> None:
    """Samples come again in time."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        try:
            if len(tips.take()):
                return
        except DeviceError:
            pass
        time.sleep(0.002)
    raise AssertionError(f"no sample within {PATIENCE} s")
