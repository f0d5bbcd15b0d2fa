"""`thermograsp warmup` does ahead what a first environment would make its user wait for."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from thermograsp.cli import main, warmup

FIRST_STEP = """
import logging, gymnasium, thermograsp
logging.basicConfig(level=logging.INFO)
for name in ("Grasp-v0", "Identify-v0", "Sort-v0"):
    env = gymnasium.make("thermograsp/" + name)
    env.reset(seed=3)
    env.step(env.action_space.sample())
"""


def test_every_stage_is_done_and_told(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    done: list[str] = []
    stages = {name: lambda name=name: done.append(name) for name in warmup.stages()}
    monkeypatch.setattr(warmup, "stages", lambda: stages)
    assert main(["warmup", "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)["stages"]
    assert [one["stage"] for one in printed] == done == list(stages)
    assert all(one["seconds"] >= 0 for one in printed)
    assert main(["warmup"]) == 0
    shown = capsys.readouterr().out
    assert all(name in shown for name in stages) and done == 2 * list(stages)


@pytest.mark.slow
def test_after_it_nothing_is_compiled(tmp_path: Path) -> None:
    environment = {
        **os.environ,
        "NUMBA_CACHE_DIR": str(tmp_path / "code"),
        "THERMOGRASP_CACHE": str(tmp_path / "networks"),
    }

    def run(*words: str) -> str:
        return subprocess.run(
            [sys.executable, *words], env=environment, check=True, capture_output=True, text=True
        ).stderr

    run("-m", "thermograsp", "warmup", "--json")
    assert "compiling" not in run("-c", FIRST_STEP)
