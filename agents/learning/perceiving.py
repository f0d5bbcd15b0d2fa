"""A vector environment whose observations are what agents perceive, for stable-baselines3."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np

from thermograsp.envs.sb3 import StableBaselinesVecEnv
from thermograsp.errors import MissingDependencyError, install

try:
    from stable_baselines3.common.vec_env import VecEnvWrapper  # pyright: ignore[reportMissingImports]
except ImportError as error:
    raise MissingDependencyError(f"stable-baselines3 is not installed: {install('rl')}") from error

from .agent import goals_of
from .inputs import REPEAT, Inputs, Memory
from .tasks import LearningTask


class Perceiving(VecEnvWrapper):
    """`num_envs` environments of a task. raw: the observations (B, ...) as they are, of the last step. batch: the
    environments' core, which knows the truth. An action lasts REPEAT control steps, and the time limit is part of the
    task. practice: with what differs while a teacher is imitated."""

    def __init__(
        self, task: LearningTask, num_envs: int, heat: bool, load: bool, practice: bool = False
    ) -> None:
        env = task.make(num_envs, practice)
        self.inputs = Inputs(heat, load, goals_of(env), closing=True, samples=True)
        self.batch: Any = env.unwrapped.batch  # pyright: ignore[reportAttributeAccessIssue]
        self.raw: Any = {}
        self._memory = Memory(self.inputs, num_envs)
        space = gymnasium.spaces.Box(-np.inf, np.inf, (self.inputs.size,), np.float32)
        super().__init__(StableBaselinesVecEnv(env, repeat=REPEAT, bootstrap=False), observation_space=space)

    def reset(self) -> np.ndarray:
        """Starts all environments."""
        self.raw = self.venv.reset()
        self._memory.restart(np.arange(self.num_envs))
        return self._memory.vector(self.raw)

    def step_wait(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[dict[str, Any]]]:
        """(inputs, reward, ended, infos)."""
        self.raw, reward, ended, infos = self.venv.step_wait()
        for info in infos:
            info.pop("terminal_observation", None)  # a dictionary; no learner asks for it without bootstrap
        self._memory.restart(np.flatnonzero(ended))
        return self._memory.vector(self.raw), reward, ended, infos
