"""What a task is to an environment: the meaning of actions, reward, success and the end of an episode.

B: environments.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, NamedTuple, Protocol

import gymnasium
import numpy as np

from thermograsp.plant import Command, Reading


class Outcome(NamedTuple):
    """The result of a control step, all (B,): reward, success, terminated, truncated. reasons: name -> (B,) bool, the
    task's reasons; an episode's info names those for which it ended. info: name -> (B, ...), values that every step's
    info has."""

    reward: np.ndarray
    success: np.ndarray
    terminated: np.ndarray
    truncated: np.ndarray
    reasons: Mapping[str, np.ndarray]
    info: Mapping[str, np.ndarray]


class Task(Protocol):
    """A task as pure functions of arrays. A state is an array (B,) of records, all 0 before the first step. reasons:
    the ways in which an episode can terminate without success."""

    reasons: ClassVar[tuple[str, ...]]

    def action_space(self) -> gymnasium.spaces.Box:
        """The action space of one environment."""
        ...

    def command(self, action: np.ndarray) -> Command:
        """What actions (B, n) tell the gripper. Raises InvalidValueError for a wrong shape or a value that is not
        finite."""
        ...

    def fresh(self, num_envs: int) -> np.ndarray:
        """The state before the first step."""
        ...

    def judge(
        self, state: np.ndarray, dt: float, action: np.ndarray, reading: Reading
    ) -> tuple[np.ndarray, Outcome]:
        """The state and the outcome after a control step of dt s."""
        ...


def cleared(outcome: Outcome, rows: np.ndarray) -> Outcome:
    """The outcome with the given rows (B,) bool as if nothing had happened in them."""
    others = ~rows
    return Outcome(
        reward=np.where(rows, 0.0, outcome.reward),
        success=outcome.success & others,
        terminated=outcome.terminated & others,
        truncated=outcome.truncated & others,
        reasons={name: ended & others for name, ended in outcome.reasons.items()},
        info=outcome.info,
    )


def stopped(outcome: Outcome, rows: np.ndarray) -> Outcome:
    """The outcome with the given rows (B,) bool truncated for a reason that is no deed of the agent's."""
    outcome = cleared(outcome, rows)
    return outcome._replace(truncated=outcome.truncated | rows)
