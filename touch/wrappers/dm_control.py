"""Heat for dm_control's environments, unmodified."""

# dm_control brings no types, and the tests that need it run in an environment of their own; what dm_env infers for its
# abstract methods is None
# pyright: reportMissingImports=false, reportIncompatibleMethodOverride=false

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from thermograsp.errors import MissingDependencyError

from ...thermal import Material
from ..readings import SAMPLES
from ..scene import Fingertip, ThermalBody
from ..thermal_touch import ThermalTouch
from .substeps import SteppedTouch

try:
    import dm_env
    from dm_env import specs
except ImportError as error:
    raise MissingDependencyError(
        "dm_env, a part of dm_control, is not installed: pip install dm-control"
    ) from error

VOLTAGE = "voltage"


class DmControlThermalWrapper(dm_env.Environment):
    """Adds "voltage" (F, 16) V to the observations of a dm_control environment, of the suite or the composer.

    fingertips, objects and further words: those of ThermalTouch, whose last reading is `touch.reading`. Every substep
    is heard; where a reset makes the model anew, the ThermalTouch is too."""

    def __init__(
        self,
        env: Any,
        *,
        fingertips: Mapping[str, str | Fingertip],
        objects: Mapping[str, str | Material | ThermalBody] | None = None,
        **words: Any,
    ) -> None:
        self._env = env
        every = {"fingertips": fingertips, "objects": objects, **words}
        self._stepped = SteppedTouch(_simulation, env, every)

    @property
    def touch(self) -> ThermalTouch:
        """Of the environment's present model."""
        return self._stepped.touch

    @property
    def physics(self) -> Any:
        """The environment's."""
        return self._env.physics

    def reset(self) -> Any:
        """As the environment's; fingertips and objects start at their first temperatures."""
        first = self._env.reset()
        self._stepped.restart()
        return self._with_voltage(first)

    def step(self, action: np.ndarray) -> Any:
        """As the environment's, with every substep heard."""
        with self._stepped:
            step = self._env.step(action)
        if step.first():  # its own reset, after an episode's end
            self._stepped.restart()
        return self._with_voltage(step)

    def observation_spec(self) -> dict[str, Any]:
        """As the environment's, with the voltage."""
        shape = (len(self.touch.fingertips), SAMPLES)
        return {**self._env.observation_spec(), VOLTAGE: specs.Array(shape, np.float32, VOLTAGE)}

    def action_spec(self) -> Any:
        """The environment's."""
        return self._env.action_spec()

    def close(self) -> None:
        """Closes the environment."""
        self._env.close()

    def _with_voltage(self, step: Any) -> Any:
        volts = self.touch.reading.voltage.astype(np.float32)
        return step._replace(observation={**step.observation, VOLTAGE: volts})


def _simulation(env: Any) -> tuple[Any, Any]:
    return env.physics.model.ptr, env.physics.data.ptr
