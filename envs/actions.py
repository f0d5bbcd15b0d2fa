"""A gripper's action: target opening, force limit and lift rate, and on a lateral axis its rate, each scaled to
-1 .. 1.

B: environments.
"""

from __future__ import annotations

import gymnasium
import numpy as np
from numba import njit

from thermograsp.errors import InvalidValueError
from thermograsp.plant import Command

from .mechanics import MAX_FORCE, MAX_LIFT_RATE
from .scene import MAX_LATERAL_RATE, MAX_OPENING


def action_space() -> gymnasium.spaces.Box:
    """Target opening 0 .. 85 mm, force limit 0 .. 40 N, lift rate -50 .. 50 mm/s, each scaled to -1 .. 1."""
    return gymnasium.spaces.Box(-1.0, 1.0, (3,), np.float32)


def command_of(action: np.ndarray) -> Command:
    """Commands of actions (B, 3), clipped to -1 .. 1. Raises InvalidValueError for a wrong shape or a value that is not
    finite."""
    array = np.ascontiguousarray(action, np.float32)  # as the space's
    if array.ndim != 2 or array.shape[1] != 3:
        raise InvalidValueError(
            f"an action is (3,): opening, force limit, lift rate, each -1 .. 1; got shape {np.shape(action)[1:]}"
        )
    command = Command(np.empty(len(array)), np.empty(len(array)), np.empty(len(array)))
    row = _scale(array, command.opening, command.force_limit, command.lift_rate)
    if row >= 0:
        raise InvalidValueError(
            f"action {array[row]} of environment {row} is not finite: give numbers in -1 .. 1"
        )
    return command


@njit(cache=True, error_model="numpy")
def _scale(action, opening, force_limit, lift_rate):
    """Fills the commands; returns the first row that is not finite, -1 where all are."""
    for b in range(len(action)):
        for i in range(3):
            if not np.isfinite(action[b, i]):
                return b
        opening[b] = (min(max(action[b, 0], -1.0), 1.0) + 1) / 2 * MAX_OPENING
        force_limit[b] = (min(max(action[b, 1], -1.0), 1.0) + 1) / 2 * MAX_FORCE
        lift_rate[b] = min(max(action[b, 2], -1.0), 1.0) * MAX_LIFT_RATE
    return -1


def sliding_action_space() -> gymnasium.spaces.Box:
    """The same, and the lateral rate -100 .. 100 mm/s."""
    return gymnasium.spaces.Box(-1.0, 1.0, (4,), np.float32)


def sliding_command_of(action: np.ndarray) -> Command:
    """Commands of actions (B, 4), clipped to -1 .. 1. Raises InvalidValueError for a wrong shape or a value that is not
    finite."""
    array = np.asarray(action, dtype=float)
    if array.ndim != 2 or array.shape[1] != 4:
        raise InvalidValueError(
            "an action is (4,): opening, force limit, lift rate, lateral rate, each -1 .. 1; got shape "
            f"{np.shape(action)[1:]}"
        )
    sideways = array[:, 3]
    if not np.isfinite(sideways).all():
        row = int(np.argmin(np.isfinite(sideways)))
        raise InvalidValueError(
            f"action {array[row]} of environment {row} is not finite: give numbers in -1 .. 1"
        )
    return command_of(array[:, :3])._replace(lateral_rate=np.clip(sideways, -1.0, 1.0) * MAX_LATERAL_RATE)


def sliding_action_of(
    opening: float, force_limit: float, lift_rate: float, lateral_rate: float
) -> np.ndarray:
    """The action (4,) of a command in m, N and m/s."""
    return np.append(action_of(opening, force_limit, lift_rate), np.float32(lateral_rate / MAX_LATERAL_RATE))


def action_of(opening: float, force_limit: float, lift_rate: float) -> np.ndarray:
    """The action (3,) of a command in m, N and m/s."""
    scaled = (2 * opening / MAX_OPENING - 1, 2 * force_limit / MAX_FORCE - 1, lift_rate / MAX_LIFT_RATE)
    return np.array(scaled, np.float32)
