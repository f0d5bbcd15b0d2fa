"""What stable-baselines3 asks of environments, single and vector: `make test-rl` installs it."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest

import thermograsp  # noqa: F401  registers the environments
from thermograsp.envs import STAKES, GraspVectorEnv
from thermograsp.errors import InvalidValueError

pytest.importorskip("stable_baselines3", reason="needs stable-baselines3: make test-rl")

from stable_baselines3 import PPO  # pyright: ignore[reportMissingImports]
from stable_baselines3.common.env_checker import check_env  # pyright: ignore[reportMissingImports]

from thermograsp.envs.sb3 import StableBaselinesVecEnv
from thermograsp.envs.spaces.senses import SIZE, Senses

IDS = sorted(name for name in gymnasium.registry if name.startswith("thermograsp/"))
SHORT: dict[str, Any] = {"material": "glass", "seconds": 0.2}  # 10 control steps


@pytest.mark.parametrize("env_id", IDS)
@pytest.mark.filterwarnings("ignore::UserWarning")  # advice on the network for a dictionary
def test_its_checker_passes(env_id: str):
    check_env(gymnasium.make(env_id).unwrapped, warn=True, skip_render_check=True)


def test_an_episode_is_followed_by_its_successor_in_the_same_step():
    ours, plain = StableBaselinesVecEnv(GraspVectorEnv(3, **SHORT)), GraspVectorEnv(3, **SHORT)
    ours.seed(5)
    seen: Any = ours.reset()
    expected, _ = plain.reset(seed=[5, 6, 7])
    rng = np.random.default_rng(0)
    for step in range(1, 25):
        for name in expected:
            np.testing.assert_array_equal(seen[name], expected[name])
        action = rng.uniform(-1, 1, (3, 3)).astype(np.float32)
        seen, reward, ended, infos = ours.step(action)
        expected, owed, _, truncated, _ = plain.step(action)
        np.testing.assert_array_equal(reward, owed.astype(np.float32))
        np.testing.assert_array_equal(ended, truncated)
        assert ended.all() == (step % 10 == 0)
        for row in np.flatnonzero(ended):
            assert infos[row]["TimeLimit.truncated"]
            last = infos[row]["terminal_observation"]
            for name in expected:
                np.testing.assert_array_equal(last[name], expected[name][row])
            assert not np.array_equal(last["gripper"], seen["gripper"][row])  # which opens a new episode
        if ended.any():
            expected = plain.reset(options={"reset_mask": ended})[0]


def test_an_action_that_lasts_adds_rewards_up_and_stops_with_the_episode():
    held = StableBaselinesVecEnv(GraspVectorEnv(2, **SHORT), Senses(), repeat=4, bootstrap=False)
    plain = GraspVectorEnv(2, **SHORT)
    held.seed(1)
    held.reset()
    plain.reset(seed=[1, 2])
    action = np.tile(np.array([-1.0, 0.5, 1.0], np.float32), (2, 1))
    for steps in (4, 4, 2):  # the third is cut short by the time limit
        _, reward, ended, infos = held.step(action)
        owed = sum(plain.step(action)[1] for _ in range(steps))
        np.testing.assert_allclose(reward, owed, rtol=1e-6)
        assert ended.all() == (steps == 2)
    assert infos[0]["terminal_observation"].shape == (SIZE,)
    assert not infos[0]["TimeLimit.truncated"]


def test_a_row_that_ends_alone_leaves_the_others_running():
    env = StableBaselinesVecEnv(GraspVectorEnv(2, **{**STAKES, "material": "butter"}), Senses(), repeat=5)
    env.seed(0)
    env.reset()
    crush_and_wait = np.array([[-1.0, 1.0, 0.0], [1.0, -1.0, 0.0]], np.float32)
    seen: Any = None
    ended, infos = np.zeros(2, bool), []
    while not ended.any():
        seen, _, ended, infos = env.step(crush_and_wait)
    assert ended.tolist() == [True, False]
    assert infos[0]["crushed"] and "terminal_observation" not in infos[1]
    assert infos[0]["terminal_observation"][0] < 0.5  # closed, and
    assert seen[0, 0] == pytest.approx(1.0, abs=0.05)  # open again,
    assert not seen[0, 10:42].any()  # with a history of zeros


def test_what_is_left_out_reads_zero():
    env = GraspVectorEnv(2, material="copper")
    observation, _ = env.reset(seed=0)
    for _ in range(40):
        observation = env.step(np.tile(np.array([-1.0, -0.5, 0.0], np.float32), (2, 1)))[0]
    full, cold = Senses().vector(observation), Senses(heat=False).vector(observation)
    numb = Senses(load=False).vector(observation)
    heat, load = slice(10, 44), slice(4, 10)
    assert full[:, load].any() and full[:, heat].any() and np.abs(full).max() < 10
    assert not cold[:, heat].any() and not numb[:, load].any()
    np.testing.assert_array_equal(cold[:, :10], full[:, :10])
    np.testing.assert_array_equal(numb[:, 10:], full[:, 10:])


@pytest.mark.parametrize(("senses", "policy"), [(None, "MultiInputPolicy"), (Senses(), "MlpPolicy")])
def test_ppo_learns_on_it(senses: Senses | None, policy: str):
    env = StableBaselinesVecEnv(GraspVectorEnv(2, **SHORT), senses)
    PPO(policy, env, n_steps=16, batch_size=32, n_epochs=1, device="cpu").learn(32)
    env.close()


def test_other_environments_are_refused():
    with pytest.raises(InvalidValueError, match="vector_entry_point"):
        StableBaselinesVecEnv(gymnasium.make_vec("CartPole-v1", num_envs=2))
    with pytest.raises(InvalidValueError, match="repeat"):
        StableBaselinesVecEnv(GraspVectorEnv(1), repeat=0)
