"""The vector environments as stable-baselines3 wants them: `from thermograsp.envs.sb3 import StableBaselinesVecEnv`.

Importing this file needs the extra `rl`. B: environments.
"""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode

from thermograsp.errors import InvalidValueError, MissingDependencyError, install

from .gym import TouchVectorEnv
from .spaces import SIZE, Observation, Senses

try:
    from stable_baselines3.common.vec_env import VecEnv  # pyright: ignore[reportMissingImports]
except ImportError as error:
    raise MissingDependencyError(f"stable-baselines3 is not installed: {install('rl')}") from error


class StableBaselinesVecEnv(VecEnv):
    """A vector environment that learners of stable-baselines3 take, all in this process.

    env: such as gymnasium.make_vec("thermograsp/Grasp-v0", num_envs=32, vectorization_mode="vector_entry_point").
    senses: the observation is then a vector (SIZE,), for MlpPolicy; None: the dictionary, for MultiInputPolicy.
    repeat: control steps that an action lasts; rewards add up. bootstrap: a time limit is reported as such, learners
    count on what would have come after it; False where the limit is part of the task.

    An environment that ends is reset in the same step; its last observation is in info["terminal_observation"]. Raises
    InvalidValueError for another kind of environment, and for a repeat below 1.
    """

    def __init__(
        self,
        env: gymnasium.vector.VectorEnv,
        senses: Senses | None = None,
        repeat: int = 1,
        bootstrap: bool = True,
    ) -> None:
        inner = env.unwrapped
        if not isinstance(inner, TouchVectorEnv):
            raise InvalidValueError(
                f"{type(inner).__name__} is none of thermograsp's vector environments: make it with "
                "vectorization_mode='vector_entry_point'"
            )
        if inner.autoreset_mode is not AutoresetMode.NEXT_STEP:
            raise InvalidValueError(
                f"autoreset_mode {inner.autoreset_mode.value!r}: leave it out, this wrapper resets what ends by itself"
            )
        if repeat < 1:
            raise InvalidValueError(f"repeat must be at least 1, got {repeat}")
        self.env, self.senses, self.repeat, self.bootstrap = inner, senses, repeat, bootstrap
        space: gymnasium.Space[Any] = inner.single_observation_space
        if senses is not None:
            space = gymnasium.spaces.Box(-np.inf, np.inf, (SIZE,), np.float32)
        self.render_mode = None
        self._last: Observation = {}
        self._actions = np.zeros((inner.num_envs, *(inner.single_action_space.shape or ())), np.float32)
        super().__init__(inner.num_envs, space, inner.single_action_space)

    def reset(self) -> Any:
        """Starts all environments; `seed` before it seeds them."""
        seeds = None if self._seeds[0] is None else self._seeds
        observation, info = self.env.reset(seed=seeds)  # pyright: ignore[reportArgumentType]
        self._reset_seeds()
        self.reset_infos = [row_of(info, row) for row in range(self.num_envs)]
        self._last = observation
        return self._seen(observation)

    def step_async(self, actions: np.ndarray) -> None:
        """The actions (B, ...) of the next `step_wait`."""
        self._actions = np.asarray(actions)

    def step_wait(self) -> tuple[Any, np.ndarray, np.ndarray, list[dict[str, Any]]]:
        """(observation, reward (B,), ended (B,), infos)."""
        reward, ended = np.zeros(self.num_envs, np.float32), np.zeros(self.num_envs, bool)
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        observation = self._last
        for _ in range(self.repeat):
            observation, more, terminated, truncated, info = self.env.step(self._actions)
            # Where an environment ended at an earlier of these steps, this one belongs to no episode.
            live = ~ended
            reward[live] += more[live]
            stopping = live & (terminated | truncated)
            for row in np.flatnonzero(live).tolist():
                infos[row] = row_of(info, row)
            for row in np.flatnonzero(stopping).tolist():
                last = self._seen({name: values[row : row + 1] for name, values in observation.items()})
                infos[row]["terminal_observation"] = (
                    {name: values[0] for name, values in last.items()} if self.senses is None else last[0]
                )
                infos[row]["TimeLimit.truncated"] = bool(self.bootstrap and truncated[row])
            ended |= stopping
            if ended.all():
                break
        if ended.any():
            observation, info = self.env.reset(options={"reset_mask": ended})
            for row in np.flatnonzero(ended).tolist():
                self.reset_infos[row] = row_of(info, row)
        self._last = observation
        return self._seen(observation), reward, ended, infos

    def close(self) -> None:
        """Releases the plant."""
        self.env.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """An attribute of the vector environment, once for each index."""
        return [getattr(self.env, attr_name)] * len(list(self._get_indices(indices)))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Not possible: the environments are one array."""
        raise InvalidValueError(f"cannot set {attr_name!r} of single environments: they are one array")

    def env_method(self, method_name: str, *args: Any, indices: Any = None, **kwargs: Any) -> list[Any]:
        """Not possible: the environments are one array."""
        raise InvalidValueError(f"cannot call {method_name!r} of single environments: they are one array")

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        """Never."""
        return [False] * len(list(self._get_indices(indices)))

    def _seen(self, observation: Observation) -> Any:
        return observation if self.senses is None else self.senses.vector(observation)


def row_of(info: dict[str, Any], row: int) -> dict[str, Any]:
    """One environment's info from a vector environment's."""
    return {
        name: row_of(values, row) if isinstance(values, dict) else values[row]
        for name, values in info.items()
        if not name.startswith("_") and ("_" + name not in info or info["_" + name][row])
    }
