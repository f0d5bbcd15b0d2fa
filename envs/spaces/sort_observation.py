"""Observations for sorting: those of every environment, the arm's place along the table, and the goal."""

from __future__ import annotations

import gymnasium
import numpy as np

from thermograsp.errors import InvalidValueError
from thermograsp.plant import Reading

from ..limits import LATERAL_REACH
from .observation import Observation, Observer

_FURTHEST = LATERAL_REACH + 0.005  # m


class SortObserver(Observer):
    """Of `num_envs` environments with `goals` possible goals. lateral (1,) m, of the arm along y; goal (goals,), 1 for
    the episode's goal and 0 for the others."""

    def __init__(self, num_envs: int, goals: int) -> None:
        super().__init__(num_envs)
        lateral = gymnasium.spaces.Box(-_FURTHEST, _FURTHEST, (1,), np.float32)
        goal = gymnasium.spaces.Box(0.0, 1.0, (goals,), np.float32)
        self.space = gymnasium.spaces.Dict({**self.space.spaces, "lateral": lateral, "goal": goal})
        self._lateral, self._goal = (np.zeros((num_envs, *box.shape), np.float32) for box in (lateral, goal))

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """See Observer."""
        return *super().arrays, self._lateral, self._goal

    def observe(self, reading: Reading, force_limit: np.ndarray, observed: np.ndarray) -> Observation:
        """See Observer. Raises InvalidValueError for a plant without a lateral axis, and one that does not say what is
        asked."""
        observation = super().observe(reading, force_limit, observed)
        if reading.lateral is None or "goal" not in reading.truth:
            lacks = "lateral place" if reading.lateral is None else "goal in their truth"
            raise InvalidValueError(
                f"this plant's readings have no {lacks}, which sorting needs: give one with a lateral axis that takes "
                "the keyword goals, such as 'simulated' or thermograsp.hardware.SerialPlant"
            )
        bound = np.float32(_FURTHEST)
        self._lateral[observed, 0] = np.clip(reading.lateral[observed].astype(np.float32), -bound, bound)
        self._goal[observed] = reading.truth["goal"][observed]
        return {**observation, "lateral": self._lateral.copy(), "goal": self._goal.copy()}
