"""Squeeze, feel and declare what an object is made of: reward and the end of an episode, as pure functions of arrays.

B: environments, K: classes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import gymnasium
import numpy as np

from thermograsp.errors import InvalidValueError, non_negative, positive
from thermograsp.plant import Command, Reading

from ..limits import MAX_FORCE, MAX_OPENING
from ..spaces import checked_action
from .task import Outcome

SHARPNESS = 5.0  # of the declared distribution: softmax of 5 times the action, at most e^10 to 1
DECLARES = 0.5
"""The action that declares is above it."""


IDENTIFY_STATE = np.dtype([("elapsed", "f8")])
"""s."""


@dataclass(frozen=True, slots=True)
class IdentifyTask:
    """Name the material, one of `classes`, within `seconds`. Action (2 + K,), each -1 .. 1: force (above 0: close with
    that share of 40 N, else open), declare (above .5: the episode ends with this step's distribution), and the
    distribution over the classes, softmax of SHARPNESS times these. As in active perception in general, an action is
    deed and prediction in one, and the prediction's loss is in the reward.

    Reward: -cost_per_second while it lasts; at the end 1 + log p / log K, p the share given to the true class: 1 for
    certainty, 0 for an even distribution, below for a wrong one. At the time limit the last distribution counts.
    Success is a declaration whose largest share is the true class's.
    Raises InvalidValueError for fewer than two classes, a repeated one, or numbers that make no sense.
    """

    reasons: ClassVar[tuple[str, ...]] = ()

    classes: tuple[str, ...]
    seconds: float = 4.0
    cost_per_second: float = 0.1

    def __post_init__(self) -> None:
        if len(set(self.classes)) != len(self.classes) or len(self.classes) < 2:
            raise InvalidValueError(
                f"materials to tell apart must be two at least and differ, got {list(self.classes)}"
            )
        positive("seconds", self.seconds)
        non_negative("cost_per_second", self.cost_per_second)

    def action_space(self) -> gymnasium.spaces.Box:
        """(2 + K,): force, declare, distribution."""
        return gymnasium.spaces.Box(-1.0, 1.0, (2 + len(self.classes),), np.float32)

    def command(self, action: np.ndarray) -> Command:
        """The arm stays down; the fingers close or open."""
        classes = len(self.classes)
        array = checked_action(action, 2 + classes, f"force, declare and {classes} classes")
        force = np.clip(array[:, 0], 0.0, 1.0) * MAX_FORCE
        return Command(np.where(force > 0, 0.0, MAX_OPENING), force, np.zeros(len(array)))

    def fresh(self, num_envs: int) -> np.ndarray:
        """Before the first step."""
        return np.zeros(num_envs, IDENTIFY_STATE)

    def judge(
        self, state: np.ndarray, dt: float, action: np.ndarray, reading: Reading
    ) -> tuple[np.ndarray, Outcome]:
        """After a control step of dt s. Where a plant cannot know the material, reward is the cost alone and success
        never comes."""
        rows = len(state)
        names = reading.truth.get("material", np.full(rows, "", object))
        target = np.array([self.classes.index(name) if name in self.classes else -1 for name in names])
        known, every = target >= 0, np.arange(rows)
        after = np.empty_like(state)
        after["elapsed"] = elapsed = state["elapsed"] + dt
        declared = np.ascontiguousarray(action[:, 2:], dtype=float)
        share = np.exp(SHARPNESS * np.minimum(np.maximum(declared, -1.0), 1.0))
        share /= share.sum(axis=1, keepdims=True)
        loss = np.where(known, -np.log(share[every, target]), np.nan)
        terminated = action[:, 1] > DECLARES
        truncated = ~terminated & (elapsed >= self.seconds - dt / 2)
        gained = np.where(known & (terminated | truncated), 1 - loss / np.log(len(self.classes)), 0.0)
        outcome = Outcome(
            reward=gained - self.cost_per_second * dt,
            success=terminated & known & (share.argmax(axis=1) == target),
            terminated=terminated,
            truncated=truncated,
            reasons={},
            info={"prediction": share, "loss": loss},
        )
        return after, outcome
