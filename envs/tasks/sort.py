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
        """After a control step of dt s. Where a plant's truth has no `object_force`, the object that the arm is over
        (0 at lateral places below 0) is what the pads press, and the arm's height stands for how high it is while both
        press it; nothing breaks. Where nobody told which is `right`, reward is 0 and success never comes. Raises
        InvalidValueError for a plant without a lateral axis."""
        del action
        heights, normal, crushing = _objects(reading)
        rows = np.arange(len(state))
        known = np.full(len(state), "right" in reading.truth)
        right = np.asarray(reading.truth.get("right", np.zeros(len(state), int)))
        lift, other = heights[rows, right], heights[rows, 1 - right]
        pressing = known & (normal[rows, right].min(axis=1) > TOUCHING)
        at_height = pressing & (lift >= LIFTED * 0.98)
        elapsed, held = state["elapsed"] + dt, at_height * (state["held"] + dt)
        lifted = state["lifted"] | at_height
        share = np.minimum(np.maximum(lift / LIFTED, 0.0), 1.0)
        progress = lift_progress(pressing, share, np.minimum(held / self.hold_seconds, 1.0), 0.0)
        after = self.fresh(len(state))
        after["elapsed"], after["held"], after["lifted"], after["progress"] = elapsed, held, lifted, progress
        wrong = known & (other >= WRONG)
        crushed = (normal.max(axis=2) > crushing).any(axis=1)
        dropped = lifted & ~pressing & (lift < LIFTED / 2)
        failed = wrong | crushed | dropped
        # In float steps of dt a rounding must not cost a control step.
        ended = failed | (held >= self.hold_seconds - dt / 2)
        outcome = Outcome(
            reward=step_reward(state["progress"], progress, ended, failed, elapsed, self.seconds),
            success=ended & ~failed,
            terminated=ended,
            truncated=(elapsed >= self.seconds - dt / 2) & ~ended,
            reasons=dict(zip(self.reasons, (wrong, dropped, crushed), strict=True)),
            info={},
        )
        return after, outcome


def _objects(reading: Reading) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of both objects: heights (B, O) m, normal forces (B, O, F) N on them, and those that crush them (B, O) N."""
    truth = reading.truth
    if "object_force" in truth:
        return truth["lift"], truth["object_force"][..., 0], truth["crushing_force"]
    if reading.lateral is None:
        raise InvalidValueError(
            "this plant has no lateral axis and does not know two objects: sorting needs one"
        )
    rows, over = np.arange(len(reading.height)), (reading.lateral >= 0).astype(int)
    heights, normal = np.zeros((len(rows), 2)), np.zeros((len(rows), 2, reading.force.shape[1]))
    normal[rows, over] = reading.force[..., 0]
    heights[rows, over] = np.where(normal[rows, over].min(axis=1) > TOUCHING, reading.height, 0.0)
    return heights, normal, np.full(heights.shape, np.inf)
