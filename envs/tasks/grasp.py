"""Close, lift and hold: reward, success and the end of an episode, as pure functions of arrays.

B: environments.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import gymnasium
import numpy as np

from thermograsp.errors import InvalidValueError, positive
from thermograsp.plant import Command, Reading

from ..spaces import action_space, command_of
from .progress import PRESSED, lift_progress, step_reward
from .task import Outcome

GRASP_STATE = np.dtype(
    [
        ("elapsed", "f8"),
        ("held", "f8"),
        ("gripped", "f8"),
        ("progress", "f8"),
        ("lifted", "?"),
        ("pressed", "?"),
    ]
)
"""s; s at 5 cm without a break; m, how high the object was above the arm when both pads came to press; see progress.py;
has been at 5 cm; both pads pressed at the last step. What only slips need is 0 where the object may slip."""
LIFTED = 0.05  # m
TOUCHING = 0.2  # N on each pad that counts as holding


@dataclass(frozen=True, slots=True)
class GraspTask:
    """Close, lift the object by 5 cm, hold it for hold_seconds without dropping, crushing or scratching it. seconds:
    time limit. most_slip: m that the object may slide down along the pads while both press; inf for any. Raises
    InvalidValueError where one of them is not above 0.

    Reward: the change of progress. Progress is 0 unless both fingertips press; then it is .2, plus .3 times the height
    (as a share of 5 cm), plus .5 times the time for which it has been held there without a break (as a share of
    hold_seconds). Success adds 1, minus .1 times the share of `seconds` that it took. Dropping, crushing or slipping
    takes back all progress and subtracts 1. See progress.py.
    """

    reasons: ClassVar[tuple[str, ...]] = ("dropped", "crushed", "slipped")

    hold_seconds: float = 2.0
    seconds: float = 10.0
    most_slip: float = np.inf

    def __post_init__(self) -> None:
        for name in ("hold_seconds", "seconds", "most_slip"):
            if getattr(self, name) != np.inf:
                positive(name, getattr(self, name))

    def action_space(self) -> gymnasium.spaces.Box:
        """See actions.py."""
        return action_space()

    def command(self, action: np.ndarray) -> Command:
        """See actions.py."""
        return command_of(action)

    def fresh(self, num_envs: int) -> np.ndarray:
        """Before the first step."""
        return np.zeros(num_envs, GRASP_STATE)

    def judge(
        self, state: np.ndarray, dt: float, action: np.ndarray, reading: Reading
    ) -> tuple[np.ndarray, Outcome]:
        """After a control step of dt s. Where a plant's truth has no `lift`, the arm's height stands for how high the
        object is, and nothing slips; where it has no `crushing_force`, nothing breaks. Raises InvalidValueError where
        these are not one number for each environment."""
        del action
        height = reading.height
        lift = _known(reading, "lift", height)
        crushing = _known(reading, "crushing_force", np.inf)
        left, right = reading.force[:, 0, 0], reading.force[:, 1, 0]
        pressing = np.minimum(left, right) > TOUCHING
        at_height = pressing & (lift >= LIFTED * 0.98)
        elapsed, held = state["elapsed"] + dt, at_height * (state["held"] + dt)
        lifted = state["lifted"] | at_height
        share = np.minimum(np.maximum(lift / LIFTED, 0.0), 1.0)
        progress = lift_progress(pressing, share, np.minimum(held / self.hold_seconds, 1.0), PRESSED)
        after = self.fresh(len(state))
        after["elapsed"], after["held"], after["lifted"], after["progress"] = elapsed, held, lifted, progress
        crushed = np.maximum(left, right) > crushing
        dropped = lifted & ~pressing & (lift < LIFTED / 2)
        failed = crushed | dropped
        reasons = {"dropped": dropped, "crushed": crushed}
        if self.most_slip < np.inf:
            above = lift - height
            gripped = np.where(state["pressed"], state["gripped"], above)
            after["gripped"], after["pressed"] = gripped, pressing
            reasons["slipped"] = slipped = pressing & (gripped - above > self.most_slip)
            failed |= slipped
        # In float steps of dt a rounding must not cost a control step.
        ended = failed | (held >= self.hold_seconds - dt / 2)
        outcome = Outcome(
            reward=step_reward(state["progress"], progress, ended, failed, elapsed, self.seconds),
            success=ended & ~failed,
            terminated=ended,
            truncated=(elapsed >= self.seconds - dt / 2) & ~ended,
            reasons=reasons,
            info={},
        )
        return after, outcome


def _known(reading: Reading, name: str, otherwise: np.ndarray | float) -> np.ndarray | float:
    """(B,) of what the plant's truth tells by that name, or else what stands for it."""
    if name not in reading.truth:
        return otherwise
    values = np.asarray(reading.truth[name], float)
    if values.shape != reading.height.shape:
        raise InvalidValueError(
            f"the plant's truth has {name!r} of shape {values.shape}: this task needs one for each environment, "
            f"{reading.height.shape}"
        )
    return values
