"""Heat for Gymnasium environments of others, unmodified."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import gymnasium
import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError

from ...thermal import Material
from ..readings import SAMPLES
from ..scene import Fingertip, ThermalBody
from ..thermal_touch import ThermalTouch
from .substeps import SteppedTouch

VOLTAGE = "voltage"
"""The observation's new entry."""
OBSERVATION = "observation"
"""That of what was the whole observation, where that was no Dict."""


class AddThermalObservation(gymnasium.Wrapper, gymnasium.utils.RecordConstructorArgs):
    """Adds "voltage" (F, 16) V to the observation of a Gymnasium environment that has MuJoCo's `model` and `data`.

    A Dict observation gains the entry; any other becomes Dict(observation=..., voltage=...). info["touch"] is the last
    TouchReading. fingertips, objects and further words: those of ThermalTouch. Every substep is heard, also where the
    environment takes several in one call of mj_step: while it steps, mujoco.mj_step is replaced by one that hears them,
    so environments that step in several threads of a process are not served. An environment that makes its
    model anew at a reset gets a ThermalTouch anew.
    """

    def __init__(
        self,
        env: gymnasium.Env,
        *,
        fingertips: Mapping[str, str | Fingertip],
        objects: Mapping[str, str | Material | ThermalBody] | None = None,
        **words: Any,
    ) -> None:
        every = {"fingertips": fingertips, "objects": objects, **words}
        gymnasium.utils.RecordConstructorArgs.__init__(self, **every)  # env.spec tells them
        gymnasium.Wrapper.__init__(self, env)
        self._stepped = SteppedTouch(_simulation, env, every)
        shape = (len(self.touch.fingertips), SAMPLES)
        most = self.touch.most_voltage
        volts = gymnasium.spaces.Box(-most, most, shape, np.float32)
        space = env.observation_space
        self._is_dict = isinstance(space, gymnasium.spaces.Dict)
        if isinstance(space, gymnasium.spaces.Dict):
            if VOLTAGE in space.spaces:
                raise InvalidValueError(f"the environment's observation has an entry {VOLTAGE!r} already")
            self.observation_space = gymnasium.spaces.Dict({**space.spaces, VOLTAGE: volts})
        else:
            self.observation_space = gymnasium.spaces.Dict({OBSERVATION: space, VOLTAGE: volts})

    @property
    def touch(self) -> ThermalTouch:
        """Of the environment's present model."""
        return self._stepped.touch

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """As the environment's; fingertips and objects start at their first temperatures."""
        observation, info = self.env.reset(seed=seed, options=options)
        self._stepped.restart(seed)
        return self._with_voltage(observation), {**info, "touch": self.touch.reading}

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """As the environment's, with every substep heard."""
        with self._stepped:
            observation, reward, terminated, truncated, info = self.env.step(action)
        info = {**info, "touch": self.touch.reading}
        return self._with_voltage(observation), reward, terminated, truncated, info

    def _with_voltage(self, observation: Any) -> dict[str, Any]:
        volts = self.touch.reading.voltage.astype(np.float32)
        if self._is_dict:
            return {**observation, VOLTAGE: volts}
        return {OBSERVATION: observation, VOLTAGE: volts}


def _simulation(env: gymnasium.Env) -> tuple[mujoco.MjModel, mujoco.MjData]:
    bare = env.unwrapped
    model, data = getattr(bare, "model", None), getattr(bare, "data", None)
    if not isinstance(model, mujoco.MjModel) or not isinstance(data, mujoco.MjData):
        raise InvalidValueError(
            f"{type(bare).__name__} has no MuJoCo `model` and `data`: call ThermalTouch.update after its steps"
        )
    return model, data
