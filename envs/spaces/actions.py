"""A gripper's action: target opening, force limit and lift rate, and on a lateral axis its rate, each scaled to
-1 .. 1.

B: environments.
"""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np

from thermograsp.errors import InvalidValueError, within
from thermograsp.plant import Command

from ..limits import MAX_FORCE, MAX_LATERAL_RATE, MAX_LIFT_RATE, MAX_OPENING

# Opening m, force limit N and lift rate m/s of an action a are (a + _MIDDLE) _HALF_RANGE, within _LOW .. _HIGH. These
# have the shape of one environment's action: NumPy takes a quicker way with equal shapes and types.
_MIDDLE = np.array([[1.0, 1.0, 0.0]])
_HALF_RANGE = np.array([[MAX_OPENING / 2, MAX_FORCE / 2, MAX_LIFT_RATE]])
_LOW, _HIGH = (_MIDDLE - 1.0) * _HALF_RANGE, (_MIDDLE + 1.0) * _HALF_RANGE


def action_space() -> gymnasium.spaces.Box:
    """Target opening 0 .. 85 mm, force limit 0 .. 40 N, lift rate -50 .. 50 mm/s, each scaled to -1 .. 1."""
    return gymnasium.spaces.Box(-1.0, 1.0, (3,), np.float32)


def command_of(action: np.ndarray) -> Command:
    """Commands of actions (B, 3), clipped to -1 .. 1. Raises InvalidValueError for what checked_action refuses."""
    array = checked_action(action, 3, "opening, force limit, lift rate", np.float32)  # as the space's
    array = array.astype(float)
    command = np.minimum(np.maximum((array + _MIDDLE) * _HALF_RANGE, _LOW), _HIGH)
    return Command(command[:, 0], command[:, 1], command[:, 2])


def checked_action(action: Any, numbers: int, parts: str, kind: type = float) -> np.ndarray:
    """Actions as an array (B, numbers) of that kind. Raises InvalidValueError, which names the parts of an action, for
    another shape, what is no number, and numbers that are not finite."""
    try:
        array = np.ascontiguousarray(action, kind)
    except (TypeError, ValueError):
        raise _not_an_action(numbers, parts, repr(np.asarray(action, object)[0])) from None
    if array.ndim != 2 or array.shape[1] != numbers:
        raise _not_an_action(numbers, parts, f"shape {np.shape(action)[1:]}")
    if np.count_nonzero(np.isfinite(array)) < array.size:
        row = int(np.argmin(np.isfinite(array).all(axis=1)))
        raise InvalidValueError(
            f"action {array[row]} of environment {row} is not finite: give numbers in -1 .. 1"
        )
    return array


def _not_an_action(numbers: int, parts: str, got: str) -> InvalidValueError:
    return InvalidValueError(f"an action is ({numbers},): {parts}, each -1 .. 1; got {got}")


def sliding_action_space() -> gymnasium.spaces.Box:
    """The same, and the lateral rate -100 .. 100 mm/s."""
    return gymnasium.spaces.Box(-1.0, 1.0, (4,), np.float32)


def sliding_command_of(action: np.ndarray) -> Command:
    """Commands of actions (B, 4), clipped to -1 .. 1. Raises InvalidValueError for what checked_action refuses."""
    array = checked_action(action, 4, "opening, force limit, lift rate, lateral rate")
    sideways = np.clip(array[:, 3], -1.0, 1.0)
    return command_of(array[:, :3])._replace(lateral_rate=sideways * MAX_LATERAL_RATE)


def sliding_action_of(
    opening: float, force_limit: float, lift_rate: float, lateral_rate: float
) -> np.ndarray:
    """The action (4,) of a command in m, N and m/s. Raises InvalidValueError for one that the gripper or its arm does
    not have."""
    within("lateral_rate", lateral_rate, -MAX_LATERAL_RATE, MAX_LATERAL_RATE, "m/s")
    return np.append(action_of(opening, force_limit, lift_rate), np.float32(lateral_rate / MAX_LATERAL_RATE))


def action_of(
    opening: float | np.ndarray, force_limit: float | np.ndarray, lift_rate: float | np.ndarray
) -> np.ndarray:
    """The action (3,) of a command in m, N and m/s, or (3, B) of arrays (B,). Raises InvalidValueError for one that the
    gripper does not have: an action beyond -1 .. 1 is clipped, and would do what nobody asked for."""
    within("opening", opening, 0.0, MAX_OPENING, "m")
    within("force_limit", force_limit, 0.0, MAX_FORCE, "N")
    within("lift_rate", lift_rate, -MAX_LIFT_RATE, MAX_LIFT_RATE, "m/s")
    scaled = (2 * opening / MAX_OPENING - 1, 2 * force_limit / MAX_FORCE - 1, lift_rate / MAX_LIFT_RATE)
    return np.array(scaled, np.float32)
