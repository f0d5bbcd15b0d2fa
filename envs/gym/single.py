"""What all single environments share: one gripper, one object, two fingertips that feel heat, and a task."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import gymnasium
import numpy as np
from gymnasium.envs.registration import EnvSpec

from thermograsp.errors import InvalidValueError, unknown_name, whole_number
from thermograsp.opengl import has_display

from ..spaces import Observation
from ..tasks import Task
from .batch import BatchState, GraspBatch, info_of
from .copies import Copied
from .keywords import check_keywords

RENDER_MODES = ["human", "rgb_array"]


class TouchEnv(Copied, gymnasium.Env[Observation, np.ndarray]):
    """One environment of a task over a plant. Keywords beyond those named go to the plant. Pickle and copy.deepcopy
    make another one in the same state."""

    metadata: dict[str, Any] = {"render_modes": RENDER_MODES, "render_fps": 50}  # noqa: RUF012

    def __init__(
        self,
        task: Task,
        render_mode: str | None = None,
        *,
        camera: str = "overview",
        width: int = 480,
        height: int = 360,
        **config: Any,
    ) -> None:
        if render_mode is not None and render_mode not in RENDER_MODES:
            raise unknown_name("render_mode", render_mode, RENDER_MODES)
        check_keywords(type(self), config)
        self.batch = GraspBatch(1, task=task, **config)
        # an instance lists what can be drawn here, which Gymnasium's check_env tries
        modes = [mode for mode in RENDER_MODES if mode in ("rgb_array", render_mode) or has_display()]
        self.metadata = {
            **self.metadata,
            "render_modes": modes,
            "render_fps": frames_per_second(self.batch.dt),
        }
        self.observation_space: gymnasium.spaces.Dict = self.batch.observation_space  # pyright: ignore
        self.action_space = self.batch.action_space
        self.render_mode = render_mode
        self._picture = (camera, whole_number("width", width, 1), whole_number("height", height, 1))
        self._spec: EnvSpec | None = None
        self._renderer: Any = None

    @property
    def spec(self) -> EnvSpec | None:  # pyright: ignore[reportIncompatibleVariableOverride]
        """What gymnasium.make made it of, with the time limit as max_episode_steps."""
        return self._spec

    @spec.setter
    def spec(self, spec: EnvSpec | None) -> None:  # pyright: ignore[reportIncompatibleVariableOverride]
        self._spec = None if spec is None else replace(spec, max_episode_steps=self.batch.time_limit)

    @property
    def _max_episode_steps(self) -> int | None:
        """By the name that Gymnasium's TimeLimit gives it."""
        return self.batch.time_limit

    @property
    def model(self) -> Any:
        """The mujoco.MjModel. Raises InvalidValueError on hardware, which has none."""
        model = getattr(self.batch.plant, "model", None)
        if model is None:
            raise InvalidValueError("this plant is not simulated: there is no MuJoCo model")
        return model

    @property
    def dt(self) -> float:
        """s, the control period."""
        return self.batch.dt

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """A new episode; the same seed gives the same bits. Raises ClosedEnvironmentError after close, as step and
        render do."""
        self.batch.require_open("reset")
        super().reset(seed=seed)
        seen, reading = self.batch.reset([0], [self.np_random], options)
        if self.render_mode == "human":
            self.render()
        return _first(seen), info_of(reading, None, 0)

    def step(self, action: np.ndarray) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """One control step of 20 ms."""
        seen, reward, terminated, truncated, outcome, reading = self.batch.step(np.asarray(action)[None])
        if self.render_mode == "human":
            self.render()
        info = info_of(reading, outcome, 0)
        return _first(seen), float(reward[0]), bool(terminated[0]), bool(truncated[0]), info

    def render(self) -> np.ndarray | None:
        """(height, width, 3) uint8 in "rgb_array", None in "human" (a window). Fingertips and object are coloured by
        their temperature. Raises MissingDependencyError, naming the packages, where there is no GL library, and
        InvalidValueError before the first reset."""
        self.batch.require_open("render")
        if self.render_mode is None:
            gymnasium.logger.warn("render() without a render_mode: give render_mode='rgb_array' or 'human'")
            return None
        if self.batch.never_reset(0):
            raise InvalidValueError("call reset before render")
        if self._renderer is None:
            from ..pictures import GraspPicture  # loads GL

            self._renderer = GraspPicture(self.batch.plant, self.render_mode, *self._picture)
        return self._renderer.draw(self.batch.reading)

    def state(self) -> BatchState:
        """Everything that decides the future, for set_state; picklable."""
        return self.batch.state()

    def set_state(self, state: BatchState) -> None:
        """Continues from a state, bit for bit, in this or another environment of the same keywords."""
        (self._np_random,) = self.batch.set_state(state)

    def close(self) -> None:
        """Closes the window, if any, and the plant."""
        if self._renderer is not None:
            self._renderer.close()
            self._renderer = None
        self.batch.close()


def frames_per_second(dt: float) -> float:
    """A frame a control step of dt s: a whole number where it is one."""
    rate = 1 / dt
    return round(rate) if abs(rate - round(rate)) < 1e-6 else rate


def _first(observation: Observation) -> Observation:
    return {name: value[0] for name, value in observation.items()}
