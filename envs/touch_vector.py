"""What all vector environments share: one plant, one array step."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium.utils.seeding import np_random
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from thermograsp.errors import InvalidValueError

from .grasp import GraspBatch, infos_of
from .observation import Observation
from .tasks import Task, cleared


class TouchVectorEnv(VectorEnv[Observation, np.ndarray, np.ndarray]):
    """`num_envs` environments of a task; observation, action, info and keywords as the single one's.

    Environment i of a batch reset with seed s is the single environment reset with s + i, bit for bit. An environment
    that ended is reset by the next step, which ignores its action (autoreset NEXT_STEP).
    """

    metadata: dict[str, Any] = {"autoreset_mode": AutoresetMode.NEXT_STEP, "render_modes": []}  # noqa: RUF012

    def __init__(self, task: Task, num_envs: int = 1, *, render_mode: None = None, **config: Any) -> None:
        if render_mode is not None:
            raise InvalidValueError("the vector environment draws nothing: use the single one to render")
        if num_envs < 1:
            raise InvalidValueError(f"num_envs must be at least 1, got {num_envs}")
        self.batch = GraspBatch(num_envs, task=task, **config)
        self.num_envs = num_envs
        self.single_observation_space = self.batch.observation_space
        self.single_action_space = self.batch.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._rngs: list[np.random.Generator] | None = None
        self._ended = np.zeros(num_envs, bool)

    @property
    def model(self) -> Any:
        """The mujoco.MjModel of the first environment."""
        return getattr(self.batch.plant, "model", None)

    @property
    def dt(self) -> float:
        """s, the control period."""
        return self.batch.dt

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Starts all environments. seed: s for s, s + 1, ..., or a list of one each."""
        options = dict(options or {})
        mask = np.asarray(options.pop("reset_mask", np.ones(self.num_envs, bool)), bool)
        if mask.shape != (self.num_envs,):
            raise InvalidValueError(f"reset_mask must be ({self.num_envs},), got {mask.shape}")
        if isinstance(seed, (int, np.integer)):
            seeds: list[int | None] = [int(seed) + i for i in range(self.num_envs)]
        else:
            seeds = list(seed) if seed is not None else [None] * self.num_envs
        if len(seeds) != self.num_envs:
            raise InvalidValueError(f"seed lists {len(seeds)} values for {self.num_envs} environments")
        rngs = self._rngs or [np_random(None)[0] for _ in range(self.num_envs)]
        rows = [int(row) for row in np.flatnonzero(mask)]
        for row in rows:
            if seeds[row] is not None:
                rngs[row] = np_random(seeds[row])[0]
        self._rngs = rngs
        seen, reading = self.batch.reset(rows, [rngs[row] for row in rows], options)
        self._ended[rows] = False
        return seen, infos_of(reading, None, mask)

    def step(
        self, actions: np.ndarray
    ) -> tuple[Observation, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """One control step; environments that ended before start anew instead."""
        if self._rngs is None:
            raise InvalidValueError("call reset before step")
        actions = np.asarray(actions)
        starting = self._ended.copy()
        if not starting.any():
            step = self.batch.step(actions)
            self._ended = step.terminated | step.truncated
            infos = infos_of(step.reading, step.outcome, ~starting)
            return step.observation, step.reward, step.terminated, step.truncated, infos
        rows = [int(row) for row in np.flatnonzero(starting)]
        # What the step does to a row that is about to start anew does not matter; its action must only be valid, and
        # the random numbers that it takes are given back.
        before = [self._rngs[row].bit_generator.state for row in rows]
        step = self.batch.step(np.where(starting[:, None], 0.0, actions))
        for row, state in zip(rows, before, strict=True):
            self._rngs[row].bit_generator.state = state
        seen, reading = self.batch.reset(rows, [self._rngs[row] for row in rows])
        outcome = cleared(step.outcome, starting)
        self._ended = outcome.terminated | outcome.truncated
        infos = infos_of(reading, outcome, np.ones(self.num_envs, bool), ~starting)
        return seen, outcome.reward, outcome.terminated, outcome.truncated, infos

    def close_extras(self, **kwargs: Any) -> None:
        """Releases the plant."""
        del kwargs
        self.batch.close()
