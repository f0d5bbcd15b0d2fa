"""Identify-v0: what it pays for, and that one and many are the same."""

from __future__ import annotations

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import thermograsp  # noqa: F401  registers the ids
from thermograsp.envs import IdentifyEnv, IdentifyTask, IdentifyVectorEnv
from thermograsp.errors import InvalidValueError

THREE = ["glass", "copper", "cotton"]


def action(force: float = 0.0, declare: bool = False, chosen: int | None = None, classes: int = 3):
    vector = np.zeros(2 + classes, np.float32)
    vector[0], vector[1] = force, 1.0 if declare else -1.0
    if chosen is not None:
        vector[2:] = -1.0
        vector[2 + chosen] = 1.0
    return vector


def episode(env: IdentifyEnv, policy, seed: int) -> tuple[float, dict]:
    observation, info = env.reset(seed=seed)
    total, done = 0.0, False
    while not done:
        observation, reward, terminated, truncated, info = env.step(policy(observation, info))
        total, done = total + reward, terminated or truncated
    return total, info


def test_it_passes_gymnasiums_checker():
    check_env(gymnasium.make("thermograsp/Identify-v0", material=THREE).unwrapped, skip_render_check=True)


def test_space_and_spaces_of_ten_materials():
    env = gymnasium.make("thermograsp/Identify-v0")
    assert env.action_space.shape == (12,)
    assert env.unwrapped.batch.task.classes[2] == "plastic" or len(env.unwrapped.batch.task.classes) == 10  # pyright: ignore


def test_only_knowing_pays():
    env = IdentifyEnv(material=THREE, seconds=0.4, cost_per_second=0.1)
    rng = np.random.default_rng(0)
    idle = [episode(env, lambda o, i: action(), seed)[0] for seed in range(6)]
    squeezing = [episode(env, lambda o, i: action(1.0), seed)[0] for seed in range(6)]
    guessing = [episode(env, lambda o, i: action(0, True, int(rng.integers(3))), s)[0] for s in range(30)]
    knowing = [
        episode(env, lambda o, i: action(0, True, THREE.index(i["material"])), seed) for seed in range(6)
    ]
    # An even distribution is worth nothing, and time costs.
    assert idle == pytest.approx([-0.04] * 6) and squeezing == pytest.approx([-0.04] * 6)
    assert np.mean(guessing) < -1
    assert all(total == pytest.approx(1.0, abs=0.01) and info["success"] for total, info in knowing)


def test_shares_and_loss_are_told():
    env = IdentifyEnv(material=THREE)
    env.reset(seed=0, options={"material": "copper"})
    _, reward, terminated, _, info = env.step(np.array([0, 1, 0.2, 0.6, -0.4], np.float32))
    logits = 5 * np.array([0.2, 0.6, -0.4])
    shares = np.exp(logits) / np.exp(logits).sum()
    assert info["prediction"] == pytest.approx(shares, rel=1e-6) and terminated and info["success"]
    assert info["loss"] == pytest.approx(-np.log(shares[1]), rel=1e-6)
    assert reward == pytest.approx(1 - info["loss"] / np.log(3) - 0.1 * env.dt)


def test_force_closes_and_none_opens():
    env = IdentifyEnv(material="glass copper".split())
    observation, _ = env.reset(seed=0)
    for _ in range(60):
        observation = env.step(action(0.5, classes=2))[0]
    assert observation["force"][:, 0] == pytest.approx([20.0, 20.0], rel=0.1)
    assert observation["gripper"][3] == 20.0 and observation["voltage"].max() > 1e-3
    for _ in range(60):
        observation = env.step(action(-1.0, classes=2))[0]
    assert not observation["force"].any()


def test_two_temperatures_feel_an_object_as_warm_as_one_of_them():
    def squeezed(material: str) -> np.ndarray:
        env = IdentifyEnv(
            material=["copper", "cotton"],
            sensor_temperature=(36.0, 28.0),
            object_temperature=36.0,
            signal="ideal",
        )
        observation, info = env.reset(seed=0, options={"material": material})
        for _ in range(120):
            observation, _, _, _, info = env.step(action(0.25, classes=2))
        assert info["material"] == material
        return observation["voltage"][:, -1]

    metal, wool = squeezed("copper"), squeezed("cotton")
    assert metal[1] < -1e-3 and abs(metal[0]) < abs(metal[1]) / 2  # heat flows into the cooler fingertip
    assert abs(metal[1]) > 3 * abs(wool[1])


def test_environment_i_is_the_single_one_seeded_s_plus_i_through_autoreset():
    vector = IdentifyVectorEnv(3, material=THREE, seconds=0.3)
    seen, info = vector.reset(seed=7)
    singles = [IdentifyEnv(material=THREE, seconds=0.3) for _ in range(3)]
    firsts = [single.reset(seed=7 + i) for i, single in enumerate(singles)]
    assert [first[1]["material"] for first in firsts] == list(info["material"])
    rng = np.random.default_rng(1)
    ended = [False] * 3
    for k in range(45):
        actions = rng.uniform(-1, 1, (3, 5)).astype(np.float32)
        actions[:, 0], actions[:, 1] = 1.0, [1.0 if k % 11 == 5 + i else -1.0 for i in range(3)]
        seen, reward, terminated, truncated, info = vector.step(actions)
        expected: dict = {}
        for i, single in enumerate(singles):
            if ended[i]:
                alone, alone_info = single.reset()
                assert reward[i] == 0 and not terminated[i] and not truncated[i]
                ended[i] = False
            else:
                alone, alone_reward, *ends, alone_info = single.step(actions[i])
                assert alone_reward == reward[i] and ends == [terminated[i], truncated[i]]
                ended[i] = any(ends)
            assert all(np.array_equal(alone[key], seen[key][i]) for key in alone)
            expected = vector._add_info(expected, alone_info, i)
        assert set(info) == set(expected)
        assert all(np.array_equal(info[name], values) for name, values in expected.items())


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"material": "glass"}, "two at least"),
        ({"material": ["glass", "glass"]}, "two at least"),
        ({"seconds": 0}, "seconds"),
        ({"cost_per_second": -1}, "cost_per_second"),
        ({"sensor_temperature": (36.0, 30.0, 1.0)}, "one °C or two"),
    ],
)
def test_bad_keywords_are_refused(keywords, message):
    with pytest.raises(InvalidValueError, match=message):
        IdentifyEnv(**keywords)


def test_a_reset_s_material_is_one_of_those_to_tell_apart():
    """Or no declaration could be judged: its loss was NaN, and its reward that of no end."""
    one, many = IdentifyEnv(material=THREE), IdentifyVectorEnv(2, material=THREE)
    for env in (one, many):
        with pytest.raises(
            InvalidValueError, match="material 'iron' is none of those to tell apart, glass, copper"
        ):
            env.reset(seed=0, options={"material": "iron"})
        with pytest.raises(InvalidValueError, match="'iron'"):
            env.reset(seed=0, options={"material": ["glass", "iron"]})
        with pytest.raises(InvalidValueError, match="options must be a dict"):
            env.reset(options="iron")  # pyright: ignore[reportArgumentType]
    assert one.reset(seed=0, options={"material": "copper"})[1]["material"] == "copper"
    one.close()
    many.close()


def test_bad_actions_are_refused():
    env = IdentifyEnv(material=THREE)
    env.reset(seed=0)
    with pytest.raises(InvalidValueError, match="5"):
        env.step(np.zeros(4))
    with pytest.raises(InvalidValueError, match="finite"):
        env.step(np.full(5, np.nan))
    assert IdentifyTask(("a", "b")).action_space().shape == (4,)
