"""Tasks: reward, success and the end of an episode, from what happened in a control step. Pure functions of arrays.

B: environments.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

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


@dataclass(frozen=True, slots=True)
class TaskState:
    """elapsed (B,) s. held (B,) s at 5 cm without a break. lifted (B,): has been at 5 cm."""

    elapsed: np.ndarray
    held: np.ndarray
    lifted: np.ndarray


@dataclass(frozen=True, slots=True)
class Outcome:
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
    task: GraspTask, state: TaskState, dt: float, normal: np.ndarray, lift: np.ndarray, crushing: np.ndarray
) -> tuple[TaskState, Outcome]:
    """After a control step of dt s. normal: (B, F) N on the pads. lift: (B,) m, the object above where it lay; where a
    plant cannot know, the arm's height. crushing: (B,) N at which the object breaks."""
    pressing = np.all(normal > _TOUCHING, axis=1)
    at_height = pressing & (lift >= LIFTED * 0.98)
    # In float steps of dt a rounding must not cost a control step.
    held = np.where(at_height, state.held + dt, 0.0)
    lifted = state.lifted | at_height
    elapsed = state.elapsed + dt
    success = held >= task.hold_seconds - dt / 2
    crushed = np.max(normal, axis=1) > crushing
    dropped = lifted & ~pressing & (lift < LIFTED / 2)
    failed = crushed | dropped
    success &= ~failed
    share = np.clip(lift / LIFTED, 0.0, 1.0) * pressing
    reward = dt * (0.2 * pressing + 0.3 * share + 0.5 * at_height) + 1.0 * success - 1.0 * failed
    truncated = ~(success | failed) & (elapsed >= task.seconds - dt / 2)
    return TaskState(elapsed, held, lifted), Outcome(
        reward, success, success | failed, truncated, dropped, crushed
    )
