"""Many environments at once are the single ones, bit for bit."""

from __future__ import annotations

import gymnasium
import numpy as np
import pytest

import thermograsp  # noqa: F401  registers the ids
from thermograsp.envs import GraspBatch, GraspEnv, GraspVectorEnv
from thermograsp.errors import InvalidValueError

from ..scripted import grasp_action


def make(num_envs: int, **keywords):
    return gymnasium.make_vec(
        "thermograsp/Grasp-v0", num_envs=num_envs, vectorization_mode="vector_entry_point", **keywords
    )


def test_environment_i_is_the_single_one_seeded_s_plus_i():
    vector = make(3, threads=2)
    seen, info = vector.reset(seed=5)
    actions = np.random.default_rng(0).uniform(-1, 1, (60, 3, 3)).astype(np.float32)
    actions[:, :, 0] = -1.0
    singles = [GraspEnv() for _ in range(3)]
    for i, single in enumerate(singles):
        first, alone_info = single.reset(seed=5 + i)
        assert all(np.array_equal(first[key], seen[key][i]) for key in first)
        assert alone_info["material"] == info["material"][i]
    for action in actions:
        seen, reward, terminated, truncated, info = vector.step(action)
        for i, single in enumerate(singles):
            alone, alone_reward, alone_terminated, alone_truncated, step_info = single.step(action[i])
            assert all(np.array_equal(alone[key], seen[key][i]) for key in alone)
            assert alone_reward == reward[i]
            assert (alone_terminated, alone_truncated) == (terminated[i], truncated[i])
            assert np.array_equal(step_info["temperature_drop"], info["temperature_drop"][i])


def test_environments_that_end_start_anew_at_the_next_step():
    vector = make(2, seconds=0.1, material="glass")
    vector.reset(seed=0)
    for k in range(1, 14):
        seen, reward, _, truncated, info = vector.step(np.zeros((2, 3), np.float32))
        assert np.array_equal(truncated, [k % 6 == 5] * 2)
        if k % 6 == 0:  # the reset step
            assert not reward.any() and not info["temperature_drop"].any()
            assert np.all(seen["gripper"][:, 0] > 0.08)


def test_bad_calls_say_what_to_do():
    with pytest.raises(InvalidValueError, match="reset"):
        make(2).step(np.zeros((2, 3)))
    with pytest.raises(InvalidValueError, match="seed"):
        make(2).reset(seed=[1, 2, 3])  # pyright: ignore[reportArgumentType]
    with pytest.raises(InvalidValueError, match="num_envs"):
        make(0)
    vector = make(2)
    vector.reset(seed=0)
    with pytest.raises(InvalidValueError, match="finite"):
        vector.step(np.full((2, 3), np.nan))


def test_resetting_one_row_leaves_what_the_others_last_read():
    batch = GraspBatch(2, material="glass")
    rngs = [np.random.default_rng(i) for i in range(2)]
    batch.reset([0, 1], rngs)
    for _ in range(60):
        batch.step(grasp_action(batch))
    before = batch.reading
    seen, reading = batch.reset([0], rngs[:1])
    after = batch.reading
    assert before is not None and after is not None
    assert not after.truth["temperature_drop"][0].any() and not reading.truth["temperature_drop"][0].any()
    for name in ("temperature_drop", "heat_imbalance", "heat", "sensor_surface"):
        assert np.array_equal(after.truth[name][1], before.truth[name][1])
    assert np.array_equal(after.force[1], before.force[1]) and before.force[1].any()
    assert seen["voltage"][1].any() and not seen["voltage"][0].any()


def test_infos_are_what_gymnasium_makes_of_the_single_ones():
    vector = make(3, material=["glass", "aluminium"], seconds=0.3)
    seen, info = vector.reset(seed=3)
    singles = [GraspEnv(material=["glass", "aluminium"], seconds=0.3) for _ in range(3)]
    firsts = [single.reset(seed=3 + i)[1] for i, single in enumerate(singles)]
    squeeze = np.tile(np.array([-1.0, 1.0, 0.0], np.float32), (3, 1))
    for k in range(14):
        expected: dict = {}
        for i, first in enumerate(firsts):
            alone_info = first if k == 0 else singles[i].step(squeeze[i])[4]
            expected = vector._add_info(expected, alone_info, i)
        if k:
            seen, _, _, _, info = vector.step(squeeze)
        assert set(info) == set(expected)
        for name, values in expected.items():
            assert info[name].dtype == values.dtype and np.array_equal(info[name], values), name
    some = vector.reset(options={"reset_mask": np.array([False, True, False])})[1]
    assert not some["_success"][0] and some["_success"][1] and some["material"][0] is None
    assert seen["voltage"].shape == (3, 2, 16)


@pytest.mark.parametrize("name", ["Grasp", "Sort"])
@pytest.mark.parametrize("at", [0, 20])
def test_where_mujoco_raises_in_one_environment_the_others_go_on(name: str, at: int):
    """At the very first step too, when nothing has been recorded."""
    keywords = {"num_envs": 3, "vectorization_mode": "vector_entry_point", "material": ["glass", "wood"]}
    broken, whole = (gymnasium.make_vec(f"thermograsp/{name}-v0", **keywords) for _ in range(2))
    rng = np.random.default_rng(0)
    broken.reset(seed=0)
    whole.reset(seed=0)
    kinds: np.ndarray = broken.unwrapped.batch.plant.mechanics._batch.expand("eq_type")  # pyright: ignore
    for k in range(at + 3):
        action = rng.uniform(-1, 1, broken.action_space.shape).astype(np.float32)
        kinds[1] = 99 if k == at else kinds[0]  # no such constraint: mj_step raises
        seen, reward, terminated, truncated, info = broken.step(action)
        wanted, owed, *_ = whole.step(action)
        for row in (0, 2):
            assert all(np.array_equal(seen[key][row], wanted[key][row]) for key in seen)
            assert reward[row] == owed[row] and not truncated[row] and not terminated[row]
        if k == at:
            assert truncated[1] and not terminated[1] and reward[1] == 0
            assert "MuJoCo" in info["error"][1] and not info["_error"][[0, 2]].any()
        else:
            assert not truncated[1] and not terminated[1]  # begun anew and going on
        assert broken.observation_space.contains(seen)


def test_what_is_no_state_is_refused() -> None:
    for env in (GraspVectorEnv(1), GraspEnv()):
        with pytest.raises(InvalidValueError, match=r"what state\(\) returned, got dict"):
            env.set_state({})  # pyright: ignore[reportArgumentType]
        env.close()


@pytest.mark.parametrize("action", [np.zeros(3), np.zeros((2, 3)), np.zeros((3, 4)), None])
def test_actions_of_another_shape_are_refused_and_change_nothing(action: object) -> None:
    env = GraspVectorEnv(3, material="glass")
    env.reset(seed=0)
    before = env.state()
    with pytest.raises(
        InvalidValueError, match=r"step takes actions of shape \(3, 3\), one for each environment; got"
    ):
        env.step(action)  # pyright: ignore[reportArgumentType]
    for now, then in zip(env.state().batch.observed, before.batch.observed, strict=True):
        assert np.array_equal(now, then)
    env.close()


@pytest.mark.usefixtures("opengl")
def test_a_picture_of_each_environment_is_the_single_ones() -> None:
    size = {"width": 64, "height": 48, "seconds": 0.1, "render_mode": "rgb_array"}
    vector = GraspVectorEnv(2, **size)
    vector.reset(seed=4)
    vector.step(np.zeros((2, 3), np.float32))
    frames = vector.render()
    assert frames is not None and len(frames) == 2
    for row, frame in enumerate(frames):
        single = GraspEnv(**size)
        single.reset(seed=4 + row)
        single.step(np.zeros(3, np.float32))
        assert frame.shape == (48, 64, 3) and np.array_equal(frame, single.render())
        single.close()
    assert not np.array_equal(*frames)
    vector.close()


def test_a_vector_opens_no_window() -> None:
    with pytest.raises(InvalidValueError, match="opens no windows"):
        GraspVectorEnv(2, render_mode="human")
