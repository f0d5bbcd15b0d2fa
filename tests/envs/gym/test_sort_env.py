"""Sort-v0: what it pays for, that only touch tells, and that one and many are the same."""

from __future__ import annotations

import pickle
import warnings
from dataclasses import replace
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from thermograsp import thermal
from thermograsp.agents.scripted_sort import ScriptedSort
from thermograsp.envs import (
    Mechanics,
    ObjectSpec,
    SortEnv,
    SortTask,
    SortVectorEnv,
    sliding_action_of,
)
from thermograsp.envs.plant.randomization import Mass, ObjectTemperature, Roughness
from thermograsp.errors import InvalidValueError, UnknownNameError

from ..scripted import SAMPLE, sampled_conductance, watched_contacts

TWO = ["copper", "glass"]


def same(a: dict, b: dict) -> bool:
    return all(np.array_equal(a[name], b[name]) for name in a)


def episodes(env: SortVectorEnv, act, seed: int = 0) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
    """Successes, returns and reasons, (B,) each, of an episode in each environment."""
    observation, _ = env.reset(seed=seed)
    rows = env.num_envs
    won, over, total = np.zeros(rows, bool), np.zeros(rows, bool), np.zeros(rows)
    reasons = {name: np.zeros(rows, bool) for name in ("wrong", "dropped", "crushed")}
    while not over.all():
        observation, reward, terminated, truncated, info = env.step(act(observation))
        total += np.where(over, 0.0, reward)
        won |= info["success"] & ~over
        for name, seen in reasons.items():
            seen |= info.get(name, np.zeros(rows, bool)) & ~over
        over |= terminated | truncated
    return won, total, reasons


class Always:
    """Grasps and lifts the object on one side, whatever it feels."""

    def __init__(self, batch, side: int) -> None:
        self._scripted, self._side = ScriptedSort(batch), side
        self._scripted._decide = self._take  # pyright: ignore[reportAttributeAccessIssue]
        self._scripted._side[:] = side

    def _take(self, row, volts, goal) -> None:
        del volts, goal
        self._scripted._phase[row] = 2

    def action(self, observation):
        return self._scripted.action(observation)


@pytest.mark.parametrize("keywords", [{"material": TWO}, {"goal": "hotter", "material": "glass"}])
def test_check_env_gives_no_warning(keywords):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(SortEnv(**keywords), skip_render_check=True)


def test_spaces_and_what_is_told():
    env = gymnasium.make("thermograsp/Sort-v0", material=["copper", "glass", "wood"])
    assert env.action_space.shape == (4,)
    rights, pairs = set(), set()
    for seed in range(20):
        observation, info = env.reset(seed=seed)
        assert env.observation_space.contains(observation)
        assert observation["goal"].tolist() == [name == info["asked"] for name in ("copper", "glass", "wood")]
        assert info["material"][info["right"]] == info["asked"] and len(set(info["material"])) == 2
        assert info["object_temperatures"].tolist() == [24.0, 24.0] and len(info["rung"]) == 2
        rights.add(info["right"])
        pairs.add(info["material"])
    assert rights == {0, 1} and len(pairs) == 6


def test_the_hotter_one():
    env = SortEnv(
        goal="hotter",
        material="glass",
        object_temperature=(22.0, 31.0),
        randomize=[ObjectTemperature(0.0, 1.0)],
    )
    for seed in range(6):
        observation, info = env.reset(seed=seed)
        celsius, shift = info["object_temperatures"], info["randomized"]["object_temperature_shift"]
        assert info["asked"] == "the hotter one" and observation["goal"].tolist() == [1.0]
        assert celsius[info["right"]] == pytest.approx(31.0 + shift)
        assert celsius[1 - info["right"]] == pytest.approx(22.0 + shift)
        assert len(set(info["material"])) == 1


def test_only_touch_tells_the_objects_apart():
    """Their models and all that is seen before a touch are the same whatever they are made of."""
    env = SortEnv(material=["copper", "cotton"], randomize=[Mass(), Roughness()])
    env.reset(seed=0)
    mechanics = env.batch.plant.mechanics  # pyright: ignore[reportAttributeAccessIssue]
    model = mechanics.env_model(0)
    one, two = (model.body(f"object_{number}").id for number in (0, 1))
    for field in ("body_mass", "body_inertia", "body_ipos", "body_iquat"):
        assert np.array_equal(getattr(model, field)[one], getattr(model, field)[two])
    one, two = (model.geom(f"object_{number}_0").id for number in (0, 1))
    for field in ("geom_size", "geom_friction", "geom_rgba", "geom_solref", "geom_solimp", "geom_type"):
        assert np.array_equal(getattr(model, field)[one], getattr(model, field)[two])
    seen = []
    for material in (["copper", "cotton"], ["glass", "iron"]):
        env = SortEnv(material=material)
        env.reset(seed=3)
        seen.append([env.step(sliding_action_of(0.085, 10.0, 0.01, 0.1))[0] for _ in range(40)])
    assert all(same(a, b) for a, b in zip(*seen, strict=True))


@pytest.mark.slow
def test_feeling_pays_and_nothing_else_does():
    env = SortVectorEnv(20, material=TWO)
    won, total, reasons = episodes(env, ScriptedSort(env.batch).action)
    assert won.all() and total.min() > 1.0 and not any(seen.any() for seen in reasons.values())
    first, first_total, reasons = episodes(env, Always(env.batch, 0).action)
    second, _, _ = episodes(env, Always(env.batch, 1).action)
    assert not (first & second).any() and (first | second).all()  # the same episodes, and one object is right
    assert np.array_equal(reasons["wrong"], ~first)
    assert first_total[~first] == pytest.approx(-1.0)
    assert 4 < first.sum() < 16


@pytest.mark.parametrize("materials", [["glass"], pytest.param(["copper"], marks=pytest.mark.slow)])
def test_the_hotter_one_is_found_by_touch(materials):
    env = SortVectorEnv(6, goal="hotter", material=materials)
    assert episodes(env, ScriptedSort(env.batch).action)[0].all()


def test_idle_random_and_squeezing_get_nothing():
    env = SortVectorEnv(4, material=TWO, seconds=4.0)
    rng = np.random.default_rng(0)
    idle = episodes(env, lambda o: np.zeros((4, 4), np.float32))
    chance = episodes(env, lambda o: rng.uniform(-1, 1, (4, 4)).astype(np.float32))
    policy = ScriptedSort(env.batch)
    squeezing = episodes(env, lambda o: policy.action(o) * np.array([1.0, 1.0, 0.0, 1.0], np.float32))
    for won, total, _ in (idle, chance, squeezing):
        assert not won.any() and total.max() < 0.05


def test_crushing_ends_it():
    egg = replace(thermal.material("glass"), name="egg-like", crushing_stress=50e3)
    env = SortVectorEnv(2, material=[egg, "copper"])
    policy = Always(env.batch, 0)

    def firmly(observation):
        action = policy.action(observation)
        action[:, 1] = 0.9  # 38 N
        return action

    _, total, reasons = episodes(env, firmly)
    _, info = env.reset(seed=0)
    eggs = np.array([pair[0] == "egg-like" for pair in info["material"]])
    assert np.array_equal(reasons["crushed"], eggs) and np.all(total[eggs] <= -0.99)


@pytest.mark.parametrize(
    "keywords",
    [{"material": TWO}, pytest.param({"goal": "hotter", "randomize": [Roughness()]}, marks=pytest.mark.slow)],
)
def test_environment_i_is_the_single_one_seeded_s_plus_i_through_touches_and_autoreset(keywords):
    keywords = {**keywords, "seconds": 6.0, "hold_seconds": 0.2, "thermostat": thermal.Thermostat()}
    vector, rows = SortVectorEnv(3, **keywords), 3
    singles = [SortEnv(**keywords) for _ in range(rows)]
    seen, info = vector.reset(seed=5)
    firsts = [single.reset(seed=5 + i) for i, single in enumerate(singles)]
    policy, ended, resets = ScriptedSort(vector.batch), [False] * rows, 0
    assert [first[1]["material"] for first in firsts] == list(info["material"])
    for _ in range(420):
        actions = policy.action(seen)
        seen, reward, terminated, truncated, info = vector.step(actions)
        expected: dict = {}
        for i, single in enumerate(singles):
            if ended[i]:
                alone, alone_info = single.reset()
                assert reward[i] == 0 and not terminated[i] and not truncated[i]
                policy.restart([i])
                ended[i], resets = False, resets + 1
            else:
                alone, alone_reward, *ends, alone_info = single.step(actions[i])
                assert alone_reward == reward[i] and ends == [terminated[i], truncated[i]]
                ended[i] = any(ends)
            assert same(alone, {name: values[i] for name, values in seen.items()})
            expected = vector._add_info(expected, alone_info, i)
        assert set(info) == set(expected)
        for name, values in expected.items():
            if name not in ("randomized", "_randomized"):
                assert info[name].dtype == values.dtype and np.array_equal(info[name], values), name
    assert resets >= rows


def test_saved_and_restored_in_mid_episode_gives_the_same_bits():
    keywords = {"material": ["glass", "copper", "cotton"], "thermostat": thermal.Thermostat()}
    env = SortVectorEnv(3, **keywords)
    policy = ScriptedSort(env.batch)
    seen, _ = env.reset(seed=1)
    actions = []
    for _ in range(240):
        actions.append(policy.action(seen))
        seen, *_ = env.step(actions[-1])
    env.reset(seed=1)
    for action in actions[:120]:
        env.step(action)
    saved = pickle.loads(pickle.dumps(env.batch.state()))
    expected = [env.batch.step(action) for action in actions[120:]]
    env.reset(seed=9)
    env.batch.set_state(saved)
    other = SortVectorEnv(3, **keywords)
    other.reset(seed=2)
    other.batch.set_state(saved)
    assert (saved.plant.heat.owner == 0).any()
    for action, first in zip(actions[120:], expected, strict=True):
        for again in (env.batch.step(action), other.batch.step(action)):
            assert same(first.observation, again.observation)
            assert np.array_equal(first.reward, again.reward)
            for name in ("temperature_drop", "object_temperatures", "heat", "right"):
                assert np.array_equal(first.reading.truth[name], again.reading.truth[name])


def test_books_of_heat_balance_from_one_object_to_the_other():
    env = SortVectorEnv(
        4, material=["copper", "glass", "cotton"], air=0.0, thermostat=thermal.Thermostat(), hold_seconds=9.0
    )
    policy, drawn = ScriptedSort(env.batch), np.zeros(4)
    seen, _ = env.reset(seed=0)
    crossed = np.zeros(4, bool)
    for _ in range(230):
        seen, _, terminated, *_ = env.step(policy.action(seen))
        assert not terminated.any()
        assert env.batch.reading is not None
        truth = env.batch.reading.truth
        drawn += truth["heat_drawn"].sum(axis=1) * env.dt
        crossed |= (truth["object_temperatures"] > 24.0).all(axis=1)
        assert truth["heat"].sum(axis=1) == pytest.approx(drawn, rel=1e-9)
        assert np.all(abs(truth["heat_imbalance"]) <= 1e-9 * truth["heat_exchanged"])
    assert crossed.any() and not crossed.all()


@pytest.mark.parametrize("name", ["glass", "copper"])
def test_press_with_the_recorded_conductance_gives_the_same_drop(name):
    """One fingertip, same rung and steps, no air: a single touch is thermal.press."""
    env = SortEnv(goal="hotter", material=name, object_temperature=(20.0, 24.0), fingertips=1, air=0.0)
    env.reset(seed=0)
    plant: Any = env.batch.plant
    infos, contacts = [], watched_contacts(plant.heat)
    for k in range(170):
        action = sliding_action_of(0.085 if k < 35 else 0.0, 10.0, 0.0, -0.1 if k < 20 else 0.0)
        infos.append(env.step(action)[4])
    touched = plant.scenes[0][0]
    conductance = sampled_conductance(contacts, touched)[:, 0]
    drop = np.array([info["temperature_drop"][0] for info in infos])
    first = 2 * int(np.argmax(conductance > 0) // 2)  # the beginning of a step
    held = conductance[first:]
    press = thermal.press(
        name,
        conductance=lambda t: float(held[min(int(t / SAMPLE), len(held) - 1)]),
        object_size=touched.plate,
        object_temperature=touched.temperature,
        seconds=len(held) * SAMPLE,
        dt=SAMPLE,
        rung=infos[-1]["rung"][0],
    )
    assert drop.max() > 1.0
    assert np.max(np.abs(press.temperature_drop[2::2] - drop[first // 2 :])) < 1e-6


def test_the_arm_slides_as_told_and_only_where_there_is_an_axis():
    env = SortEnv(material=TWO)
    observation, _ = env.reset(seed=0)
    assert observation["lateral"] == 0.0 and env.model.nu == 3
    places = [env.step(sliding_action_of(0.085, 0.0, 0.0, 0.05))[0]["lateral"][0] for _ in range(100)]
    speed = np.diff(places) / env.dt
    assert speed[10:40] == pytest.approx(0.05, abs=1e-3)
    assert np.diff(speed).max() <= 1.0 * env.dt * 1.5  # m/s2, its acceleration, followed by a servo
    assert places[-1] == pytest.approx(0.06, abs=1e-3)
    with pytest.raises(InvalidValueError, match="lateral"):
        Mechanics().slide(np.zeros(1), np.zeros(1), np.zeros(1), np.zeros(1))


def test_bad_keywords_and_actions_say_what_to_do():
    with pytest.raises(UnknownNameError, match="hotter"):
        SortEnv(goal="hoter")  # pyright: ignore[reportArgumentType]
    with pytest.raises(InvalidValueError, match="two at least"):
        SortEnv(material="glass")
    with pytest.raises(InvalidValueError, match="each once"):
        SortEnv(material=["glass", "glass"])
    with pytest.raises(InvalidValueError, match="cooler one first"):
        SortEnv(goal="hotter", object_temperature=24.0)
    with pytest.raises(InvalidValueError, match="cooler one first"):
        SortEnv(object_temperature=(20.0, 24.0))
    with pytest.raises(InvalidValueError, match="mode"):
        SortEnv(mode="O")
    with pytest.raises(InvalidValueError, match="plant"):
        SortEnv(plant="serial:///dev/ttyACM0")
    with pytest.raises(InvalidValueError, match="deep"):
        SortEnv(objects=ObjectSpec(size=(0.04, 0.1, 0.04)))
    with pytest.raises(InvalidValueError, match="hold_seconds"):
        SortTask(hold_seconds=0.0)
    env = SortEnv(material=TWO)
    env.reset(seed=0)
    for action in (np.zeros(3), np.zeros((1, 4)), np.array([0, 0, 0, np.nan]), np.array([np.inf, 0, 0, 0])):
        with pytest.raises(InvalidValueError, match="action"):
            env.step(action)
    with pytest.raises(InvalidValueError, match="options"):
        env.reset(options={"material": "glass"})


def test_a_box_that_is_turned_is_touched_and_felt_by_its_other_sides():
    """As the same box with its sides named the other way round."""
    long, short = 0.06, 0.014  # m: a pad is 20 mm wide
    changes = []
    for spec in (
        ObjectSpec(size=(long, short, 0.05), yaw=np.pi / 2),
        ObjectSpec(size=(short, long, 0.05)),
    ):
        env = SortVectorEnv(1, material=TWO, objects=spec, placement=(0.0, 0.0), signal="ideal")
        observation, info = env.reset(seed=1)
        policy = Always(env.batch, int(info["right"][0]))
        areas = []
        for _ in range(150):
            observation, *_, info = env.step(policy.action(observation))
            areas.append(info["contact_area"][0].max())
        network = env.batch.plant.heat._rows._bodies[0].geometry  # pyright: ignore[reportAttributeAccessIssue]
        changes.append((network.area, max(areas)))
    np.testing.assert_allclose(changes[0], changes[1], rtol=0.02)


def test_a_thermostat_that_is_too_hot_is_told():
    plate = thermal.Thermostat(heat_capacity=0.6, loss=0.1)
    env = SortVectorEnv(2, material=TWO, thermostat=plate)
    _, info = env.reset(seed=0)
    assert info["over_temperature"].tolist() == [False, False]
    env.batch.plant._thermostats._hot[1] = True  # pyright: ignore[reportAttributeAccessIssue]
    *_, info = env.step(np.zeros((2, 4)))
    assert info["over_temperature"].tolist() == [False, True]
    single = SortEnv(material=TWO, thermostat=plate)
    assert single.reset(seed=0)[1]["over_temperature"] is False
    assert "over_temperature" not in SortEnv(material=TWO).reset(seed=0)[1]
