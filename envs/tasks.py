"""Tasks: reward, success and the end of an episode, from what happened in a control step. Pure functions of arrays.

B: environments.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba import njit

from thermograsp.errors import InvalidValueError

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


class TaskState(NamedTuple):
    """elapsed (B,) s. held (B,) s at 5 cm without a break. lifted (B,): has been at 5 cm."""

    elapsed: np.ndarray
    held: np.ndarray
    lifted: np.ndarray


class Outcome(NamedTuple):
    """All (B,): reward, success, terminated, truncated; dropped and crushed say why it ended."""

    reward: np.ndarray
    success: np.ndarray
    terminated: np.ndarray
    truncated: np.ndarray
    dropped: np.ndarray
    crushed: np.ndarray


def fresh(num_envs: int) -> TaskState:
    """Before the first step."""
    return TaskState(np.zeros(num_envs), np.zeros(num_envs), np.zeros(num_envs, bool))


def judge(
    task: GraspTask, state: TaskState, dt: float, force: np.ndarray, lift: np.ndarray, crushing: np.ndarray
) -> tuple[TaskState, Outcome]:
    """After a control step of dt s. force: (B, F, 3) N on the pads, normal first. lift: (B,) m, the object above where
    it lay; where a plant cannot know, the arm's height. crushing: (B,) N at which the object breaks."""
    numbers, flags = np.empty((3, len(lift))), np.empty((6, len(lift)), bool)
    _judge_rows(
        dt,
        task.hold_seconds,
        task.seconds,
        np.ascontiguousarray(force, dtype=float),
        np.ascontiguousarray(lift, dtype=float),
        np.ascontiguousarray(crushing, dtype=float),
        *state,
        numbers,
        flags,
    )
    elapsed, held, reward = numbers
    lifted, *ended = flags
    return TaskState(elapsed, held, lifted), Outcome(reward, *ended)


def cleared(outcome: Outcome, rows: np.ndarray) -> Outcome:
    """The outcome with the given rows (B,) bool as if nothing had happened in them."""
    others = ~rows
    return Outcome(
        reward=np.where(rows, 0.0, outcome.reward),
        success=outcome.success & others,
        terminated=outcome.terminated & others,
        truncated=outcome.truncated & others,
        dropped=outcome.dropped & others,
        crushed=outcome.crushed & others,
    )


def stopped(outcome: Outcome, rows: np.ndarray) -> Outcome:
    """The outcome with the given rows (B,) bool truncated for a reason that is no deed of the agent's."""
    outcome = cleared(outcome, rows)
    return outcome._replace(truncated=outcome.truncated | rows)


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
