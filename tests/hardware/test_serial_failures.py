"""The serial plant opens the gripper where something breaks, whatever it is, and ends the episode."""

from pathlib import Path

import numpy as np
import pytest

import thermograsp  # noqa: F401  (registers the environments)
from thermograsp.errors import InvalidValueError
from thermograsp.hardware import DeviceModel, Feel, Fingertips, PtyDevice
from thermograsp.hardware.errors import DeviceError
from thermograsp.hardware.plant import SerialConfig
from thermograsp.hardware.plant.serial import SerialPlant
from thermograsp.plant import Command

from .hand import CLOSE, WIDTH, Hand, Stubborn, eventually, fresh, in_step
from .serving import nothing_left

PUSHES = {
    "pressed": (55.0, 0, 0),
    "pressed by a cell that is wired the other way round": (-55.0, 0, 0),
    "crushed": (150.0, 0, 0),
    "sheared": (5.0, -150.0, 0),
    "torn": (float("nan"), 0, 0),
}


def broken(hand: Hand, what: str) -> None:
    if what == "silent":
        hand.fingertips.stall_until = float("inf")
    elif what == "open":
        hand.fingertips.broken_thermistors.add(1)
    elif what == "hot":
        hand.fingertips.overheat(0)
    elif what == "deaf":
        hand.fingertips.broken_converters.add(1)
    elif what in PUSHES:
        hand.fingertips.source = lambda now: Feel(
            force=((0.0, 0.0, 0.0), PUSHES[what]), thermostat=(36.0, 36.0)
        )


def test_most_force_can_be_reached() -> None:
    """The guard's own limit lies below where the load cells end; a limit above that ends an episode there."""
    assert SerialConfig().most_force < DeviceModel().most_force
    hand = Hand()
    plant, line = in_step(hand, most_force=200.0)
    fresh(plant)
    broken(hand, "crushed")
    while not (error := plant.step(CLOSE).error[0]):
        assert line.now < 10.0
    assert "end of its range" in error


@pytest.mark.parametrize(
    ("what", "said"),
    [
        ("silent", "no sample for"),
        ("open", "right thermistor is open"),
        ("hot", "too hot"),
        ("deaf", "right voltage is missing"),
        ("pressed", "55.0 N"),
        ("pressed by a cell that is wired the other way round", "55.0 N"),
        ("crushed", "right load cell is at an end of its range"),
        ("sheared", "right load cell is at an end of its range"),
        ("torn", "right load cell is at an end of its range"),
    ],
)
def test_what_breaks_opens_the_gripper_and_ends_the_episode(what: str, said: str) -> None:
    hand = Hand(warm=what != "hot")
    plant, line = in_step(hand)
    fresh(plant)
    for _ in range(60):
        assert plant.step(CLOSE).error == ("",)
    assert hand.fingers.opening < WIDTH
    broken(hand, what)
    begun = line.now
    while not (reading := plant.step(CLOSE)).error[0]:
        assert line.now - begun < 1.0
    assert said in reading.error[0]
    assert np.isfinite(reading.voltage).all() and np.isfinite(reading.opening).all()
    assert plant.step(CLOSE).error == reading.error  # until the next reset
    plant._pace.until(line.now + 1.0)
    assert hand.fingers.opening == pytest.approx(0.085, abs=1e-3)
    if what == "silent":
        hand.fingertips.stall_until = 0.0
        assert fresh(plant).error == ("",)


def test_no_error_ends_the_watchdog(tmp_path: Path) -> None:
    """It tries again until the gripper has let go."""
    pytest.importorskip("serial")
    stubborn = Stubborn()
    with nothing_left(), PtyDevice(Hand().fingertips, tmp_path / "tips") as served:
        tips = Fingertips(served.path, rate=100, setpoint=36.0)
        plant = SerialPlant(tips, stubborn, SerialConfig(watchdog=0.2))  # pyright: ignore[reportArgumentType]
        fresh(plant)
        assert plant.step(CLOSE).error == ("",)
        stubborn.failures = 3
        assert eventually(lambda: stubborn.moves[-1] == 0.085)
        assert stubborn.failures == 0
        plant.close()


@pytest.mark.parametrize(("opening", "said"), [(np.nan, "nan"), (40.0, r"opening 40 m: give 0 to 0\.085 m")])
def test_an_error_of_another_kind_lets_go_and_is_raised(opening: float, said: str) -> None:
    """Such as a command that no gripper has: it is not taken for the nearest that there is."""
    hand = Hand()
    plant, line = in_step(hand)
    fresh(plant)
    for _ in range(60):
        plant.step(CLOSE)
    with pytest.raises(InvalidValueError, match=said):
        plant.step(Command(np.array([opening]), np.array([30.0]), np.array([0.0])))
    assert "let go" in plant.step(CLOSE).error[0]
    plant._pace.until(line.now + 1.0)
    assert hand.fingers.opening == pytest.approx(0.085, abs=1e-3)


def test_a_reset_that_fails_lets_go() -> None:
    """Also of what an earlier failure could not let go of, and of what was held when the reset was asked for."""
    hand = Hand()
    plant, line = in_step(hand, open_within=1.0)
    fresh(plant)
    for _ in range(60):
        plant.step(CLOSE)
    assert hand.fingers.opening < WIDTH
    hand.fingertips.stall_until = float("inf")
    with pytest.raises(DeviceError, match="the fingertips to answer"):
        fresh(plant)
    assert "the reset failed" in plant.step(CLOSE).error[0]
    plant._pace.until(line.now + 1.0)
    assert hand.fingers.opening == pytest.approx(0.085, abs=1e-3)
