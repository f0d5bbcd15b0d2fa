"""The task Thermograsp-Keep-Cube-Yam: the hand feels its cube, and keeps it or lets it go; its example trains."""

# this package is installed in the environment of make test-mjlab alone
# pyright: reportMissingImports=false, reportAttributeAccessIssue=false

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("mjlab", reason="mjlab is not installed: make test-mjlab installs it")

import mjlab.tasks  # noqa: F401  (registers the tasks)
import torch
from mjlab.envs import ManagerBasedRlEnv
from mjlab.tasks.registry import load_env_cfg

EXAMPLE = Path(__file__).parents[2] / "examples" / "train_keep_cube.py"
WORLDS = 16


@pytest.fixture(scope="module")
def env() -> Any:
    cfg = load_env_cfg("Thermograsp-Keep-Cube-Yam")
    cfg.scene.num_envs, cfg.seed, cfg.auto_reset = WORLDS, 1, False
    return ManagerBasedRlEnv(cfg, device="cpu")


def test_each_reset_draws_the_material_and_what_is_asked_for(env: Any) -> None:
    command, touch = env.command_manager.get_term("keep"), env.scene["touch"]
    drawn = set()
    for _ in range(4):
        observation, _ = env.reset()
        drawn |= set(zip(command.requested.tolist(), touch.material[:, 0].tolist(), strict=True))
        goal = torch.nn.functional.one_hot(command.requested, 2).float()
        assert torch.equal(observation["actor"][:, 4:6], goal)
        assert torch.equal(observation["actor"][:, 6:], touch.data.voltage.flatten(1))
    assert len(drawn) == 4


def test_it_holds_the_cube_and_feels_it_whatever_it_is_told_first(env: Any) -> None:
    env.reset()
    touch = env.scene["touch"]
    action = torch.ones(WORLDS, 1)
    action[::2] = -1.0
    _, reward, *_ = env.step(action)
    assert (touch.data.force > 1.0).all()
    assert not reward.any()  # nothing has been decided yet
    aluminium = touch.material[:, 0] == 0
    assert aluminium.any() and not aluminium.all()
    drop = touch.data.temperature_drop
    assert float(drop[aluminium].min()) > 2 * float(drop[~aluminium].max()) > 0


def test_then_it_keeps_the_cube_or_lets_it_go_and_is_paid_for_what_was_asked(env: Any) -> None:
    env.reset()
    command, touch = env.command_manager.get_term("keep"), env.scene["touch"]
    matches = touch.material[:, 0] == command.requested
    action = torch.ones(WORLDS, 1)
    env.step(action)
    action[::2] = -1.0
    _, reward, terminated, late, _ = env.step(action)
    kept = action[:, 0] > 0
    assert torch.equal((touch.data.force > 1.0).all(-1), kept)
    assert torch.equal(reward, (kept == matches).float())
    assert late.all() and not terminated.any()


@pytest.mark.parametrize("words", [[], ["--without-heat"]])
def test_the_example_trains_and_counts_its_successes(tmp_path: Path, words: list[str]) -> None:
    words = [*words, "--worlds", "4", "--iterations", "2", "--rounds", "1", "--out", str(tmp_path)]
    run = subprocess.run([sys.executable, EXAMPLE, *words], capture_output=True, text=True, timeout=3000)
    assert run.returncode == 0, run.stderr
    assert list(tmp_path.glob("model_*.pt"))
    observed = 6 if "--without-heat" in words else 18
    assert f"in_features={observed}," in run.stdout
    assert re.search(r"^kept or let go as asked in .*% of 4 episodes$", run.stdout, re.MULTILINE)
