"""Shipped agents grasp what no constant force does."""

from __future__ import annotations

from pathlib import Path

import gymnasium
import numpy as np
import pytest

import thermograsp  # noqa: F401  registers the environments
from thermograsp import agents
from thermograsp.agents.episodes import rollout
from thermograsp.agents.learning import Agent, learning_task, load_agent, score
from thermograsp.agents.policies import load_policy
from thermograsp.assets import ROOT
from thermograsp.envs import STAKES, force_window
from thermograsp.errors import InvalidValueError

SHIPPED = sorted((ROOT / "policies").glob("*.npz"))


def stakes(num_envs: int) -> gymnasium.vector.VectorEnv:
    return gymnasium.make_vec(
        "thermograsp/Grasp-v0", num_envs=num_envs, vectorization_mode="vector_entry_point", **STAKES
    )


@pytest.mark.slow
@pytest.mark.parametrize(("policy", "points"), [("trained", 15), ("feeling", 15)])
def test_who_feels_heat_beats_every_constant_force(policy: str, points: int) -> None:
    """No constant force serves more than those episodes whose windows it is in."""
    env = stakes(48)
    _, info = env.reset(seed=7)
    bodies = env.unwrapped.batch.plant.bodies  # pyright: ignore
    windows = [force_window(body) for body in bodies]
    best = max(sum(low < force < high for low, high in windows) for force in np.linspace(1, 40, 300))
    found = rollout(env, 48, 7, policy)
    assert found.successes > best + 48 * points / 100
    assert len(set(info["material"])) == 8


def test_all_that_is_shipped_is_small_and_says_how_it_was_trained() -> None:
    assert len(SHIPPED) == 4
    assert sum(path.stat().st_size for path in SHIPPED) < 1_000_000
    for path in SHIPPED:
        agent = load_agent(path)
        assert {"seed", "steps", "recipe"} <= set(agent.about)
        heat, load = (
            ("heat" if agent.inputs.heat else "no-heat"),
            ("load" if agent.inputs.load else "no-load"),
        )
        assert path.stem == f"{agent.task}_{heat}_{load}"
        card = path.with_suffix(".md").read_text(encoding="utf-8")
        assert f"thermograsp train {agent.task} " in card and f"--seed {agent.about['seed']} " in card


@pytest.mark.parametrize(("task", "most_failures"), [("grasp", 1), ("identify", 1), ("sort", 2)])
def test_shipped_agents_do_their_task(task: str, most_failures: int) -> None:
    """A constant force does it in five of eight episodes, and chance sorts right in half and identifies a tenth."""
    assert score(learning_task(task), "trained", 16, load=False).successes >= 16 - most_failures


@pytest.mark.slow
@pytest.mark.parametrize(("task", "most_failures"), [("grasp", 5), ("identify", 5), ("sort", 4)])
def test_shipped_agents_do_it_with_everything_drawn(task: str, most_failures: int) -> None:
    """In about nine of ten episodes."""
    assert score(learning_task(task).drawn(), "trained", 32, load=False).successes >= 32 - most_failures


def test_what_no_shipped_agent_was_trained_for_is_refused() -> None:
    env = gymnasium.make_vec(
        "thermograsp/Identify-v0",
        num_envs=1,
        vectorization_mode="vector_entry_point",
        material=["glass", "wood"],
    )
    with pytest.raises(InvalidValueError, match="no trained policy fits"):
        rollout(env, 1, 0, "trained")


def test_episodes_do_not_depend_on_how_many_run_at_once() -> None:
    one, two, many = (rollout(stakes(n), 4, 11, "trained", max_steps=40) for n in (1, 2, 5))
    assert one.digest == two.digest == many.digest and one.steps == many.steps


def test_what_is_no_policy_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "one.npz"
    with pytest.raises(InvalidValueError, match="no file"):
        rollout(stakes(1), 1, 0, str(path))
    path.write_bytes(b"no archive")
    with pytest.raises(InvalidValueError, match="no trained policy"):
        load_policy(path)
    np.savez(path, weights=np.zeros(3))
    with pytest.raises(InvalidValueError, match="no trained policy"):
        load_policy(path)


def test_old_names_warn_and_are_those_of_today() -> None:
    with pytest.warns(DeprecationWarning, match=r"agents\.Network is now thermograsp\.agents\.Agent"):
        assert agents.Network is Agent  # pyright: ignore[reportAttributeAccessIssue]
    with pytest.warns(DeprecationWarning, match="load_policy"):
        assert agents.load_network is load_policy  # pyright: ignore[reportAttributeAccessIssue]
