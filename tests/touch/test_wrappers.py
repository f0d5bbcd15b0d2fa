"""Heat for environments that others wrote."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import copy
import importlib.util
import pickle
import subprocess
import sys
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import gymnasium
import mujoco
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import thermograsp
from thermograsp.errors import InvalidValueError
from thermograsp.thermal.stack import heated_stack
from thermograsp.touch import Fingertip

_spec = importlib.util.spec_from_file_location("hand", Path(__file__).with_name("hand.py"))
assert _spec and _spec.loader
hand = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(hand)

_STEP = mujoco.mj_step
PADS = {name: f"{name}_pad" for name in hand.FINGERS}


class OtherEnv(gymnasium.Env):
    """Ten substeps in one call, as gymnasium's own MuJoCo environments take them. anew: a new model at each reset."""

    def __init__(self, anew: bool = False) -> None:
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (2,), np.float64)
        self.action_space = gymnasium.spaces.Box(-20.0, 20.0, (1,), np.float32)
        self.model, self.data = hand.hand()
        self.anew = anew

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> Any:
        super().reset(seed=seed)
        if self.anew:
            self.model, self.data = hand.hand()
        mujoco.mj_resetData(self.model, self.data)
        return self.data.qpos[:2].copy(), {}

    def step(self, action: Any) -> Any:
        hand.press(self.data, float(action[0]))
        mujoco.mj_step(self.model, self.data, nstep=10)
        return self.data.qpos[:2].copy(), 0.0, False, False, {}


@pytest.mark.parametrize("anew", [False, True])
def test_every_substep_of_an_environment_is_heard(anew: bool) -> None:
    step = mujoco.mj_step
    env = thermograsp.wrappers.AddThermalObservation(
        OtherEnv(anew), fingertips=PADS, objects={"can": "aluminium"}, chain="ideal"
    )
    model, data = hand.hand()
    touch = thermograsp.ThermalTouch(model, fingertips=PADS, objects={"can": "aluminium"}, chain="ideal")
    env.reset(seed=0)
    observation, info = env.reset(seed=0)
    assert observation in env.observation_space
    touch.reset(data, seed=0)
    for _ in range(30):
        observation, _, _, _, info = env.step(np.array([10.0]))
        hand.press(data, 10.0)
        for _ in range(10):
            mujoco.mj_step(model, data)
            touch.update(data)
    assert observation in env.observation_space
    np.testing.assert_array_equal(info["touch"].voltage, touch.reading.voltage)
    assert (info["touch"].temperature_drop > 1.0).all()
    assert mujoco.mj_step is step


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_a_copy_feels_its_own_simulation(copied: Any) -> None:
    def felt(one: Any) -> Any:
        return [one.step(np.array([10.0]))[4]["touch"] for _ in range(10)][-1]

    env = thermograsp.wrappers.AddThermalObservation(
        OtherEnv(), fingertips=PADS, objects={"can": "aluminium"}
    )
    env.reset(seed=0)
    first = felt(env)
    again = copied(env)
    alone = felt(again)
    assert alone.time == pytest.approx(first.time + 0.2) and (alone.temperature_drop > 1.0).all()
    assert felt(env) == alone != first
    again.reset(seed=0)
    assert env.touch.reading == alone != again.touch.reading


def test_gymnasiums_check_passes_and_its_spec_makes_it_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gymnasium.envs.registration, "registry", {})
    gymnasium.register("Other-v0", lambda **words: OtherEnv(**words), max_episode_steps=7)
    env = thermograsp.wrappers.AddThermalObservation(
        gymnasium.make("Other-v0"), fingertips=PADS, objects={"can": "aluminium"}
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of what OtherEnv's own spaces are
        check_env(env, skip_render_check=True)
    assert env.spec is not None
    again: Any = gymnasium.make(env.spec)
    assert again.observation_space == env.observation_space
    assert again.touch.fingertips == env.touch.fingertips and again.touch.objects == ("can",)


def test_a_geom_that_a_reset_resizes_is_felt_as_it_is_then() -> None:
    env = thermograsp.wrappers.AddThermalObservation(
        OtherEnv(), fingertips=PADS, objects={"can": "aluminium"}
    )
    before = env.touch
    env.reset(seed=0)
    assert env.touch is before
    env.get_wrapper_attr("model").geom("can_wall").size[1] *= 0.5
    with pytest.raises(InvalidValueError, match="other sizes or places than when"):
        before.reset()
    env.reset(seed=0)
    assert env.touch is not before
    assert env.touch._shapes[0].size[2] == pytest.approx(before._shapes[0].size[2] / 2)


def test_the_voltage_of_a_divider_is_in_the_observation_space() -> None:
    sensor = heated_stack("heated_thermistor")
    sensor = replace(sensor, divider=replace(sensor.divider, supply=3.3))
    env = thermograsp.wrappers.AddThermalObservation(
        OtherEnv(),
        fingertips={"thumb": Fingertip("thumb_pad", sensor=sensor)},
        objects={"can": "aluminium"},
    )
    observation, _ = env.reset(seed=0)
    assert observation["voltage"].max() > 1.0 and observation in env.observation_space


class ByName(OtherEnv):
    """Steps by a function that it has imported by name."""

    def step(self, action: Any) -> Any:
        hand.press(self.data, float(action[0]))
        _STEP(self.model, self.data, nstep=10)
        return self.data.qpos[:2].copy(), 0.0, False, False, {}


def test_steps_by_a_function_imported_by_name_are_felt() -> None:
    pressed = []
    for other in (ByName(), OtherEnv()):
        env = thermograsp.wrappers.AddThermalObservation(
            other, fingertips=PADS, objects={"can": "aluminium"}, chain="ideal"
        )
        env.reset(seed=0)
        for _ in range(30):
            env.step(np.array([10.0]))
        pressed.append(env.touch.reading.temperature_drop)
    assert (pressed[0] > 1.0).all()
    np.testing.assert_allclose(*pressed, rtol=0.05)


def test_an_environment_without_mujoco_is_refused() -> None:
    with pytest.raises(InvalidValueError, match="has no MuJoCo"):
        thermograsp.wrappers.AddThermalObservation(gymnasium.make("CartPole-v1"), fingertips=PADS)


def test_it_has_one_name_however_it_is_imported() -> None:
    """By a process that has imported nothing of ours yet; `thermograsp.wrappers` is a module, not only a name."""
    code = """
import os
import gymnasium, mujoco, numba, scipy.optimize  # once for all of them
for line in ("", "from thermograsp import wrappers", "import thermograsp.wrappers", "thermograsp.wrappers"):
    if os.fork() == 0:
        import thermograsp
        exec(line)
        from thermograsp.wrappers import AddThermalObservation
        import thermograsp.touch.wrappers
        assert AddThermalObservation is thermograsp.wrappers.AddThermalObservation
        assert AddThermalObservation is thermograsp.touch.wrappers.AddThermalObservation
        os._exit(0)
    assert os.wait()[1] == 0, line
"""
    subprocess.run([sys.executable, "-c", code], check=True)
