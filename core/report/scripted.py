"""The scripted grasp: close, wait until both fingertips press, lift, hold. It uses only what a real gripper reports."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermograsp.envs import action_of
from thermograsp.envs.mechanics import MAX_FORCE, MAX_LIFT_RATE
from thermograsp.envs.grasp_task import LIFTED
from thermograsp.errors import InvalidValueError, positive

_MARGIN = 0.002  # m that the arm rises beyond what the task asks, for an object that slips a little
_SETTLING = 0.3  # s that both fingertips must press before the arm rises
_APPROACH = 0.1  # s, time constant of the arm's last millimetres


class ScriptedGrasp:
    """Policy of `num_envs` environments. force: N, the gripper's limit, one for all or (B,). dt: s, the control
    period.

    Raises InvalidValueError for a force that the gripper does not have."""

    def __init__(self, num_envs: int, dt: float, force: float | np.ndarray = 10.0) -> None:
        for one in np.atleast_1d(force).tolist():
            if positive("force (N)", one) > MAX_FORCE:
                raise InvalidValueError(
                    f"force (N) must be at most {MAX_FORCE:g}, the gripper's limit, got {one!r}"
                )
        self._force, self._dt = np.broadcast_to(np.asarray(force, float), num_envs), dt
        self._pressed = np.zeros(num_envs)  # s without a break
        self._lifting = np.zeros(num_envs, bool)

    def restart(self, rows: Sequence[int] | np.ndarray) -> None:
        """The rows begin a new episode."""
        self._pressed[rows] = 0.0
        self._lifting[rows] = False

    def action(self, observation: dict[str, np.ndarray]) -> np.ndarray:
        """Actions (B, 3) float32 for observations (B, ...)."""
        pressing = np.all(observation["force"][:, :, 0] > self._force[:, None] / 2, axis=1)
        self._pressed = np.where(pressing, self._pressed + self._dt, 0.0)
        self._lifting |= self._pressed >= _SETTLING
        left = LIFTED + _MARGIN - observation["gripper"][:, 2].astype(float)
        rate = np.where(self._lifting, np.clip(left / _APPROACH, 0.0, MAX_LIFT_RATE), 0.0)
        closed = np.zeros(len(rate))
        return action_of(closed, self._force, rate).T.copy()  # pyright: ignore[reportArgumentType]
