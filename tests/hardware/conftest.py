"""The firmware in a simulator, where its tools are installed; no pauses in what runs in real time."""

import fcntl
import gc
from collections.abc import Iterator
from pathlib import Path

import pytest

from .board import Board, build, require_tools


@pytest.fixture(autouse=True)
def _no_pauses() -> Iterator[None]:
    """Python searches for cycles only between these tests: after thousands of others that takes most of a second, in
    which an emulated device in the same process does not answer."""
    gc.disable()
    yield
    gc.enable()


@pytest.fixture(scope="session")
def made(run_folder: Path) -> tuple[Path, str]:
    """Built once in a run: the process that comes second waits for the first."""
    require_tools()
    folder, said = run_folder / "firmware", run_folder / "firmware.txt"
    with open(run_folder / "firmware.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not said.exists():
            folder.mkdir(exist_ok=True)
            said.write_text(build(folder)[1])
    return folder, said.read_text()


@pytest.fixture
def board(made: tuple[Path, str]) -> Iterator[Board]:
    one = Board(made[0])
    yield one
    one.close()
