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
_TOUCHING = 0.2  # N on each pad that counts as holding


@dataclass(frozen=True, slots=True)
class GraspTask:
    """Close, lift the object by 5 cm, hold it for hold_seconds without dropping or crushing it. seconds: time limit.
    Raises InvalidValueError where one of them is not above 0.

    Reward per second: .2 while both fingertips press, .3 times the height reached (as a share of 5 cm), .5 while it is
    held there; 1 once on success, -1 on dropping or crushing.
    """

    hold_seconds: float = 2.0
    seconds: float = 10.0

    def __post_init__(self) -> None:
        for name in ("hold_seconds", "seconds"):
            if not getattr(self, name) > 0:
                raise InvalidValueError(f"{name} must be above 0 s, got {getattr(self, name)!r}")

    def action_space(self) -> gymnasium.spaces.Box:
        """See actions.py."""
        return action_space()

    def command(self, action: np.ndarray) -> Command:
        """See actions.py."""
        return command_of(action)

    def fresh(self, num_envs: int) -> TaskState:
        """Before the first step."""
        return TaskState(np.zeros(num_envs), np.zeros(num_envs), np.zeros(num_envs, bool))

    def judge(
        self, state: TaskState, dt: float, action: np.ndarray, reading: Reading
    ) -> tuple[TaskState, Outcome]:
        """After a control step of dt s. Where a plant cannot know how high the object is and at which force it breaks,
        the arm's height stands for it, and nothing breaks."""
        del action
        lift = reading.truth["lift"] if "lift" in reading.truth else reading.height
        numbers, flags = np.empty((3, len(lift))), np.empty((6, len(lift)), bool)
        crushing = reading.truth.get("crushing_force")
        if crushing is None:
            crushing = np.full(len(lift), np.inf)
        _judge_rows(
            dt,
            self.hold_seconds,
            self.seconds,
            np.ascontiguousarray(reading.force, dtype=float),
            np.ascontiguousarray(lift, dtype=float),
            np.ascontiguousarray(crushing, dtype=float),
            *state,
            numbers,
            flags,
        )
        elapsed, held, reward = numbers
        lifted, success, terminated, truncated, dropped, crushed = flags
        reasons = {"dropped": dropped, "crushed": crushed}
        return TaskState(elapsed, held, lifted), Outcome(reward, success, terminated, truncated, reasons, {})


class TaskState(NamedTuple):
    """elapsed (B,) s. held (B,) s at 5 cm without a break. lifted (B,): has been at 5 cm."""

    elapsed: np.ndarray
    held: np.ndarray
    lifted: np.ndarray


@njit(cache=True, error_model="numpy")
def _judge_rows(dt, hold_seconds, seconds, force, lift, crushing, elapsed, held, lifted, numbers, flags):
    """Fills numbers (elapsed, held, reward) and flags (lifted, success, terminated, truncated, dropped, crushed)."""
    for b in range(len(lift)):
        least, most = force[b, :, 0].min(), force[b, :, 0].max()
        pressing = least > _TOUCHING
        at_height = pressing and lift[b] >= LIFTED * 0.98
        time, holding = elapsed[b] + dt, held[b] + dt if at_height else 0.0
        has_been = lifted[b] or at_height
        crushed = most > crushing[b]
        dropped = has_been and not pressing and lift[b] < LIFTED / 2
        failed = crushed or dropped
        # In float steps of dt a rounding must not cost a control step.
        success = holding >= hold_seconds - dt / 2 and not failed
        reward = (1.0 if success else 0.0) - (1.0 if failed else 0.0)
        if pressing:
            share = min(max(lift[b] / LIFTED, 0.0), 1.0)
            reward += dt * (0.2 + 0.3 * share + (0.5 if at_height else 0.0))
        numbers[0, b], numbers[1, b], numbers[2, b] = time, holding, reward
        flags[0, b], flags[1, b], flags[2, b] = has_been, success, success or failed
        flags[3, b] = not (success or failed) and time >= seconds - dt / 2
        flags[4, b], flags[5, b] = dropped, crushed
