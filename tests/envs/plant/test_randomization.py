"""Each cause changes what it says, from the environment's own generator, and nothing when it is off."""

from __future__ import annotations

import numpy as np
import pytest

from thermograsp.envs import (
    EVERYTHING,
    Delay,
    Friction,
    Gain,
    GraspBatch,
    GraspEnv,
    GraspVectorEnv,
    Mass,
    Noise,
    ObjectSpec,
    ObjectTemperature,
    Offset,
    Roughness,
    Size,
    ThermostatError,
    action_of,
)
from thermograsp.envs.plant.config import SimulationConfig
from thermograsp.envs.plant.randomization import CAUSES
from thermograsp.errors import InvalidValueError

SQUEEZE = action_of(0.0, 10.0, 0.0)
PLAIN = {"material": "glass", "placement": (0.0, 0.0)}


def squeezed(seed: int = 0, steps: int = 80, **keywords):
    """The voltages (n, 2) of a squeeze, and the environment after it."""
    env = GraspEnv(**{**PLAIN, **keywords})
    env.reset(seed=seed)
    voltages = [env.step(SQUEEZE)[0]["voltage"][:, -2:].T for _ in range(steps)]
    return np.concatenate(voltages), env


def test_without_causes_nothing_is_drawn_or_told():
    _, info = GraspEnv(**PLAIN).reset(seed=0)
    assert "randomized" not in info


@pytest.mark.parametrize("cause", EVERYTHING, ids=lambda cause: type(cause).__name__)
def test_a_cause_is_drawn_within_its_range_and_told(cause):
    env = GraspEnv(**PLAIN, randomize=[cause], cache=True)
    name = CAUSES[type(cause)][0]
    drawn = []
    for seed in range(6 if not isinstance(cause, Size) else 2):
        _, info = env.reset(seed=seed)
        assert list(info["randomized"]) == [name]
        drawn.append(info["randomized"][name])
    if isinstance(cause, Size):
        assert all(cause.low < value < cause.high for value in drawn) and len(set(drawn)) == len(drawn)
    elif isinstance(cause, Delay):
        assert set(drawn) <= set(range(cause.most + 1))
    else:
        assert all(cause.low <= value <= cause.high for value in drawn) and len(set(drawn)) == len(drawn)
    env.reset(seed=0)
    again = env.reset(seed=0)[1]["randomized"][name]
    assert again == drawn[0]


@pytest.mark.parametrize(
    "keywords",
    [
        {"objects": ObjectSpec(shape="cylinder", size=(0.05, 0.05, 0.06))},
        {"objects": ObjectSpec(size=(0.009, 0.04, 0.04)), "anywhere": False},
        {"tolerance": 0.03},
        {"object_temperature": 10.0},
        {"mode": "O"},
    ],
    ids=["cylinder", "thin", "tolerance", "cold", "O"],
)
def test_sizes_are_drawn_by_steps_where_each_needs_a_network_that_is_searched(keywords):
    config = SimulationConfig(**keywords, randomize=[Size()])
    assert config.causes == (Size((0.8, 0.9, 1.0, 1.1, 1.2)),) and not config.any_size
    assert not SimulationConfig(randomize=[Mass()]).any_size and SimulationConfig(randomize=[Size()]).any_size


def test_causes_do_what_they_say():
    plain, _ = squeezed(signal="ideal")
    warmer, _ = squeezed(signal="ideal", randomize=[ObjectTemperature(3.0, 3.0)])
    assert warmer[-1] == pytest.approx(plain[-1] * 9 / 12, rel=1e-3)
    hotter, env = squeezed(signal="ideal", randomize=[ThermostatError(1.2, 1.2)])
    assert hotter[-1] == pytest.approx(plain[-1] * 13.2 / 12, rel=1e-3)
    assert env.batch.reading is not None and np.all(env.batch.reading.thermostat == 36.0)
    stronger, _ = squeezed(signal="ideal", randomize=[Gain(0.01, 0.01)])
    assert np.allclose(stronger, 1.01 * plain, rtol=1e-6)
    moved, _ = squeezed(signal="ideal", randomize=[Offset(1e-4, 1e-4)])
    assert np.allclose(moved, plain + 1e-4, atol=1e-9)
    late, _ = squeezed(signal="ideal", randomize=[Delay(0)])
    assert np.array_equal(late, plain)
    rougher, _ = squeezed(signal="ideal", randomize=[Roughness(2.0, 2.0)])
    assert np.all(rougher[-20:] < plain[-20:])


def test_a_delay_shifts_the_voltage_by_whole_samples():
    plain, _ = squeezed(signal="ideal")
    delays = set()
    for seed in range(6):
        late, env = squeezed(seed, signal="ideal", randomize=[Delay(3)])
        assert env.batch.reading is not None
        lag = int(env.batch.reading.truth["randomized"]["delay_samples"][0])
        assert np.array_equal(late[lag:], plain[: len(plain) - lag]) and not late[:lag].any()
        delays.add(lag)
    assert len(delays) > 1


def test_noise_has_the_spread_it_is_given():
    quiet = squeezed(randomize=[Noise(1.0, 1.0)], object_temperature=36.0, steps=400)[0]
    loud = squeezed(randomize=[Noise(4.0, 4.0)], object_temperature=36.0, steps=400)[0]
    # The converter's own step adds its twelfth.
    ratio = np.sqrt((16 + 1 / 12) / (1 + 1 / 12))
    assert loud.std() / quiet.std() == pytest.approx(ratio, rel=0.08)


def test_mass_friction_and_size_are_those_of_the_model():
    env = GraspEnv(**PLAIN, randomize=[Mass(2.0, 2.0), Friction(0.5, 0.5), Size((0.5,))])
    env.reset(seed=0)
    plain = GraspEnv(**PLAIN)
    plain.reset(seed=0)
    body = plain.model.body("object").id
    scaled, other = (each.batch.plant.mechanics.env_model(0) for each in (env, plain))  # pyright: ignore
    assert scaled.body_mass[body] == pytest.approx(2 * other.body_mass[body] / 8)
    geom = scaled.body_geomadr[body]
    assert scaled.geom_friction[geom, 0] == pytest.approx(other.geom_friction[geom, 0] / 2)
    assert np.allclose(scaled.geom_size[geom], other.geom_size[geom] / 2)


def test_vector_and_single_agree_with_everything_on_and_shapes_mixed():
    shapes = [ObjectSpec(), ObjectSpec(shape="cylinder", size=(0.05, 0.05, 0.06))]
    keywords = {
        "material": ["glass", "copper"],
        "objects": shapes,
        "randomize": [cause for cause in EVERYTHING if not isinstance(cause, Size)],
    }
    vector = GraspVectorEnv(3, **keywords)
    seen, info = vector.reset(seed=4)
    singles = [GraspEnv(**keywords) for _ in range(3)]
    firsts = [single.reset(seed=4 + i) for i, single in enumerate(singles)]
    actions = np.tile(SQUEEZE, (3, 1))
    for k in range(70):
        for i, single in enumerate(singles):
            alone, alone_info = firsts[i]
            if k > 0:
                alone, _, _, _, alone_info = single.step(actions[i])
            assert all(np.array_equal(alone[key], seen[key][i]) for key in alone)
            assert all(info["randomized"][n][i] == value for n, value in alone_info["randomized"].items())
        seen, _, _, _, info = vector.step(actions)
        assert info["_randomized"].all() and info["randomized"]["_mass_factor"].all()


def test_a_saved_state_keeps_what_was_drawn():
    batch = GraspBatch(
        2, material="glass", randomize=[Gain(), Delay(), ThermostatError(), ObjectTemperature()]
    )
    batch.reset([0, 1], [np.random.default_rng(i) for i in range(2)])
    for _ in range(40):
        batch.step(np.tile(SQUEEZE, (2, 1)))
    state = batch.state()
    first = [batch.step(np.tile(SQUEEZE, (2, 1))).observation["voltage"] for _ in range(20)]
    batch.reset([0, 1], [np.random.default_rng(i + 9) for i in range(2)])
    batch.set_state(state)
    again = [batch.step(np.tile(SQUEEZE, (2, 1))).observation["voltage"] for _ in range(20)]
    assert np.array_equal(first, again)


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"randomize": ["mass"]}, "is not a randomisation"),
        ({"randomize": [Mass(), Mass()]}, "given twice"),
        ({"randomize": [Size((3.0,))]}, "wide"),
        (
            {"objects": "apple", "randomize": [Size((0.8, 1.2))]},
            "cannot be 1.2 times as large.*narrow its range",
        ),
        ({"objects": []}, "at least one"),
        ({"substeps": 7}, "whole number"),
        ({"randomize": [ObjectTemperature(-500.0, 0.0)]}, "24 °C with randomize's ObjectTemperature.*-476"),
        (
            {"objects": ObjectSpec(temperature=240.0), "randomize": [ObjectTemperature(0.0, 20.0)]},
            "240 °C with randomize's ObjectTemperature.*260",
        ),
        ({"randomize": [ThermostatError(-1.0, 900.0)]}, "36 °C with randomize's ThermostatError.*936"),
    ],
)
def test_bad_keywords_are_refused_at_once(keywords, message):
    with pytest.raises(InvalidValueError, match=message):
        GraspEnv(**keywords)


def test_bad_ranges_are_refused():
    for make in (
        lambda: Mass(2.0, 1.0),
        lambda: Friction(0.0, 1.0),
        lambda: Gain(np.nan, 1.0),
        lambda: Size(()),
        lambda: Delay(-1),
    ):
        with pytest.raises(InvalidValueError):
            make()
