"""Close, lift and hold: reward, success and the end of an episode, as pure functions of arrays.

B: environments.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import gymnasium
import numpy as np
from numba import njit

from thermograsp.errors import InvalidValueError
from thermograsp.plant import Command, Reading

from .actions import action_space, command_of
from .tasks import Outcome

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

    def fresh(self, num_envs: int) -> TaskState:
        """Before the first step."""
        flags = np.zeros((2, num_envs), bool)
        return TaskState(np.zeros(num_envs), np.zeros(num_envs), np.zeros(num_envs), *flags)

    def judge(
        self, state: TaskState, dt: float, action: np.ndarray, reading: Reading
    ) -> tuple[TaskState, Outcome]:
        """After a control step of dt s. Where a plant cannot know how high the object is and at which force it breaks,
        the arm's height stands for it, and nothing slips or breaks."""
        del action
        lift = reading.truth["lift"] if "lift" in reading.truth else reading.height
        numbers, flags = np.empty((4, len(lift))), np.empty((8, len(lift)), bool)
        crushing = reading.truth.get("crushing_force")
        if crushing is None:
            crushing = np.full(len(lift), np.inf)
        _judge_rows(
            dt,
            self.hold_seconds,
            self.seconds,
            self.most_slip,
            reading.force,
            lift,
            reading.height,
            crushing,
            *state,
            numbers,
            flags,
        )
        elapsed, held, gripped, reward = numbers
        lifted, pressed, success, terminated, truncated, dropped, crushed, slipped = flags
        reasons = {"dropped": dropped, "crushed": crushed, "slipped": slipped}
        after = TaskState(elapsed, held, gripped, lifted, pressed)
        return after, Outcome(reward, success, terminated, truncated, reasons, {})


class TaskState(NamedTuple):
    """elapsed (B,) s. held (B,) s at 5 cm without a break. gripped (B,) m, how high the object was above the arm when
    both pads came to press. lifted (B,): has been at 5 cm. pressed (B,): both pads pressed at the last step."""

    elapsed: np.ndarray
    held: np.ndarray
    gripped: np.ndarray
    lifted: np.ndarray
    pressed: np.ndarray


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
    elapsed,
    held,
    gripped,
    lifted,
    pressed,
    numbers,
    flags,
):
    """Fills numbers (elapsed, held, gripped, reward) and flags (lifted, pressed, success, terminated, truncated,
    dropped, crushed, slipped)."""
    for b in range(len(lift)):
        least, most = force[b, :, 0].min(), force[b, :, 0].max()
        pressing = least > TOUCHING
        at_height = pressing and lift[b] >= LIFTED * 0.98
        time, holding = elapsed[b] + dt, held[b] + dt if at_height else 0.0
        has_been = lifted[b] or at_height
        above = lift[b] - height[b]
        grip = gripped[b] if pressed[b] else above
        crushed = most > crushing[b]
        dropped = has_been and not pressing and lift[b] < LIFTED / 2
        slipped = pressing and grip - above > most_slip
        failed = crushed or dropped or slipped
        # In float steps of dt a rounding must not cost a control step.
        success = holding >= hold_seconds - dt / 2 and not failed
        reward = (1.0 if success else 0.0) - (1.0 if failed else 0.0)
        if pressing:
            share = min(max(lift[b] / LIFTED, 0.0), 1.0)
            reward += dt * (0.2 + 0.3 * share + (0.5 if at_height else 0.0))
        numbers[0, b], numbers[1, b], numbers[2, b], numbers[3, b] = time, holding, grip, reward
        flags[0, b], flags[1, b], flags[2, b], flags[3, b] = has_been, pressing, success, success or failed
        flags[4, b] = not (success or failed) and time >= seconds - dt / 2
        flags[5, b], flags[6, b], flags[7, b] = dropped, crushed, slipped
