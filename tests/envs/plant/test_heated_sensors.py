"""Grasps with sensors that have heaters of their own."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import gymnasium
import numpy as np
import pytest

import thermograsp.envs  # noqa: F401  registers the environments
from thermograsp.errors import InvalidValueError
from thermograsp.thermal.stack import Divider, heated_stack

SENSOR = heated_stack("heated_thermistor")
STEPS = 60


@pytest.fixture(scope="module")
def env() -> Iterator[gymnasium.Env]:
    made = gymnasium.make("thermograsp/Grasp-v0", sensor="heated_thermistor", material="aluminium")
    yield made
    made.close()


def squeezed(env: gymnasium.Env, seed: int = 0) -> np.ndarray:
    """Voltages (STEPS + 1, 2, 16) while the gripper closes."""
    observation, _ = env.reset(seed=seed)
    seen = [observation["voltage"]]
    close = np.array([-1.0, 0.0, -1.0], np.float32)
    for _ in range(STEPS):
        seen.append(env.step(close)[0]["voltage"])
    return np.array(seen)


def test_the_divider_sends_what_the_readout_falls_to(env: gymnasium.Env) -> None:
    volts = squeezed(env)
    degrees = SENSOR.divider.temperature(volts)
    assert degrees[0] == pytest.approx(36.0, abs=0.02)
    assert (degrees[-1, :, -1] < 35.5).all()
    assert np.abs(np.diff(degrees[:, :, -1], axis=0)).max() < 0.3
    assert degrees.min() > 24.0
    assert volts.max() < 0.25  # nothing is at the converter's end


def test_the_same_seed_and_a_restored_state_give_the_same_bits(env: gymnasium.Env) -> None:
    first, again = squeezed(env), squeezed(env)
    assert (first == again).all()
    plain: Any = env.unwrapped
    state = plain.state()
    close = np.array([-1.0, 0.0, -1.0], np.float32)
    ahead = [env.step(close)[0]["voltage"] for _ in range(5)]
    plain.set_state(state)
    assert all((one == env.step(close)[0]["voltage"]).all() for one in ahead)


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"mode": "O"}, "has a heater of its own"),
        ({"face_temperature": (3, 3)}, "leave it out"),
        ({"sensor": replace(SENSOR, divider=Divider())}, "give the divider a supply of 0.33 V"),
    ],
)
def test_what_cannot_be_served_is_refused_with_the_reason(keywords: dict[str, Any], message: str) -> None:
    keywords = {"sensor": "heated_thermistor", **keywords}
    with pytest.raises(InvalidValueError, match=message):
        gymnasium.make("thermograsp/Grasp-v0", **keywords)
