"""A serial plant whose arm moves along the table, between two objects: in virtual time, and what is asked of it."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

from thermograsp.envs import SortEnv, sliding_action_of
from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.hardware import SerialPlant
from thermograsp.hardware.errors import DeviceError
from thermograsp.hardware.plant import serial
from thermograsp.plant import Command

from .hand import WIDTH, Hand, fresh, in_step, on_ports
from .serving import nothing_left
from .test_lift import BREAKS, Arm, failing

RATE = 0.1  # m/s
URL = "serial:///dev/tips?gripper=robotiq:///dev/gripper"


def sliding(
    hand: Hand, goals: tuple[str, ...] = (), height: float = 0.0, **lateral: float
) -> tuple[SerialPlant, Arm, Arm]:
    """The plant, its lift and its lateral axis."""
    plain, line = in_step(hand)
    lift, along = Arm(lambda: line.now, height=height), Arm(lambda: line.now, **lateral)
    plant = SerialPlant(
        plain._tips, plain._gripper, plain.config, plain._pace, lift=lift, lateral=along, goals=goals
    )
    return plant, lift, along


def command(along: float, up: float = 0.0, opening: float = 0.0) -> Command:
    return Command(np.array([opening]), np.array([30.0]), np.array([up]), np.array([along]))


def holding(hand: Hand) -> tuple[SerialPlant, Arm, Arm]:
    """Something is held above object 0's place, and the arm still moves both ways."""
    plant, lift, along = sliding(hand)
    fresh(plant)
    for _ in range(60):
        assert plant.step(command(0.0)).error == ("",)
    for _ in range(20):
        assert plant.step(command(-RATE, 0.05)).error == ("",)
    assert hand.fingers.opening < WIDTH and (lift.rate, along.rate) == (0.05, -RATE)
    return plant, lift, along


def test_it_goes_both_ways_as_it_is_told_and_tells_its_place() -> None:
    plant, _, along = sliding(Hand())
    first = fresh(plant)
    assert first.lateral is not None and first.lateral[0] == 0.0
    places = [float(plant.step(command(rate)).lateral[0]) for rate in [RATE] * 20 + [-RATE] * 40]  # pyright: ignore[reportOptionalSubscript]
    np.testing.assert_allclose(np.diff(places[:20]), RATE * plant.dt, atol=1e-9)
    assert max(places) == pytest.approx(0.04, abs=0.002) and places[-1] == pytest.approx(-0.04, abs=0.002)
    last = plant.step(command(0.0))
    assert last.lateral == pytest.approx(along.height, abs=1e-9) and along.rate == 0.0
    assert not {"lateral", "height"} & set(last.truth["unknown"][0])
    plant.step(command(RATE))
    plant.step(command(0.0)._replace(lateral_rate=None))  # of a task that knows no such axis
    assert along.rate == 0.0


@pytest.mark.parametrize(("travel", "end"), [(0.03, 0.03), (1.0, 0.06)])
def test_it_stops_at_both_ends_of_its_travel(travel: float, end: float) -> None:
    plant, _, along = sliding(Hand(), travel=travel)
    fresh(plant)
    places = []
    for rate in (RATE, -RATE):
        for _ in range(100):
            plant.step(command(rate))
            places.append(along.height)
    slack = 0.009 * RATE  # the place is asked for before the step's end
    assert max(places) == pytest.approx(end, abs=slack) and min(places) == pytest.approx(-end, abs=slack)


def test_without_an_axis_no_place_is_told() -> None:
    plain, _ = in_step(Hand())
    plant, _, _ = sliding(Hand())
    reading = fresh(plain)
    assert reading.lateral is None and "lateral" in reading.truth["unknown"][0]
    assert plain.quantised(command(RATE)).lateral_rate is None
    assert plant.quantised(command(RATE)).lateral_rate == RATE


@pytest.mark.parametrize(
    ("along", "up", "said"), [(0.2, 0.0, "lateral_rate 0.2 m/s"), (0.0, 0.06, "lift_rate 0.06 m/s")]
)
def test_a_rate_that_no_command_may_ask_for_lets_go_and_is_raised(along: float, up: float, said: str) -> None:
    plant, _, _ = holding(Hand())
    with pytest.raises(InvalidValueError, match=said):
        plant.step(command(along, up))
    assert "let go" in plant.step(command(0.0)).error[0]


def test_a_reset_stops_it_lowers_it_opens_and_only_then_goes_to_the_middle() -> None:
    """What is held is put down where it is; a held object is not dragged along the table."""
    hand = Hand()
    plant, lift, along = holding(hand)
    moved: list[tuple[str, float, float, float]] = []
    for name, axis in (("lift", lift), ("lateral", along)):

        def turn(rate: float, name: str = name, turn: Callable[[float], None] = axis._turn) -> None:
            moved.append((name, rate, lift.height, hand.fingers.opening))
            turn(rate)

        axis._turn = turn  # pyright: ignore[reportAttributeAccessIssue]
    place = along.height
    assert place < -0.03 and lift.height > 0.015
    reading = fresh(plant)
    assert reading.lateral == pytest.approx(0.0, abs=5e-4) and reading.height[0] < 5e-4
    assert {name: rate for name, rate, *_ in moved[:2]} == {"lift": 0.0, "lateral": 0.0}
    sideways = [each for each in moved if each[0] == "lateral" and each[1]]
    assert sideways and all(height < 5e-4 and opening > 0.08 for *_, height, opening in sideways)
    assert max(abs(rate) for _, rate, *_ in sideways) <= RATE


def test_an_axis_that_does_not_come_to_its_middle_ends_the_reset() -> None:
    plant, _, along = sliding(Hand())
    along._height, along._turn = 0.05, lambda rate: None  # pyright: ignore[reportAttributeAccessIssue]
    with pytest.raises(DeviceError, match="in vain for the lateral axis to come to its middle"):
        fresh(plant)


@pytest.mark.parametrize("what", BREAKS)
def test_what_breaks_stops_both_axes_and_opens_the_fingers(what: str) -> None:
    hand = Hand()
    plant, lift, along = holding(hand)
    BREAKS[what](hand, along)
    errors = [plant.step(command(-RATE, 0.05)).error[0] for _ in range(20)]
    assert errors[-1] and lift.rate == along.rate == 0.0
    plant._pace.until(plant._pace.now() + 1.0)
    assert hand.fingers.opening == pytest.approx(0.085, abs=1e-3)


@pytest.mark.parametrize("which", [0, 1])
def test_a_stop_reaches_the_other_axis_and_the_gripper_where_one_raises(which: int) -> None:
    hand = Hand()
    plant, *axes = holding(hand)
    axes[which].at["stop"] = failing(OSError("the bus is busy"))
    with pytest.raises(OSError, match="busy"):
        plant.stop()
    assert axes[0].rate == axes[1].rate == 0.0
    assert "stopped where they are" in plant.step(command(-RATE)).error[0]
    assert hand.fingers.opening < WIDTH
    plant.close()
    assert [axis.closed for axis in axes] == [1, 1]


def test_one_axis_cannot_be_both() -> None:
    plain, _ = in_step(Hand())
    axis = Arm(lambda: 0.0)
    with pytest.raises(InvalidValueError, match="lift and lateral are the same axis"):
        SerialPlant(plain._tips, plain._gripper, lift=axis, lateral=axis)


def test_what_is_asked_comes_from_whoever_laid_the_objects_there() -> None:
    def asked(plant: SerialPlant, **options: Any) -> dict[str, Any]:
        return dict(plant.reset([0], [np.random.default_rng(0)], options).truth)

    plant, _, _ = sliding(Hand(), goals=("glass", "copper"))
    truth = asked(plant, asked="copper")
    assert truth["goal"].tolist() == [[0.0, 1.0]] and truth["asked"] == ["copper"] and "right" not in truth
    assert asked(plant, asked="glass", right=1)["right"] == [1]
    assert "right" not in asked(plant, asked="glass")  # of this episode nobody said it
    assert asked(sliding(Hand(), goals=("the hotter one",))[0])["goal"].tolist() == [[1.0]]
    refused: list[tuple[dict[str, Any], type[Exception], str]] = [
        ({}, InvalidValueError, "'asked': NAME}.*one of glass, copper"),
        ({"asked": "coper"}, UnknownNameError, "did you mean 'copper'"),
        ({"asked": "glass", "right": 2}, InvalidValueError, "right must be 0.*got 2"),
        ({"asked": "glass", "left": 0}, InvalidValueError, r"options asked, right, got \['asked', 'left'\]"),
    ]
    for options, kind, said in refused:
        with pytest.raises(kind, match=said):
            asked(plant, **options)


def test_sorting_without_a_lateral_axis_is_refused_before_a_port_is_opened(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(serial, "open_gripper", lambda url: pytest.fail("a port was opened"))
    with pytest.raises(InvalidValueError, match=r"serial:///dev/tips.*give lateral="):
        SortEnv(plant=URL, lift=Arm(lambda: 0.0))


def test_two_real_objects_are_sorted_on_ports(tmp_path: Path) -> None:
    """The right one is lifted and held; then the same deed is wrong, since the other one was asked for."""
    pytest.importorskip("serial")
    simulated = gymnasium.make("thermograsp/Sort-v0")  # here, since a process that compiles holds a file
    with nothing_left(), on_ports(tmp_path, Hand()):
        env = gymnasium.make(
            "thermograsp/Sort-v0",
            plant=f"serial://{tmp_path}/tips?gripper=robotiq://{tmp_path}/gripper",
            lift=Arm(time.monotonic),
            lateral=Arm(time.monotonic),
            hold_seconds=0.2,
            disable_env_checker=True,
        )
        assert env.observation_space == simulated.observation_space
        assert env.action_space == simulated.action_space
        for right in (1, 0):
            observation, info = env.reset(seed=0, options={"asked": "iron", "right": right})
            assert observation["goal"].sum() == 1.0 and (info["asked"], info["right"]) == ("iron", right)
            ended = False
            while not ended:
                place = float(observation["lateral"][0])
                there, held = place > 0.035, observation["force"][:, 0].min() > 5.0
                action = sliding_action_of(
                    0.0 if there else 0.085, 30.0, 0.05 if held else 0.0, 0.0 if there else 0.1
                )
                observation, _, terminated, truncated, info = env.step(action)
                assert env.observation_space.contains(observation) and "error" not in info
                ended = terminated or truncated
            assert info["success"] == (right == 1) and info.get("wrong", False) == (right == 0)
        env.close()
    simulated.close()
