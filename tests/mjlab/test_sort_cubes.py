"""The task Thermograsp-Sort-Cube-Yam: made by its name, stepped, reset; its example starts training."""

# this package is installed in the environment of make test-mjlab alone
# pyright: reportMissingImports=false, reportAttributeAccessIssue=false

from __future__ import annotations

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

TASK = "Thermograsp-Sort-Cube-Yam"
EXAMPLE = Path(__file__).parents[2] / "examples" / "train_sort_cube.py"
WORLDS = 8


@pytest.fixture(scope="module")
def env() -> Any:
    cfg = load_env_cfg(TASK)
    cfg.scene.num_envs, cfg.seed = WORLDS, 1
    return ManagerBasedRlEnv(cfg, device="cpu")


@pytest.mark.parametrize("first", ["mjlab", "thermograsp.mjlab.sensor"])
def test_mjlab_lists_it_whatever_is_imported_first(first: str) -> None:
    code = f"import {first}; from mjlab.tasks.registry import list_tasks; assert {TASK!r} in list_tasks()"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=900)
    assert run.returncode == 0, run.stderr
    assert "Failed to load" not in run.stderr


def test_each_reset_draws_which_cube_is_of_what_and_what_is_asked_for(env: Any) -> None:
    command, touch = env.command_manager.get_term("lift_height"), env.scene["touch"]
    drawn, observation = set(), {}
    for _ in range(4):
        observation, _ = env.reset()
        assert (touch.material.sort(-1).values == torch.arange(2)).all()  # one of each
        rows = torch.arange(WORLDS)
        assert torch.equal(command.requested, touch.material[rows, command.target_selection])
        drawn |= set(zip(command.requested.tolist(), command.target_selection.tolist(), strict=True))
    assert len(drawn) == 4
    one_hot = torch.nn.functional.one_hot(command.requested, 2).float()
    assert torch.equal(observation["actor"][:, -34:-32], one_hot)
    cube = torch.nn.functional.one_hot(command.target_selection, 2).float()
    assert torch.equal(observation["critic"][:, -2:], cube)
    assert observation["critic"].shape[1] == observation["actor"].shape[1] + 2


def test_it_steps_and_pays_for_the_cube_that_is_asked_for(env: Any) -> None:
    env.reset()
    command = env.command_manager.get_term("lift_height")
    action = torch.zeros(WORLDS, env.action_manager.total_action_dim)
    for number, cube in enumerate(command.cubes):  # one cube at its goal, and the other on the floor
        pose = torch.cat((command.target_pos, cube.data.root_link_quat_w), 1)
        cube.write_root_link_pose_to_sim(pose)
        cube.write_root_link_velocity_to_sim(torch.zeros(WORLDS, 6))
        observation, reward, *_ = env.step(action)
        assert observation["actor"].isfinite().all() and reward.shape == (WORLDS,)
        wanted = command.target_selection == number
        at_goal = command.metrics["position_error"] < 0.05
        assert at_goal[wanted].all()
        if number == 0:
            assert not at_goal[~wanted].any()


def test_the_example_starts_training(tmp_path: Path) -> None:
    words = ["--worlds", "4", "--iterations", "2", "--out", str(tmp_path)]
    run = subprocess.run([sys.executable, EXAMPLE, *words], capture_output=True, text=True, timeout=3000)
    assert run.returncode == 0, run.stderr
    assert list(tmp_path.glob("model_*.pt"))
    assert "Learning iteration" in run.stdout
