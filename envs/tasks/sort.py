"""Lift the right one of two objects: reward, success and the end of an episode, as pure functions of arrays.

B: environments, O = 2 objects.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import gymnasium
import numpy as np

from thermograsp.errors import InvalidValueError, positive
from thermograsp.plant import Command, Reading

from ..spaces import sliding_action_space, sliding_command_of
from .grasp import LIFTED, TOUCHING
from .progress import lift_progress, step_reward
from .task import Outcome

WRONG = (
    LIFTED / 2
)  # m at which the wrong object counts as lifted; tipping one by its corner raises it by less


SORT_STATE = np.dtype([("elapsed", "f8"), ("held", "f8"), ("progress", "f8"), ("lifted", "?")])
"""s; s of the right object at 5 cm without a break; see progress.py; it has been there."""


@dataclass(frozen=True, slots=True)
class SortTask:
    """Lift the right object by 5 cm and hold it for hold_seconds without dropping or crushing it. seconds: time limit.
    Raises InvalidValueError where one of them is not above 0.

    Reward: the change of progress. Progress is 0 unless both fingertips press the right object; then it is .3 times the
    height (as a share of 5 cm) plus .5 times the time for which it has been held there without a break (as a share of
    hold_seconds). Success adds 1, minus .1 times the share of `seconds` that it took. Lifting the other object by 2.5
    cm, dropping the right one or crushing either takes back all progress and subtracts 1. Touching alone gives nothing.
    See progress.py.
    """

    reasons: ClassVar[tuple[str, ...]] = ("wrong", "dropped", "crushed")

    hold_seconds: float = 1.0
    seconds: float = 10.0

    def __post_init__(self) -> None:
        for name in ("hold_seconds", "seconds"):
            positive(name, getattr(self, name))

    def action_space(self) -> gymnasium.spaces.Box:
        """See actions.py."""
        return sliding_action_space()

    def command(self, action: np.ndarray) -> Command:
        """See actions.py."""
        return sliding_command_of(action)

    def fresh(self, num_envs: int) -> np.ndarray:
        """Before the first step."""
        return np.zeros(num_envs, SORT_STATE)

    def judge(
        self, state: np.ndarray, dt: float, action: np.ndarray, reading: Reading
    ) -> tuple[np.ndarray, Outcome]:
        """After a control step of dt s. Raises InvalidValueError for a plant that does not know which object is
        right."""
        del action
        truth = reading.truth
        if "right" not in truth:
            raise InvalidValueError("this plant does not know two objects: sorting needs a simulated pair")
        rows, right = np.arange(len(state)), truth["right"]
        lift, other = truth["lift"][rows, right], truth["lift"][rows, 1 - right]
        normal = truth["object_force"][..., 0]  # (B, O, F)
        pressing = normal[rows, right].min(axis=1) > TOUCHING
        at_height = pressing & (lift >= LIFTED * 0.98)
        after = np.empty_like(state)
        after["elapsed"] = elapsed = state["elapsed"] + dt
        after["held"] = held = np.where(at_height, state["held"] + dt, 0.0)
        after["lifted"] = lifted = state["lifted"] | at_height
        wrong = other >= WRONG
        crushed = (normal.max(axis=2) > truth["crushing_force"]).any(axis=1)
        dropped = lifted & ~pressing & (lift < LIFTED / 2)
        failed = wrong | crushed | dropped
        # In float steps of dt a rounding must not cost a control step.
        success = (held >= self.hold_seconds - dt / 2) & ~failed
        share = np.clip(lift / LIFTED, 0.0, 1.0)
        after["progress"] = progress = lift_progress(
            pressing, share, np.minimum(held / self.hold_seconds, 1.0), 0.0
        )
        ended = success | failed
        outcome = Outcome(
            reward=step_reward(state["progress"], progress, ended, failed, elapsed, self.seconds),
            success=success,
            terminated=ended,
            truncated=~ended & (elapsed >= self.seconds - dt / 2),
            reasons=dict(zip(self.reasons, (wrong, dropped, crushed), strict=True)),
            info={},
        )
        return after, outcome
