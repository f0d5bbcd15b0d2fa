"""The dataset of plan.py, which all tests read."""

import fcntl
from pathlib import Path

import pytest

from thermograsp import dataset

from .plan import PLAN


@pytest.fixture(scope="session")
def folder(run_folder: Path) -> Path:
    """Made once in a run: the process that comes second waits for the first. Not to be written to."""
    made = run_folder / "dataset"
    with open(run_folder / "dataset.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        counts = dataset.make(PLAN, made)
    assert counts.shards == 3 and counts.found in (0, 3)
    return made
