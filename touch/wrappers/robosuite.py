"""Heat for robosuite's environments, unmodified."""

# robosuite brings no types, and the tests that need it run in an environment of their own
# pyright: reportMissingImports=false

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from thermograsp.errors import MissingDependencyError

from ...thermal import Material
from ..scene import Fingertip, ThermalBody
from ..thermal_touch import ThermalTouch
from .substeps import SteppedTouch

try:
    from robosuite.wrappers import Wrapper
except ImportError as error:
    raise MissingDependencyError("robosuite is not installed: pip install robosuite") from error

VOLTAGE = "voltage"


class RobosuiteThermalWrapper(Wrapper):
    """Adds "voltage" (F, 16) V to the observations of a robosuite environment; info["touch"] is the last TouchReading.

    fingertips, objects and further words: those of ThermalTouch. Every substep is heard; where a reset makes the model
    anew, the ThermalTouch is too."""

    def __init__(
        self,
        env: Any,
        *,
        fingertips: Mapping[str, str | Fingertip],
        objects: Mapping[str, str | Material | ThermalBody] | None = None,
        **words: Any,
    ) -> None:
        super().__init__(env)
        every = {"fingertips": fingertips, "objects": objects, **words}
        self._stepped = SteppedTouch(_simulation, env, every)

    @property
    def touch(self) -> ThermalTouch:
        """Of the environment's present model."""
        return self._stepped.touch

    def reset(self) -> dict[str, Any]:
        """As the environment's; fingertips and objects start at their first temperatures."""
        observation = self.env.reset()
        self._stepped.restart()
        return self._with_voltage(observation)

    def step(self, action: np.ndarray) -> tuple[dict[str, Any], float, bool, dict[str, Any]]:
        """As the environment's, with every substep heard."""
        with self._stepped:
            observation, reward, done, info = self.env.step(action)
        return self._with_voltage(observation), reward, done, {**info, "touch": self.touch.reading}

    def observation_spec(self) -> dict[str, Any]:
        """As the environment's, with the voltage."""
        return self._with_voltage(self.env.observation_spec())

    def _with_voltage(self, observation: Mapping[str, Any]) -> dict[str, Any]:
        return {**observation, VOLTAGE: self.touch.reading.voltage.astype(np.float32)}


def _simulation(env: Any) -> tuple[Any, Any]:
    return env.sim.model._model, env.sim.data._data
