"""Scripted grasps: close, wait until both fingertips press, lift, hold. They use only what a real gripper reports.

B: environments.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermograsp.envs import action_of
from thermograsp.envs.limits import MAX_FORCE, MAX_LIFT_RATE
from thermograsp.envs.tasks import LIFTED
from thermograsp.errors import InvalidValueError, positive

_MARGIN = 0.002  # m that the arm rises beyond what the task asks, for an object that slips a little
_SETTLING = 0.3  # s that both fingertips must press before the arm rises
_APPROACH = 0.1  # s, time constant of the arm's last millimetres
_GENTLE, _FIRM = (
    9.5,
    30.0,
)  # N, one inside every window of STAKES' soft materials, the other inside every metal's
_METAL = (
    3.0e-3  # V, between .3 s of the slowest metal (steel, 5.1 mV) and of the quickest other (banana, 2.0 mV)
)


class ScriptedGrasp:
    """Policy of `num_envs` environments. force: N, the gripper's limit, one for all or (B,). dt: s, the control
    period.

    Raises InvalidValueError for a force that the gripper does not have."""

    _share = 0.5  # of that force, from which a fingertip presses

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
        pressing = np.all(observation["force"][:, :, 0] > self._share * self._force[:, None], axis=1)
        self._pressed = np.where(pressing, self._pressed + self._dt, 0.0)
        settled = self._pressed >= _SETTLING
        self._decide(observation, settled & ~self._lifting)
        self._lifting |= settled
        left = LIFTED + _MARGIN - observation["gripper"][:, 2].astype(float)
        rate = np.where(self._lifting, np.clip(left / _APPROACH, 0.0, MAX_LIFT_RATE), 0.0)
        closed = np.zeros(len(rate))
        return action_of(closed, self._force, rate).T.copy()

    def _decide(self, observation: dict[str, np.ndarray], rows: np.ndarray) -> None:
        """What is to be settled before rows (B,) bool are lifted: here nothing."""


class FeelingGrasp(ScriptedGrasp):
    """Closes gently on an object of STAKES, and lifts what feels like metal with more force."""

    _share = 0.2  # a heavy object that lies aside gives one fingertip a third, the table's friction the rest
    _gentle = _GENTLE

    def __init__(self, num_envs: int, dt: float) -> None:
        super().__init__(num_envs, dt, np.full(num_envs, _GENTLE))

    def restart(self, rows: Sequence[int] | np.ndarray) -> None:
        """The rows begin a new episode."""
        super().restart(rows)
        gentle = self._force.copy()
        gentle[rows] = _GENTLE
        self._force = gentle

    def _decide(self, observation: dict[str, np.ndarray], rows: np.ndarray) -> None:
        self._force = np.where(rows & self._heavy(observation), _FIRM, self._force)

    def _heavy(self, observation: dict[str, np.ndarray]) -> np.ndarray:
        """(B,) bool, which objects need the larger force: metals."""
        return observation["voltage"][:, :, -1].mean(axis=1) > _METAL
