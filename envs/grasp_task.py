"""Close, lift and hold: reward, success and the end of an episode, as pure functions of arrays.

B: environments.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import gymnasium
import numpy as np
from numba import njit

from thermograsp.errors import InvalidValueError
from thermograsp.plant import Command, Reading

from .actions import action_space, command_of
from .tasks import Outcome
from .truth import Truth

GRASP_STATE = np.dtype(
    [("elapsed", "f8"), ("held", "f8"), ("gripped", "f8"), ("lifted", "?"), ("pressed", "?")]
)
"""s; s at 5 cm without a break; m, how high the object was above the arm when both pads came to press; has been at
5 cm; both pads pressed at the last step."""
LIFTED = 0.05  # m
TOUCHING = 0.2  # N on each pad that counts as holding


@dataclass(frozen=True, slots=True)
class GraspTask:
    """Close, lift the object by 5 cm, hold it for hold_seconds without dropping, crushing or scratching it. seconds:
    time limit. most_slip: m that the object may slide down along the pads while both press; inf for any. Raises
    InvalidValueError where one of them is not above 0.

    Reward per second: .2 while both fingertips press, .3 times the height reached (as a share of 5 cm), .5 while it is
    held there; 1 once on success, -1 on dropping, crushing or slipping.
    """

    reasons: ClassVar[tuple[str, ...]] = ("dropped", "crushed", "slipped")

    hold_seconds: float = 2.0
    seconds: float = 10.0
    most_slip: float = np.inf

    def __post_init__(self) -> None:
        for name in ("hold_seconds", "seconds", "most_slip"):
            if not getattr(self, name) > 0:
                raise InvalidValueError(f"{name} must be above 0, got {getattr(self, name)!r}")

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
        """After a control step of dt s. Where a plant cannot know how high the object is and at which force it breaks,
        the arm's height stands for it, and nothing slips or breaks."""
        del action
        truth, rows = reading.truth, len(state)
        if isinstance(truth, Truth):
            lift, crushing = truth.lift, truth.episodes.crushing_force
        else:
            lift, crushing = reading.height, np.full(rows, np.inf)
        after, reward, flags = np.empty(rows, GRASP_STATE), np.empty(rows), np.empty((6, rows), bool)
        failed = _judge_rows(
            dt,
            self.hold_seconds,
            self.seconds,
            self.most_slip,
            reading.force,
            lift,
            reading.height,
            crushing,
            state,
            after,
            reward,
            flags,
        )
        reasons = dict(zip(self.reasons, flags[3:], strict=True)) if failed else {}
        return after, Outcome(reward, flags[0], flags[1], flags[2], reasons, {})


@njit(cache=True, error_model="numpy")
def _judge_rows(
    dt,
    hold_seconds,
    seconds,
    most_slip,
    force,
    lift,
    height,
    crushing,
    before,
    after,
    rewards,
    flags,
):
    """Fills after (B,) GRASP_STATE, rewards (B,) and flags (success, terminated, truncated, and the reasons). Returns
    whether any has failed."""
    any_failed = False
    for b in range(len(lift)):
        least, most = force[b, :, 0].min(), force[b, :, 0].max()
        pressing = least > TOUCHING
        at_height = pressing and lift[b] >= LIFTED * 0.98
        time, holding = before[b].elapsed + dt, before[b].held + dt if at_height else 0.0
        has_been = before[b].lifted or at_height
        above = lift[b] - height[b]
        grip = before[b].gripped if before[b].pressed else above
        crushed = most > crushing[b]
        dropped = has_been and not pressing and lift[b] < LIFTED / 2
        slipped = pressing and grip - above > most_slip
        failed = crushed or dropped or slipped
        any_failed |= failed
        # In float steps of dt a rounding must not cost a control step.
        success = holding >= hold_seconds - dt / 2 and not failed
        reward = (1.0 if success else 0.0) - (1.0 if failed else 0.0)
        if pressing:
            share = min(max(lift[b] / LIFTED, 0.0), 1.0)
            reward += dt * (0.2 + 0.3 * share + (0.5 if at_height else 0.0))
        after[b].elapsed, after[b].held, after[b].gripped = time, holding, grip
        after[b].lifted, after[b].pressed = has_been, pressing
        rewards[b] = reward
        flags[0, b], flags[1, b] = success, success or failed
        flags[2, b] = not (success or failed) and time >= seconds - dt / 2
        flags[3, b], flags[4, b], flags[5, b] = dropped, crushed, slipped
    return any_failed
