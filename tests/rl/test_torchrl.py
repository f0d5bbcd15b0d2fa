"""TorchRL's environments over ours, single and vector: `make test-rl` installs it."""

from __future__ import annotations

import gymnasium
import pytest

import thermograsp  # noqa: F401  registers the environments

pytest.importorskip("torchrl", reason="needs TorchRL: make test-rl")

from torchrl.envs import (  # pyright: ignore[reportMissingImports]
    GymEnv,
    GymWrapper,
    check_env_specs,
)

IDS = sorted(name for name in gymnasium.registry if name.startswith("thermograsp/"))
SECONDS = 0.2  # 10 control steps


@pytest.mark.parametrize("env_id", IDS)
def test_an_environment_by_its_name(env_id: str) -> None:
    env = GymEnv(env_id, seconds=SECONDS)
    check_env_specs(env)
    rollout = env.rollout(30)
    (steps,) = rollout.batch_size
    assert 1 <= steps <= 10 and rollout["next", "done"].flatten().tolist() == [False] * (steps - 1) + [True]
    env.close()


def test_an_environment_of_gymnasium_goes_on_with_the_next_episode() -> None:
    env = GymWrapper(gymnasium.make("thermograsp/Grasp-v0", seconds=SECONDS))
    check_env_specs(env)
    rollout = env.rollout(25, break_when_any_done=False)
    assert rollout["next", "truncated"].flatten().nonzero().flatten().tolist() == [9, 19]
    env.close()


def test_a_vector_resets_what_has_ended_when_torchrl_asks_for_it() -> None:
    envs = gymnasium.make_vec(
        "thermograsp/Grasp-v0",
        num_envs=3,
        vectorization_mode="vector_entry_point",
        autoreset_mode="Disabled",
        seconds=SECONDS,
    )
    env = GymWrapper(envs)
    check_env_specs(env)
    rollout = env.rollout(25, break_when_any_done=False)
    assert rollout.batch_size == (3, 25)
    assert (rollout["next", "done"].sum(1) == 2).all()
    assert rollout["next", "voltage"].isfinite().all()
    env.close()


def test_a_keyword_that_is_unknown_is_a_type_error_with_the_nearest_name() -> None:
    with pytest.raises(TypeError, match="did you mean 'material'"):
        GymEnv("thermograsp/Grasp-v0", materal="glass")
