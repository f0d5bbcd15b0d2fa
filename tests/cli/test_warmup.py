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
FIRST_TOUCH = """
import logging, mujoco
from thermograsp.touch import Fingertip, ThermalTouch
logging.basicConfig(level=logging.INFO)
model = mujoco.MjModel.from_xml_string(
    '<mujoco><worldbody><body name="rod"><geom type="cylinder" size=".01 .05" euler="90 0 0"/></body>'
    '<body name="tip" pos="0 0 .0149"><joint type="slide" axis="0 0 -1" damping="20"/>'
    '<geom type="box" size=".01 .01 .005"/></body></worldbody></mujoco>'
)
data = mujoco.MjData(model)
tip = Fingertip("tip", (0, 0, -0.005), (0, 0, -1), (0.02, 0.02), skin="filled_silicone")
touch = ThermalTouch(model, fingertips={"tip": tip}, objects={"rod": "wood"})
for _ in range(20):
    mujoco.mj_step(model, data)
    touch.update(data)
assert touch.reading.touching == ("rod",)
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
    assert "compiling" not in run("-c", FIRST_TOUCH)
