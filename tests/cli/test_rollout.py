"""`thermograsp rollout`: one digest a seed, however many run at once; checks that catch what is wrong."""

import json
from types import SimpleNamespace
from typing import Any

import gymnasium
import numpy as np
import pytest

from thermograsp.agents.checks import violations
from thermograsp.cli import main

ENV = "thermograsp/Grasp-v0"


def rollout(line: str, capsys: pytest.CaptureFixture[str]) -> dict[str, Any]:
    assert main(["rollout", *line.split(), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_scripted_episodes_succeed_and_pass_the_checks(capsys: pytest.CaptureFixture[str]) -> None:
    summary = rollout(f"{ENV} --episodes 3 --num-envs 3 --check", capsys)
    assert summary["success_rate"] == 1.0 and summary["checked"] and summary["violations"] == []


@pytest.mark.parametrize("policy", ["scripted", "random", "zero"])
def test_the_digest_depends_on_the_seed_alone(policy: str, capsys: pytest.CaptureFixture[str]) -> None:
    line = f"{ENV} --episodes 3 --max-steps 60 --policy {policy} --seed 7"
    one, two, many = (rollout(f"{line} --num-envs {n}", capsys) for n in (1, 2, 5))
    assert one["digest"] == two["digest"] == many["digest"]
    assert one["steps"] == two["steps"] == many["steps"] == 180
    assert one["mean_return"] == many["mean_return"]
    other = rollout(f"{ENV} --episodes 3 --max-steps 60 --policy {policy} --seed 8", capsys)
    assert other["digest"] != one["digest"]


def test_stakes_are_those_of_the_package(capsys: pytest.CaptureFixture[str]) -> None:
    line = f"{ENV} --stakes --episodes 16 --num-envs 16"
    assert rollout(f"{line} --policy feeling", capsys)["successes"] == 16
    assert rollout(f"{line} --policy scripted", capsys)["successes"] < 14  # 10 N, whatever it is
    assert main(["rollout", "thermograsp/Identify-v0", "--stakes", "--policy", "random"]) != 0
    assert "--stakes are those of thermograsp/Grasp-v0" in capsys.readouterr().err


def test_episode_k_has_seed_plus_k(capsys: pytest.CaptureFixture[str]) -> None:
    """Two runs of one episode are the run of two: their steps and returns add up."""
    both, first, second = (
        rollout(f"{ENV} --episodes {n} --seed {seed} --num-envs 2", capsys)
        for n, seed in ((2, 0), (1, 0), (1, 1))
    )
    assert both["steps"] == first["steps"] + second["steps"]
    assert both["mean_return"] == pytest.approx((first["mean_return"] + second["mean_return"]) / 2, rel=1e-12)


def spoiled(env: Any, **truth: Any) -> list[str]:
    """What the checks say of an environment whose reading has these values instead."""
    observation, _ = env.reset(seed=0)
    batch = env.unwrapped.batch
    reading = batch.reading._replace(truth={**batch.reading.truth, **truth})
    base = SimpleNamespace(batch=SimpleNamespace(plant=batch.plant, reading=reading))
    stand_in: Any = SimpleNamespace(unwrapped=base, single_observation_space=env.single_observation_space)
    found = violations(stand_in, observation, np.zeros(2), {}, np.arange(2), 10, 1, True)
    return [str(one) for one in found]


@pytest.fixture(scope="module")
def env() -> Any:
    return gymnasium.make_vec(ENV, num_envs=2, vectorization_mode="vector_entry_point", material="glass")


def test_nothing_is_found_where_all_is_well(env: Any) -> None:
    assert spoiled(env) == []


def test_a_temperature_out_of_nowhere_is_found(env: Any) -> None:
    (violation,) = spoiled(env, object_temperature=np.array([24.0, 36.2]))
    assert violation.startswith("episode 11, step 1: object_temperature [36.2] degC is outside")
    assert len(spoiled(env, sensor_surface=np.array([[36.0, np.nan], [20.0, 36.0]]))) == 2


def test_missing_heat_is_found(env: Any) -> None:
    (violation,) = spoiled(env, heat_exchanged=np.array([5.0, 5.0]), heat_imbalance=np.array([1e-6, 1e-5]))
    assert violation == "episode 11, step 1: 1e-05 J are missing of 5 J exchanged"
    assert len(spoiled(env, heat_imbalance=np.array([np.nan, 0.0]))) == 1


def test_observations_and_rewards_are_looked_at(env: Any) -> None:
    observation, _ = env.reset(seed=0)
    observation["voltage"][0, 1, 3] = np.nan
    observation["gripper"][1, 0] = 1.0
    found = violations(env, observation, np.array([0.0, np.inf]), {}, np.arange(2), 0, 4, True)
    texts = sorted(str(one) for one in found)
    assert [line.split(":")[0] for line in texts] == [
        "episode 0, step 4",
        "episode 1, step 4",
        "episode 1, step 4",
    ]
    assert (
        "voltage is not finite" in texts[0]
        and "gripper is outside" in texts[1]
        and "reward is inf" in texts[2]
    )
    assert violations(env, observation, np.zeros(2), {}, np.arange(2), 0, 4, False) == []


def test_a_broken_simulation_counts_without_checks(env: Any) -> None:
    observation, _ = env.reset(seed=0)
    info = {"error": np.array(["it broke", None], object), "_error": np.array([True, False])}
    (violation,) = violations(env, observation, np.zeros(2), info, np.arange(2), 0, 9, False)
    assert str(violation) == "episode 0, step 9: it broke"
