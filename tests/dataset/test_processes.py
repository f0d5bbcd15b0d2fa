"""Datasets by several processes of this machine, some of which die."""

import dataclasses
import multiprocessing
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import pytest

from thermograsp import dataset
from thermograsp.cli import main
from thermograsp.dataset import in_processes
from thermograsp.errors import InvalidValueError, MissingDependencyError, ThermograspError

from .plan import PLAN, contents

pytest.importorskip("pyarrow")


@pytest.mark.slow
def test_processes_of_this_machine_make_the_same_files(folder: Path, tmp_path: Path) -> None:
    done = []

    @contextmanager
    def watching(total: float) -> Iterator[Any]:
        assert total == PLAN.episodes
        yield lambda doing, by: done.append(by)

    assert dataset.make(PLAN, tmp_path, workers=2, progress=watching) == dataset.ShardCounts(
        shards=3, found=0
    )
    assert contents(tmp_path) == contents(folder)
    assert done == [1] * PLAN.episodes  # it moves with every episode


@pytest.mark.slow
def test_a_process_that_dies_loses_and_doubles_nothing(folder: Path) -> None:
    made: dict[str, bytes] = {}
    producing = in_processes.produce(PLAN, PLAN.shards, 1, lambda: None)
    for shard, content in producing:
        made[shard.file] = content
        for process in multiprocessing.active_children():
            process.kill()
    assert not multiprocessing.active_children()
    assert made == {name: content for name, content in contents(folder).items() if name.endswith("parquet")}


def test_what_a_process_raises_is_raised(tmp_path: Path) -> None:
    with pytest.raises(ThermograspError, match="cannot run 'thermograsp/Grasp-v9'"):
        dataset.make(dataclasses.replace(PLAN, env_id="thermograsp/Grasp-v9"), tmp_path, workers=1)
    assert not multiprocessing.active_children() and not list(tmp_path.glob("*.parquet"))


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="looks for processes in /proc")
def test_a_command_that_is_killed_with_its_processes_goes_on(folder: Path, tmp_path: Path) -> None:
    """Killed after the first file; no process of it is left, and another number of workers makes the same bytes."""
    whole = contents(folder)
    line = "dataset --episodes 7 --seed 8 --shard 3 --material glass water_gel gold".split()
    command = [sys.executable, "-m", "thermograsp", *line, "--out", str(tmp_path)]
    running = subprocess.Popen([*command, "--workers", "2"], start_new_session=True)
    try:
        while running.poll() is None and not list(tmp_path.glob("seeds-*.parquet")):
            time.sleep(0.02)
        running.kill()  # the one that writes; it can end nobody
        assert running.wait() in (-signal.SIGKILL, 0)
        for _ in range(1500):  # its processes see that it is gone when they have something to say
            if not _alive(running.pid):
                break
            time.sleep(0.02)
        assert not _alive(running.pid)
    finally:
        with suppress(ProcessLookupError):
            os.killpg(running.pid, signal.SIGKILL)
    left = {name: content for name, content in contents(tmp_path).items() if not name.startswith(".")}
    assert len(left) >= 2 and left.items() <= whole.items()
    assert main([*line, "--out", str(tmp_path), "--workers", "1"]) == 0
    assert {name: content for name, content in contents(tmp_path).items() if name in whole} == whole


def _alive(group: int) -> bool:
    """Whether any process of a group runs; those that have ended and wait to be noticed do not."""
    for path in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):  # it has just gone
            state, _, its_group = path.read_text().rpartition(")")[2].split()[:3]
            if int(its_group) == group and state != "Z":
                return True
    return False


def test_workers_without_ray(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "ray", None)
    with pytest.raises(MissingDependencyError, match=r"thermograsp\[ray\]"):
        dataset.make(PLAN, tmp_path, workers=1, address="local")
    with pytest.raises(InvalidValueError, match="needs workers"):
        dataset.make(PLAN, tmp_path, address="auto")
    with pytest.raises(InvalidValueError, match="workers must be a whole number, 0 or above"):
        dataset.make(PLAN, tmp_path, workers=-1)
