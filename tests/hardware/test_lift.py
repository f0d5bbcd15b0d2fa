"""A serial plant whose arm lifts: an axis in virtual time, its limits, and what happens when something breaks."""

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.hardware import Fingertips, PtyDevice, SerialConfig, SerialPlant
from thermograsp.hardware.errors import DeviceError, StoppedError
from thermograsp.hardware.plant import serial
from thermograsp.plant import Command

from .hand import CLOSE, WIDTH, Hand, Stubborn, eventually, fresh, in_step
from .serving import nothing_left

RATE = 0.05  # m/s


class Arm:
    """Goes on at its rate while time goes on. at: what happens at the next call of a method."""

    def __init__(self, now: Callable[[], float], travel: float = 0.1, height: float = 0.0) -> None:
        self.travel, self.rate, self.closed, self.stops = travel, 0.0, 0, 0
        self.at: dict[str, Callable[[], Any]] = {}
        self._now, self._since, self._height = now, now(), height

    @property
    def height(self) -> float:
        return self._height + self.rate * (self._now() - self._since)

    def move(self, rate: float) -> None:
        self._reached("move")
        self._turn(rate)

    def position(self) -> float:
        other = self._reached("position")
        return self.height if other is None else other

    def stop(self) -> None:
        self._reached("stop")
        self.stops += 1
        self._turn(0.0)

    def close(self) -> None:
        self.closed += 1

    def _turn(self, rate: float) -> None:
        self._height, self._since = self.height, self._now()
        self.rate = rate

    def _reached(self, moment: str) -> Any:
        return self.at.pop(moment, lambda: None)()


def lifting(hand: Hand, **arm: float) -> tuple[SerialPlant, Arm]:
    plain, line = in_step(hand)
    axis = Arm(lambda: line.now, **arm)
    return SerialPlant(plain._tips, plain._gripper, plain.config, plain._pace, lift=axis), axis


def command(rate: float, opening: float = 0.0) -> Command:
    return Command(np.array([opening]), np.array([30.0]), np.array([rate]))


def holding(hand: Hand, **arm: float) -> tuple[SerialPlant, Arm]:
    """Something is held 20 mm up, and still on its way."""
    plant, axis = lifting(hand, **arm)
    fresh(plant)
    for _ in range(60):
        assert plant.step(CLOSE).error == ("",)
    for _ in range(20):
        assert plant.step(command(RATE)).error == ("",)
    assert hand.fingers.opening < WIDTH and axis.rate == RATE
    return plant, axis


def failing(error: Exception) -> Callable[[], Any]:
    def fail() -> None:
        raise error

    return fail


def test_it_rises_as_it_is_told_and_tells_its_height() -> None:
    plant, axis = lifting(Hand())
    assert fresh(plant).height[0] == 0.0
    heights = [plant.step(command(RATE)).height[0] for _ in range(20)]
    np.testing.assert_allclose(np.diff(heights), RATE * plant.dt, atol=1e-9)
    assert heights[-1] == pytest.approx(20 * RATE * plant.dt, abs=1e-3)
    last = plant.step(command(0.0))
    assert last.height[0] == pytest.approx(axis.height, abs=1e-9) and axis.rate == 0.0
    assert "height" not in last.truth["unknown"][0] and "lateral" in last.truth["unknown"][0]


@pytest.mark.parametrize(("travel", "end"), [(0.03, 0.03), (1.0, 0.15)])
def test_it_stops_at_both_ends_of_its_travel(travel: float, end: float) -> None:
    plant, axis = lifting(Hand(), travel=travel)
    fresh(plant)
    heights = [plant.step(command(rate)).height[0] for rate in (RATE, -RATE) for _ in range(200)]
    slack = 0.009 * RATE  # the height is asked for before the step's end
    assert max(heights) == pytest.approx(end, abs=slack) and max(heights) <= end + 1e-9
    assert heights[-1] == pytest.approx(0.0, abs=slack) and min(heights) >= -slack


def test_without_an_axis_only_a_simulation_lifts() -> None:
    plain, _ = in_step(Hand())
    plant, _ = lifting(Hand())
    assert plain.quantised(command(RATE)).lift_rate[0] == 0.0
    assert plant.quantised(command(RATE)).lift_rate[0] == RATE
    with pytest.raises(InvalidValueError, match="the lift's travel"):
        lifting(Hand(), travel=0.0)


BREAKS: dict[str, Callable[[Hand, Arm], object]] = {
    "a sensor": lambda hand, axis: hand.fingertips.broken_thermistors.add(1),
    "the axis is told": lambda hand, axis: axis.at.update(move=failing(DeviceError("the arm has a fault"))),
    "the axis is asked": lambda hand, axis: axis.at.update(position=failing(DeviceError("no arm"))),
    "the axis does not know": lambda hand, axis: axis.at.update(position=lambda: float("nan")),
}


@pytest.mark.parametrize("what", BREAKS)
def test_what_breaks_stops_the_lift_and_opens_the_fingers(what: str) -> None:
    hand = Hand()
    plant, axis = holding(hand)
    BREAKS[what](hand, axis)
    errors = [plant.step(command(RATE)).error[0] for _ in range(20)]
    assert errors[-1] and axis.rate == 0.0
    stayed = axis.height
    plant._pace.until(plant._pace.now() + 1.0)
    assert axis.height == stayed > 0.015
    assert hand.fingers.opening == pytest.approx(0.085, abs=1e-3)


@pytest.mark.parametrize(
    ("rate", "at", "kind"),
    [
        (float("nan"), {}, InvalidValueError),
        (RATE, {"move": failing(OSError("the bus is busy"))}, OSError),
        (RATE, {"position": failing(OSError("the bus is busy"))}, OSError),
    ],
)
def test_an_error_of_another_kind_lets_go_and_is_raised(
    rate: float, at: dict[str, Callable[[], Any]], kind: type[Exception]
) -> None:
    hand = Hand()
    plant, axis = holding(hand)
    axis.at |= at
    with pytest.raises(kind):
        plant.step(command(rate))
    assert "let go" in plant.step(command(RATE)).error[0]
    assert axis.rate == 0.0
    plant._pace.until(plant._pace.now() + 1.0)
    assert hand.fingers.opening == pytest.approx(0.085, abs=1e-3)


def test_a_stop_holds_everything_until_a_reset_puts_it_down() -> None:
    """It lowers first what the fingers still hold."""
    hand = Hand()
    plant, axis = holding(hand)
    plant.stop()
    height, opening = axis.height, hand.fingers.opening
    assert "stopped where they are" in plant.step(command(RATE)).error[0]
    plant._pace.until(plant._pace.now() + 1.0)
    assert axis.height == height > 0.015 and hand.fingers.opening == opening
    lowered: list[float] = []
    move = plant._gripper.move

    def moved(*args: float) -> Any:
        lowered.append(axis.height)
        return move(*args)

    plant._gripper.move = moved  # pyright: ignore[reportAttributeAccessIssue]
    assert fresh(plant).error == ("",)
    assert abs(lowered[0]) < 5e-4 and axis.rate == 0.0
    assert plant.step(CLOSE).error == ("",)


def test_a_stop_reaches_the_gripper_where_the_lift_raises() -> None:
    hand = Hand()
    plant, axis = holding(hand)
    closing = command(RATE)
    axis.at["stop"] = failing(OSError("the bus is busy"))
    with pytest.raises(OSError, match="busy"):
        plant.stop()
    assert axis.rate == 0.0  # it was told again
    assert "stopped where they are" in plant.step(closing).error[0]
    assert hand.fingers.opening < WIDTH


def test_a_gripper_that_was_stopped_by_itself_stops_the_lift() -> None:
    hand = Hand()
    plant, axis = holding(hand)
    axis.at["move"] = failing(StoppedError("the arm was stopped meanwhile"))
    assert plant.step(command(RATE)).error == ("the arm was stopped meanwhile",)
    assert axis.rate == 0.0 and hand.fingers.opening < WIDTH


def test_a_stop_ends_a_reset_that_lowers() -> None:
    plant, axis = lifting(Hand(), height=0.09)
    axis.at["move"] = lambda: axis.at.update(position=lambda: threading.Thread(target=plant.stop).start())
    with pytest.raises(StoppedError, match="stopped where they are"):
        fresh(plant)
    assert axis.rate == 0.0 and axis.height > 0.05


def test_a_lift_that_does_not_come_down_ends_the_reset() -> None:
    plant, axis = lifting(Hand(), height=0.09)
    axis._turn = lambda rate: None  # pyright: ignore[reportAttributeAccessIssue]
    with pytest.raises(DeviceError, match="in vain for the lift to go down"):
        fresh(plant)
    assert axis.stops


def test_closing_stops_and_releases_it_once() -> None:
    plant, axis = holding(Hand())
    plant.close()
    plant.close()
    assert axis.closed == 1 and axis.rate == 0.0


def test_the_watchdog_tells_a_lift_again_that_did_not_hear(tmp_path: Path) -> None:
    pytest.importorskip("serial")
    stubborn = Stubborn()
    with nothing_left(), PtyDevice(Hand().fingertips, tmp_path / "tips") as served:
        tips = Fingertips(served.path, rate=100, setpoint=36.0)
        axis = Arm(lambda: 0.0)
        plant = SerialPlant(tips, stubborn, SerialConfig(watchdog=0.2), lift=axis)  # pyright: ignore[reportArgumentType]
        fresh(plant)
        assert plant.step(command(RATE)).error == ("",)
        axis.at["stop"] = failing(OSError("the bus is busy"))
        assert eventually(lambda: axis.rate == 0.0)  # nobody steps
        assert "no step for" in plant.step(CLOSE).error[0]
        plant.close()


@pytest.mark.parametrize("name", ["lift", "lateral"])
@pytest.mark.parametrize(
    ("axis", "said"),
    [
        (3.0, "{} must be .* float has no travel, move, position, stop, close"),
        (object(), "{} must be .* object has no travel"),
        (Arm(lambda: 0.0, travel=0.0), "the {}.* travel"),
        (Arm(lambda: 0.0, travel=float("nan")), "the {}.* travel"),
    ],
)
def test_what_is_no_axis_is_refused_and_both_lines_are_released(
    monkeypatch: pytest.MonkeyPatch, name: str, axis: Any, said: str
) -> None:
    released = []

    class Line:
        stroke = 0.085

        def close(self) -> None:
            released.append(self)

    monkeypatch.setattr(serial, "open_gripper", lambda url: Line())
    monkeypatch.setattr(serial, "Fingertips", lambda port, **settings: Line())
    with pytest.raises(InvalidValueError, match=said.format(name)):
        serial.serial_plant("serial:///dev/tips?gripper=robotiq:///dev/gripper", 1, **{name: axis})
    assert len(released) == 2
