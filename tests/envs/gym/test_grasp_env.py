"""The environment as Gymnasium and its users see it."""

from __future__ import annotations

import pickle
import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import thermograsp  # noqa: F401  registers the ids
from thermograsp.envs import GraspEnv, ObjectSpec, Size, action_of
from thermograsp.errors import InvalidValueError, UnknownNameError

from ..scripted import grasp_action


def run(env: GraspEnv, steps: int, seed: int | None = 0, force: float = 10.0) -> list:
    if seed is not None:
        env.reset(seed=seed)
    return [env.step(grasp_action(env.batch, force)[0]) for _ in range(steps)]


def same(a: dict, b: dict) -> bool:
    return all(np.array_equal(a[name], b[name]) for name in a)


def test_check_env_gives_no_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(GraspEnv(material="glass"), skip_render_check=True)


def test_make_with_and_without_the_module_prefix():
    for name in ("thermograsp/Grasp-v0", "thermograsp:thermograsp/Grasp-v0"):
        env = gymnasium.make(name, material="glass")
        observation, info = env.reset(seed=1)
        assert env.observation_space.contains(observation)
        assert info["material"] == "glass"
        assert env.unwrapped.dt == pytest.approx(0.02)  # pyright: ignore[reportAttributeAccessIssue]
        assert env.unwrapped.model.nu == 2  # pyright: ignore[reportAttributeAccessIssue]
        env.close()


def test_grasp_lifts_and_holds_and_info_has_what_design_promises():
    env = GraspEnv(material="aluminium", hold_seconds=0.5)
    steps = run(env, 250)
    ended = next(i for i, step in enumerate(steps) if step[2])
    observation, _, _, truncated, info = steps[ended]
    assert info["success"] and not truncated
    assert env.observation_space.contains(observation)
    for name in ("temperature_drop", "contact_area", "conductance"):
        assert info[name].shape == (2,) and np.all(info[name] > 0)
    assert info["rung"].startswith("network:")
    assert sum(step[1] for step in steps[: ended + 1]) > 1


def test_nothing_is_felt_before_the_first_touch():
    env = GraspEnv(material="aluminium", signal="ideal")
    env.reset(seed=0)
    for _ in range(20):
        observation, _, _, _, info = env.step(action_of(0.085, 10.0, 0.0))
        assert not info["temperature_drop"].any()
        assert not observation["voltage"].any()


def test_touch_and_release_are_told():
    env = GraspEnv(material="glass", seconds=100.0)
    env.reset(seed=0)
    kinds = []
    for k in range(150):
        action = action_of(0.0 if k < 75 else 0.085, 10.0, 0.0)
        kinds += env.step(action)[4]["events"]
    assert sorted(kinds) == sorted((kind, tip) for kind in ("touch", "release") for tip in ("left", "right"))


def test_the_object_stays_warm_between_touches():
    env = GraspEnv(material="wood", seconds=100.0, signal="ideal", air=0.0)
    env.reset(seed=0)
    heat = []
    for k in range(400):
        env.step(action_of(0.0 if k < 150 or k > 200 else 0.085, 10.0, 0.0))
        assert env.batch.reading is not None
        heat.append(env.batch.reading.truth["object_temperature"][0])
    assert heat[150] > 24.0
    assert heat[195] == pytest.approx(heat[180], abs=1e-9)  # apart and without air: kept
    assert heat[399] > heat[195]


def test_same_seed_same_bits_other_seed_other_ones():
    first, second = run(GraspEnv(), 60, seed=3), run(GraspEnv(), 60, seed=3)
    other = run(GraspEnv(), 60, seed=4)
    assert all(same(a[0], b[0]) and a[1] == b[1] for a, b in zip(first, second, strict=True))
    assert not all(same(a[0], b[0]) for a, b in zip(first, other, strict=True))


@pytest.mark.parametrize("mode", ["T", "O"])
def test_saved_and_restored_in_mid_episode_gives_the_same_bits(mode):
    env = GraspEnv(material=["glass", "iron"], mode=mode)
    run(env, 45)
    saved = pickle.loads(pickle.dumps(env.state()))
    expected = run(env, 60, seed=None)
    env.reset(seed=9)
    run(env, 30, seed=None)
    env.set_state(saved)
    again = run(env, 60, seed=None)
    other = GraspEnv(material=["glass", "iron"], mode=mode)
    other.reset(seed=1)
    other.set_state(saved)
    elsewhere = run(other, 60, seed=None)
    for a, b, c in zip(expected, again, elsewhere, strict=True):
        assert same(a[0], b[0]) and same(a[0], c[0])
        assert a[1] == b[1] == c[1]
        assert np.array_equal(a[4]["temperature_drop"], c[4]["temperature_drop"])


@pytest.mark.parametrize(
    "action",
    [np.array([np.nan, 0, 0]), np.array([0, np.inf, 0]), np.zeros(2), np.zeros((3, 1)), np.zeros((1, 3))],
)
def test_bad_actions_raise(action):
    env = GraspEnv(material="glass")
    env.reset(seed=0)
    with pytest.raises(InvalidValueError, match="action"):
        env.step(action)


def test_actions_beyond_the_bounds_are_clipped():
    a, b = GraspEnv(material="glass"), GraspEnv(material="glass")
    a.reset(seed=0)
    b.reset(seed=0)
    for _ in range(30):
        assert same(a.step(np.array([-9.0, 5.0, 7.0]))[0], b.step(np.array([-1.0, 1.0, 1.0]))[0])


def test_what_needs_a_reset_says_so():
    env = gymnasium.make("thermograsp/Grasp-v0", material="glass", render_mode="rgb_array")
    with pytest.raises(InvalidValueError, match="call reset before step"):
        env.step(env.action_space.sample())
    with pytest.raises(InvalidValueError, match="call reset before render"):
        env.render()


def test_bad_keywords_say_what_to_do():
    with pytest.raises(UnknownNameError, match="glass"):
        GraspEnv(material="glas")
    with pytest.raises(InvalidValueError, match="mode"):
        GraspEnv(mode="X")
    with pytest.raises(InvalidValueError, match="tolerance"):
        GraspEnv(tolerance=-1.0)
    with pytest.raises(InvalidValueError, match="150 °C: a fingertip reads -20 to 100"):
        GraspEnv(sensor_temperature=150)
    with pytest.raises(InvalidValueError, match="309.15 looks like kelvin: give 36$"):
        GraspEnv(sensor_temperature=309.15)
    with pytest.raises(InvalidValueError, match="ambient_temperature must be a temperature in °C"):
        GraspEnv(ambient_temperature=-300)
    with pytest.raises(InvalidValueError, match="hold_seconds"):
        GraspEnv(hold_seconds=-1.0)
    with pytest.raises(InvalidValueError, match="seconds"):
        GraspEnv(seconds=float("nan"))
    with pytest.raises(InvalidValueError, match="colour"):
        GraspEnv(colour="red")
    with pytest.raises(UnknownNameError, match="rgb_array"):
        GraspEnv(render_mode="rgb_aray")
    with pytest.raises(UnknownNameError, match="plant"):
        GraspEnv(plant="gazebo")
    with pytest.raises(
        InvalidValueError, match="material must be a name, a Material or a list of them, got 3"
    ):
        GraspEnv(material=3)
    with pytest.raises(InvalidValueError, match="'mine.stl' is the name of a file.*ObjectSpec.shape='mesh'"):
        GraspEnv(objects="mine.stl")
    env = GraspEnv()
    with pytest.raises(InvalidValueError, match="reset"):
        env.step(np.zeros(3))
    with pytest.raises(InvalidValueError, match="options must be a dict, such as .*got 'glass'"):
        env.reset(options="glass")  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize(
    ("mode", "message"), [("T", "faces begin 7.5 mm above"), ("O", "make it 16.5 mm at least")]
)
def test_objects_lower_than_the_sensors_faces_are_refused(mode: str, message: str) -> None:
    """Forces would tell of a touch of which heat knows nothing: the pads stay off the table."""
    for shape, size in (("box", (0.03, 0.03, 0.006)), ("cylinder", (0.03, 0.03, 0.007))):
        with pytest.raises(InvalidValueError, match=rf"[67]\.0 mm high.* {message}"):
            GraspEnv(objects=ObjectSpec(shape=shape, size=size), mode=mode)  # pyright: ignore[reportArgumentType]
    drawn = ObjectSpec(size=(0.03, 0.03, 0.008 if mode == "T" else 0.018))
    with pytest.raises(InvalidValueError, match=message):  # one of the sizes that may be drawn
        GraspEnv(objects=drawn, mode=mode, randomize=[Size((0.8, 1.2))])
    if mode == "T":
        with pytest.raises(InvalidValueError, match="a sphere 10.0 mm high"):  # met 2.5 mm below the faces
            GraspEnv(objects=ObjectSpec(shape="sphere", size=(0.01, 0.01, 0.01)), mode=mode)


def test_what_just_reaches_the_sensors_faces_is_felt() -> None:
    env = GraspEnv(objects=ObjectSpec(size=(0.03, 0.03, 0.0085)), material="aluminium")
    assert run(env, 100)[-1][4]["temperature_drop"].min() > 1.0


def test_observations_share_no_memory_and_all_of_them_vary():
    env = GraspEnv(material="glass")
    env.reset(seed=0)
    seen = [env.step(grasp_action(env.batch, 10.0 + k % 2)[0])[0] for k in range(120)]
    for name in seen[0]:
        assert not np.shares_memory(seen[0][name], seen[1][name])
    for name in ("gripper", "force", "voltage"):
        values = np.array([observation[name] for observation in seen])
        assert np.all(values.std(axis=0) > 0), name


def test_reset_option_fixes_the_material():
    env = GraspEnv()
    _, info = env.reset(seed=0, options={"material": "marble"})
    assert info["material"] == "marble"
    with pytest.raises(InvalidValueError, match="options"):
        env.reset(options={"matter": "marble"})


def test_an_egg_like_object_is_crushed_by_force_and_not_by_care():
    from thermograsp.thermal import material

    weak = material("glass")
    weak = type(weak)(
        "eggshell-like",
        weak.conductivity,
        weak.density,
        weak.specific_heat,
        roughness=1e-6,
        youngs_modulus=1e9,
        friction=0.8,
        crushing_stress=50e3,
    )
    hard = run(GraspEnv(material=weak), 100, force=38.0)
    soft = run(GraspEnv(material=weak), 100, force=8.0)
    assert any(step[4].get("crushed") and step[2] and step[1] < 0 for step in hard)
    assert not any(step[4].get("crushed") for step in soft)


@pytest.mark.parametrize("shape", ["cylinder", "sphere"])
def test_curved_objects_are_grasped_and_felt(shape):
    env = GraspEnv(
        material="aluminium", objects=ObjectSpec(shape=shape, mass=0.1), hold_seconds=0.5, placement=(0, 0)
    )
    steps = run(env, 250)
    assert any(step[4]["success"] for step in steps)
    assert steps[200][4]["temperature_drop"].min() > 1.0


def test_a_broken_simulation_truncates_that_episode_with_the_reason():
    env = GraspEnv(material="glass")
    run(env, 30)
    before = env.batch.state()
    env.batch.plant.mechanics._qpos[0, 0] = np.nan  # pyright: ignore[reportAttributeAccessIssue]
    observation, reward, terminated, truncated, info = env.step(np.zeros(3))
    assert truncated and not terminated and info["error"] and reward == 0
    assert env.observation_space.contains(observation)
    env.set_state(before)
    assert not env.step(np.zeros(3))[3]
