"""`thermograsp warmup` does ahead what a first environment would make its user wait for."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from thermograsp.cli import main, warmup

from ..kernels import kernels, names

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
    """All that first steps ask for, it has asked for, so it is on disk; and what that is made of with it."""
    networks = {"THERMOGRASP_CACHE": str(tmp_path)}
    done = kernels("from thermograsp.cli import main; assert main(['warmup', '--json']) == 0", **networks)
    assert len(names(done)) > 40
    for first in (FIRST_STEP, FIRST_TOUCH):
        asked = kernels(first, **networks)
        assert asked and asked <= done
