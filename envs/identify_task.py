"""Squeeze, feel and declare what an object is made of: reward and the end of an episode, as pure functions of arrays.

B: environments, K: classes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import gymnasium
import numpy as np
from numba import njit

from thermograsp.errors import InvalidValueError, non_negative, positive
from thermograsp.plant import Command, Reading

from .mechanics import MAX_FORCE
from .scene import MAX_OPENING
from .tasks import Outcome

SHARPNESS = 5.0  # of the declared distribution: softmax of 5 times the action, at most e^10 to 1
_DECLARES = 0.5


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
        array = np.asarray(action, dtype=float)
        if array.ndim != 2 or array.shape[1] != 2 + len(self.classes):
            raise InvalidValueError(
                f"an action is ({2 + len(self.classes)},): force, declare and {len(self.classes)} classes, each "
                f"-1 .. 1; got shape {np.shape(action)[1:]}"
            )
        if not np.isfinite(array).all():
            row = int(np.argmin(np.isfinite(array).all(axis=1)))
            raise InvalidValueError(
                f"action {array[row]} of environment {row} is not finite: give numbers in -1 .. 1"
            )
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
        after = np.empty(rows, IDENTIFY_STATE)
        reward, loss = np.empty((2, rows))
        success, terminated, truncated = np.empty((3, rows), bool)
        share = np.empty((rows, len(self.classes)))
        _judge_rows(
            *(dt, self.seconds, self.cost_per_second, np.ascontiguousarray(action, dtype=float), target),
            *(state, after, reward, loss, success, terminated, truncated, share),
        )
        told = {"prediction": share, "loss": loss}
        return after, Outcome(reward, success, terminated, truncated, {}, told)


@njit(cache=True, error_model="numpy")
def _judge_rows(
    dt,
    seconds,
    cost,
    action,
    target,
    before,
    after,
    reward,
    loss,
    success,
    terminated,
    truncated,
    share,
):
    rows, classes = share.shape
    for b in range(rows):
        after[b].elapsed = before[b].elapsed + dt
        total, best = 0.0, 0
        for k in range(classes):
            share[b, k] = math.exp(SHARPNESS * min(max(action[b, 2 + k], -1.0), 1.0))
            total += share[b, k]
            if share[b, k] > share[b, best]:
                best = k
        for k in range(classes):
            share[b, k] /= total
        known = target[b] >= 0
        loss[b] = -math.log(share[b, target[b]]) if known else math.nan
        terminated[b] = action[b, 1] > _DECLARES
        truncated[b] = not terminated[b] and after[b].elapsed >= seconds - dt / 2
        success[b] = terminated[b] and known and best == target[b]
        reward[b] = -cost * dt
        if known and (terminated[b] or truncated[b]):
            reward[b] += 1 - loss[b] / math.log(classes)
