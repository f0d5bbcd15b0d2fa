"""Counts and SI units of the 2F-85, and its registers as the manual's examples have them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thermograsp.errors import InvalidValueError
from thermograsp.hardware import RobotiqUnits
from thermograsp.hardware.drivers.robotiq_registers import (
    Action,
    ObjectSeen,
    State,
    action,
    fault_text,
    state,
)

UNITS = RobotiqUnits()
COUNTS = np.arange(256)


def test_positions_come_back() -> None:
    """Every position between the ends is its own opening's; the ends are commanded beyond themselves."""
    inside = COUNTS[UNITS.open_count + 1 : UNITS.closed_count]
    np.testing.assert_array_equal(UNITS.position_counts(UNITS.opening(inside)), inside)
    np.testing.assert_array_equal(UNITS.position_counts([0.0, UNITS.stroke]), [255, 0])
    np.testing.assert_array_equal(UNITS.opening([0, 3, 230, 255]), [0.085, 0.085, 0, 0])


def test_speeds_and_forces_come_back() -> None:
    np.testing.assert_array_equal(UNITS.speed_counts(UNITS.speed(COUNTS)), COUNTS)
    np.testing.assert_array_equal(UNITS.force_counts(UNITS.force(COUNTS)), COUNTS)
    np.testing.assert_allclose(UNITS.speed([0, 255]), [0.02, 0.15])
    np.testing.assert_allclose(UNITS.force([0, 255]), [20.0, 235.0])


@given(
    st.lists(st.tuples(st.floats(0, 0.085), st.floats(0, 235), st.floats(0, 0.15)), min_size=1, max_size=20)
)
def test_what_a_command_becomes(commands: list[tuple[float, float, float]]) -> None:
    """Within half a step of it, a force never above it but for the weakest; again quantised it stays; a row alone is
    the same as among others."""
    opening, force, speed = np.array(commands).T
    became = UNITS.quantised(opening, force, speed)
    assert (abs(became[0] - opening) <= 0.5 * 0.085 / 227 + 1e-12).all()
    assert (became[1] <= np.maximum(force, 20.0) + 1e-6).all()
    assert (became[1] > np.maximum(force, 20.0) - 215 / 255 - 1e-9).all()
    assert (abs(became[2] - np.maximum(speed, 0.02)) <= 0.5 * 0.13 / 255 + 1e-12).all()
    for once, again in zip(became, UNITS.quantised(*became), strict=True):
        np.testing.assert_array_equal(once, again)
    for row, single in enumerate(commands):
        assert [values[row] for values in became] == [float(value) for value in UNITS.quantised(*single)]


@pytest.mark.parametrize(
    ("name", "bad"),
    [("position_counts", -1e-6), ("position_counts", 0.0851), ("position_counts", np.nan)]
    + [("force_counts", -1.0), ("force_counts", 236.0), ("speed_counts", 0.151), ("speed_counts", -0.01)]
    + [("opening", 256), ("speed", -1), ("force", 300)],
)
def test_what_it_cannot_do_is_refused(name: str, bad: float) -> None:
    with pytest.raises(InvalidValueError, match="give "):
        getattr(UNITS, name)([0.01, bad])


@pytest.mark.parametrize(
    "bad",
    [{"stroke": 0.0}, {"open_count": 240}, {"closed_count": 256}, {"slowest": 0.2}, {"weakest": 0.0}]
    + [{"stroke": 85.0}],  # in mm
)
def test_a_gripper_that_cannot_be(bad: dict) -> None:
    with pytest.raises(InvalidValueError):
        RobotiqUnits(**bad)


@pytest.mark.parametrize(
    ("command", "registers"),
    [
        (Action(activate=True), [0x0100, 0, 0]),
        (Action(activate=True, go=True, position=255, speed=255, force=255), [0x0900, 0x00FF, 0xFFFF]),
        (Action(activate=True, release=True, release_opens=True), [0x3100, 0, 0]),
    ],
)
def test_commands_as_in_the_manual(command: Action, registers: list[int]) -> None:
    assert command.registers() == registers
    assert action(registers) == command


@pytest.mark.parametrize(
    ("registers", "said"),
    [
        ([0x1100, 0, 0], State(True, False, 1, ObjectSeen.MOVING, 0, 0, 0, 0)),
        ([0x3100, 0, 0], State(True, False, 3, ObjectSeen.MOVING, 0, 0, 0, 0)),
        ([0xB900, 0x00FF, 0xBD00], State(True, True, 3, ObjectSeen.WHILE_CLOSING, 0, 255, 0xBD, 0)),
        ([0xF900, 0x0000, 0x0D00], State(True, True, 3, ObjectSeen.AT_POSITION, 0, 0, 0x0D, 0)),
        ([0x7900, 0x2EFF, 0x0D64], State(True, True, 3, ObjectSeen.WHILE_OPENING, 14, 255, 13, 100, 2)),
    ],
)
def test_states_as_in_the_manual(registers: list[int], said: State) -> None:
    assert state(registers) == said
    assert said.registers() == registers


@given(st.lists(st.integers(0, 65535), min_size=3, max_size=3))
def test_any_registers_are_read(registers: list[int]) -> None:
    kept = [registers[0] & 0xF900, registers[1], registers[2]]
    assert state(registers).registers() == kept
    action(registers)


@pytest.mark.parametrize("fault", range(16))
def test_every_fault_has_a_cause_and_a_cure(fault: int) -> None:
    text = fault_text(fault)
    assert (text == "") == (fault == 0)
    assert fault == 0 or (f"gFLT {fault:#x}" in text and ("call" in text or ";" in text))
