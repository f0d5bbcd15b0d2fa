"""The map of temperature over a sensor's face: its mean is the network's, its pattern that of the contact."""

import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from thermograsp.envs import (
    GraspBatch,
    GraspEnv,
    GraspVectorEnv,
    ObjectSpec,
    SortEnv,
)
from thermograsp.envs.spaces.map_observation import FACE_TEMPERATURE
from thermograsp.errors import InvalidValueError
from thermograsp.thermal import Thermostat

CLOSE = np.array([-1.0, -0.5, 0.0])
ACTIONS = [CLOSE] * 60 + [np.array([-1.0, -0.5, 1.0])] * 20
STILL = {"placement": (0.0, 0.0), "tolerance": 0.5, "skin": None}  # a skin evens out what these tests look at


def held(steps: int = 75, **config):
    """The environment and what it saw last."""
    env = GraspEnv(**STILL, **config)
    seen, _ = env.reset(seed=0)
    for _ in range(steps):
        seen, *_ = env.step(CLOSE)
    return env, seen


def surface(env: GraspEnv) -> np.ndarray:
    """(F,) °C, the network's mean over the contact."""
    assert env.batch.reading is not None
    return env.batch.reading.truth["sensor_surface"][0]


def test_on_a_flat_face_it_is_even_and_the_network_s() -> None:
    env, seen = held(material="aluminium", face_temperature=(4, 5))
    found = seen["face_temperature"]
    assert found.shape == (2, 4, 5) and env.observation_space.contains(seen)
    assert np.ptp(found, axis=(1, 2)).max() < 0.01  # MuJoCo's pad leans by a little
    assert found.mean(axis=(1, 2)) == pytest.approx(surface(env), abs=1e-5)  # float32
    reading = env.batch.reading
    assert reading is not None and reading.face_temperature is not None
    exact = reading.face_temperature[0].mean(axis=(1, 2))
    assert exact == pytest.approx(surface(env), abs=1e-12) and exact.max() < 30.0


def test_a_bar_leaves_two_levels() -> None:
    """5 mm wide, so that it covers the middle 5 of 9 mm."""
    env, seen = held(
        material="aluminium",
        objects=ObjectSpec(size=(0.04, 0.005, 0.04)),
        face_temperature=(1, 18),
        taxels=(1, 40),
    )
    found, pressure = seen["face_temperature"][0, 0], seen["pressure"][0, 0, 11:29]
    touched = pressure > 100.0
    assert touched.sum() == 10 and not touched[:4].any() and not touched[-4:].any()
    assert found[touched].mean() == pytest.approx(surface(env)[0], abs=1e-4)
    assert found[~touched].min() > found[touched].max()
    assert found[[0, -1]].min() - found[8:10].max() > 2.0
    assert found == pytest.approx(found[::-1], abs=0.05)


def test_a_sphere_cools_the_middle_and_a_hot_one_warms_it() -> None:
    found = {}
    for celsius in (24.0, 60.0):
        _, seen = held(
            material="aluminium",
            objects=ObjectSpec(shape="sphere", temperature=celsius),
            face_temperature=(6, 6),
        )
        found[celsius] = seen["face_temperature"][0]
    for celsius, sign in ((24.0, 1.0), (60.0, -1.0)):
        each = sign * found[celsius]
        assert each[2:4, 2:4].max() < each[1:5, 1:5].mean() < each[[0, 0, -1, -1], [0, -1, 0, -1]].min()
        assert each == pytest.approx(each.T, abs=0.3) and each == pytest.approx(each[::-1], abs=0.3)
    assert np.ptp(found[24.0]) > 1.0


def test_one_is_a_batch_of_one_and_a_state_is_all() -> None:
    shapes = [ObjectSpec(), ObjectSpec(shape="sphere")]
    config = {"material": ["glass", "iron"], "objects": shapes, "face_temperature": (3, 4), "taxels": (2, 2)}
    config |= {"tolerance": 0.5, "seconds": 1.5, "thermostat": Thermostat()}
    single, vector = GraspEnv(**config), GraspVectorEnv(3, **config)
    check_env(GraspEnv(**config), skip_render_check=True)
    box = single.observation_space["face_temperature"]
    assert box.shape == (2, 3, 4)
    assert (box.low.min(), box.high.max()) == FACE_TEMPERATURE  # pyright: ignore
    rng = np.random.default_rng(0)
    seen, _ = single.reset(seed=5)
    all_seen, _ = vector.reset(seed=4)
    assert seen["face_temperature"] == pytest.approx(np.full((2, 3, 4), 36.0), abs=0.5)
    ended, saved, action = False, None, CLOSE
    for step in range(100):  # over the end of an episode
        if ended:
            seen, _ = single.reset()
            ended = False
        else:
            action = np.array([-1.0, -0.5, rng.uniform(-0.2, 0.2)])
            seen, _, terminated, truncated, _ = single.step(action)
            ended = terminated or truncated
        all_seen, *_ = vector.step(np.tile(action, (3, 1)))
        assert single.observation_space.contains(seen)
        assert np.array_equal(seen["face_temperature"], all_seen["face_temperature"][1])
        if step == 60:
            saved = single.state()
            following = [single.step(action)[0]["face_temperature"] for _ in range(4)]
            single.set_state(saved)
            again = [single.step(action)[0]["face_temperature"] for _ in range(4)]
            assert np.array_equal(following, again) and np.ptp(following[-1]) > 0.1
            single.set_state(saved)
    assert saved is not None


def test_a_face_let_go_evens_out_around_the_network_s() -> None:
    env, _ = held(material="iron", objects=ObjectSpec(shape="sphere"), face_temperature=(5, 5))
    seen: dict[str, np.ndarray] = {}
    spreads = []
    for _ in range(150):
        seen, *_ = env.step(np.array([1.0, -0.5, 0.0]))
        spreads.append(np.ptp(seen["face_temperature"][0]))
    assert spreads[0] > 0.5 > 0.05 > spreads[-1]
    assert np.diff(spreads[20:]).max() < 1e-4
    assert seen["face_temperature"].mean(axis=(1, 2)) == pytest.approx(surface(env), abs=0.02)


def test_of_several_objects_the_touched_one_s_face_counts() -> None:
    sort = SortEnv(face_temperature=(3, 3), material=["glass", "iron"], tolerance=0.5)
    seen, _ = sort.reset(seed=0)
    assert (seen["face_temperature"] == 36.0).all()
    scene = GraspEnv(
        scene=[ObjectSpec(shape="sphere"), ObjectSpec(name="other", position=(0.0, 0.1))],
        material="iron",
        face_temperature=(3, 3),
        **STILL,
    )
    alone = GraspEnv(objects=ObjectSpec(shape="sphere"), material="iron", face_temperature=(3, 3), **STILL)
    found = []
    for env in (scene, alone):
        env.reset(seed=0)
        for _ in range(60):
            seen, *_ = env.step(CLOSE)
        found.append(seen["face_temperature"])
    assert np.ptp(found[0]) > 0.5
    assert found[0] == pytest.approx(found[1], abs=0.01)


def test_a_fingertip_without_a_sensor_stays_even() -> None:
    _, seen = held(material="iron", objects=ObjectSpec(shape="sphere"), fingertips=1, face_temperature=(4, 4))
    left, right = seen["face_temperature"]
    assert np.ptp(left) > 0.5 and (right == 36.0).all()


@pytest.mark.parametrize("wrong", [(0, 4), (4, 101), (4,), 4, (2.5, 2), "44", (True, 2)])
def test_its_shape_is_checked(wrong: object) -> None:
    with pytest.raises(InvalidValueError, match="face_temperature must be two whole numbers"):
        GraspBatch(1, face_temperature=wrong)


def test_where_there_is_none() -> None:
    with pytest.raises(InvalidValueError, match="mode 'O'.*use mode 'T'"):
        GraspEnv(mode="O", face_temperature=(4, 4))
    with pytest.raises(InvalidValueError, match="a real fingertip has one heat flux sensor"):
        GraspEnv(plant="serial:///dev/null?gripper=robotiq:///dev/null", face_temperature=(4, 4))


@pytest.mark.parametrize("anywhere", [False, "auto"])
def test_no_place_of_a_face_on_a_skinned_ball_is_warmer_than_its_thermostat(anywhere: bool | str) -> None:
    """With the mean over the whole face in place of the contact's, a map was 9 K above it; 18 K as it is touched."""
    ball = ObjectSpec(shape="sphere", size=(0.04, 0.04, 0.04))
    words = {**STILL, "anywhere": anywhere, "skin": "filled_silicone"}
    env = GraspEnv(objects=ball, material="aluminium", face_temperature=(6, 6), **words)
    env.reset(seed=0)
    every = np.array([env.step(CLOSE)[0]["face_temperature"] for _ in range(60)])
    assert (every <= 36.0).all() and (every > 23.9).all()
    assert np.ptp(every[-1, 0]) > 1.0


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
@pytest.mark.parametrize(
    "shape",
    [
        ObjectSpec(shape="sphere", size=(0.04, 0.04, 0.04)),
        ObjectSpec(shape="cylinder", size=(0.04, 0.04, 0.06)),
    ],
)
def test_a_contact_s_means_are_the_same_in_fields_and_in_networks(
    shape: ObjectSpec, skin: str | None
) -> None:
    """Of a narrow contact: that of the whole face is some kelvin warmer."""
    found = []
    for anywhere in (False, "auto"):
        words = {**STILL, "anywhere": anywhere, "skin": skin}
        env = GraspEnv(
            objects=shape,
            material="aluminium",
            face_temperature=(6, 6),
            **words,
        )
        env.reset(seed=0)
        face = np.array([env.step(CLOSE)[0]["face_temperature"] for _ in range(60)])[-1, 0]
        assert env.batch.reading is not None
        truth = env.batch.reading.truth
        found.append([truth["sensor_surface"][0, 0], truth["object_surface"][0, 0], *face.ravel()])
    assert found[0] == pytest.approx(found[1], abs=0.35)
    assert found[1][0] < np.mean(found[1][2:]) - 1.0
