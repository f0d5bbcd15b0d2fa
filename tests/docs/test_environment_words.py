"""docs/environments.md is made of the environments: every word of its tables is needed, and none is missing."""

from typing import Any

import gymnasium
import numpy as np
import pytest
from environment_tables import environment_tables, info_keys, registered, variants
from environment_words import ACTIONS, COMMANDS, INFOS, OBSERVATIONS, ON_HARDWARE, SOMETIMES

from thermograsp.envs import EVERYTHING
from thermograsp.hardware.plant.serial import UNKNOWN
from thermograsp.plant import Command


@pytest.fixture(scope="module")
def page() -> str:
    return environment_tables()


def test_words_are_those_of_the_environments() -> None:
    keys: set[str] = {*SOMETIMES, *ON_HARDWARE}
    observed: set[str] = set()
    for name in registered():
        env: Any = gymnasium.make(name).unwrapped
        always, ends = info_keys(env)
        observed |= set(env.observation_space.spaces)
        keys |= {*always, *ends}
        for option, more in variants(name):
            seen, names = set(more.observation_space.spaces), set(info_keys(more)[0])
            assert seen > set(env.observation_space.spaces) or names > set(always), option
            observed |= seen
            keys |= names
            more.close()
        env.close()
    assert set(OBSERVATIONS) == observed
    assert set(INFOS) == keys
    assert set(ACTIONS) == set(registered())
    assert set(COMMANDS) == set(Command._fields)


@pytest.mark.parametrize("name", ["thermograsp/Grasp-v0", "thermograsp/Identify-v0"])
def test_nothing_is_told_that_has_no_word(name: str) -> None:
    env = gymnasium.make(name, randomize=EVERYTHING)
    _, info = env.reset(seed=0)
    names, ended = set(info), False
    while not ended:
        assert isinstance(env.action_space, gymnasium.spaces.Box)
        action = np.full(env.action_space.shape, -1.0, np.float32)
        action[1] = 1.0  # all the force, or a declaration
        _, _, terminated, truncated, info = env.step(action)
        names |= set(info)
        ended = terminated or truncated
    env.close()
    assert "randomized" in names and names <= set(INFOS)


def test_what_hardware_does_not_know_is_a_word_too() -> None:
    assert set(UNKNOWN) <= {*INFOS, "height", "lateral"}


def test_ranges_are_the_documented_ones(page: str) -> None:
    """By hand, once: the design's ranges of a gripper's action, and the bounds of what it reports."""
    for row in (
        "| 0 | target opening | 0 mm | 85 mm |",
        "| 1 | force limit | 0 N | 40 N |",
        "| 2 | lift rate of the arm | -50 mm/s | 50 mm/s |",
        "| 3 | sideways rate of the arm | -100 mm/s | 100 mm/s |",
        "| `gripper` [3] | (4,) | force limit as commanded | N | 0 | 40 |",
    ):
        assert row in page
    assert page.count("\n## thermograsp/") + page.startswith("## thermograsp/") == len(registered())
