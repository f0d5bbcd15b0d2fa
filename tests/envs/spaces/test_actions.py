"""Commands in SI units and the actions that stand for them."""

from typing import Any

import numpy as np
import pytest

from thermograsp.envs import action_of, sliding_action_of
from thermograsp.envs.spaces import command_of
from thermograsp.errors import InvalidValueError


@pytest.mark.parametrize("given", [(0.0, 0.0, -0.05), (0.085, 40.0, 0.05), (0.03, 12.0, 0.01)])
def test_an_action_is_the_command_that_it_was_made_of(given: tuple[float, float, float]) -> None:
    command = command_of(action_of(*given)[None])
    became = [float(values[0]) for values in (command.opening, command.force_limit, command.lift_rate)]
    assert became == pytest.approx(given, abs=1e-6)


def test_actions_of_many_environments() -> None:
    opening, force = np.array([0.0, 0.085]), np.array([5.0, 40.0])
    actions = action_of(opening, force, np.zeros(2)).T
    assert np.array_equal(actions, [action_of(0.0, 5.0, 0.0), action_of(0.085, 40.0, 0.0)])


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ((40.0, 10.0, 0.0), r"opening 40 m: give 0 to 0\.085 m; 40 looks like millimetres: give 0.04"),
        ((-0.001, 10.0, 0.0), "opening -0.001 m: give 0 to 0.085 m$"),
        ((0.09, 10.0, 0.0), "opening 0.09 m: give 0 to 0.085 m$"),
        ((0.0, 41.0, 0.0), "force_limit 41 N: give 0 to 40 N$"),
        ((0.0, 10.0, 20.0), r"lift_rate 20 m/s: .* 20 looks like mm/s: give 0.02"),
        ((float("nan"), 10.0, 0.0), "opening nan m"),
    ],
)
def test_a_command_that_the_gripper_does_not_have_is_refused(
    given: tuple[float, float, float], said: str
) -> None:
    """An action beyond -1 .. 1 would be clipped in silence: 40 m would open the gripper."""
    with pytest.raises(InvalidValueError, match=said):
        action_of(*given)
    with pytest.raises(InvalidValueError, match=said):
        sliding_action_of(*given, 0.0)
    with pytest.raises(InvalidValueError, match=said):
        action_of(*(np.array([0.01, value]) for value in given))


def test_a_lateral_rate_that_the_arm_does_not_have_is_refused() -> None:
    with pytest.raises(InvalidValueError, match="lateral_rate 0.2 m/s: give -0.1 to 0.1 m/s"):
        sliding_action_of(0.0, 10.0, 0.0, 0.2)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["close"], r"an action is \(3,\): opening, force limit, lift rate, each -1 .. 1; got 'close'"),
        ([None], r"an action is \(3,\)"),
        (np.zeros((1, 2)), r"got shape \(2,\)"),
        ([[0.0, np.nan, 0.0]], "environment 0 is not finite"),
    ],
)
def test_what_is_no_action_is_refused(given: Any, said: str) -> None:
    with pytest.raises(InvalidValueError, match=said):
        command_of(given)
