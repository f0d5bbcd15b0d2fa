"""Where the serial plant is stopped nothing moves until a reset."""

import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

import thermograsp  # noqa: F401  (registers the environments)
from thermograsp.hardware import Fingertips, GripperStatus, VirtualLine
from thermograsp.hardware.errors import StoppedError
from thermograsp.hardware.plant import SerialConfig
from thermograsp.hardware.plant.pacing import VirtualTime
from thermograsp.hardware.plant.serial import SerialPlant, serial_plant

from .hand import CLOSE, WIDTH, Hand, Stubborn, eventually, fresh, on_ports
from .serving import nothing_left


class Halting(Stubborn):
    """A gripper that is stopped while it is asked for something."""

    def __init__(self) -> None:
        super().__init__()
        self.at: dict[str, Callable[[], object]] = {}
        self.stopping = threading.Event()

    def _reached(self, moment: str) -> None:
        self.at.pop(moment, lambda: None)()

    def activate(self) -> None:
        self._reached("activate")

    def move(self, opening: float, force: float, speed: float) -> GripperStatus:
        if self.stopping.is_set():
            self.stopping.clear()
            raise StoppedError("it was stopped meanwhile")
        self.moves.append(opening)
        return super().status()

    def status(self) -> GripperStatus:
        self._reached("status")
        return super().status()

    def stop(self) -> GripperStatus:
        self.moves.append("stop")
        return super().status()


def halting() -> tuple[SerialPlant, Halting, Hand]:
    hand, gripper = Hand(), Halting()
    line = VirtualLine(hand.fingertips)
    tips = Fingertips(line.open, clock=line.clock, background=False, rate=100, setpoint=36.0)
    return SerialPlant(tips, gripper, SerialConfig(), VirtualTime([line])), gripper, hand  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize("broken_too", [False, True])
@pytest.mark.parametrize("when", ["between steps", "status"])
def test_nothing_moves_after_a_stop_until_a_reset(when: str, broken_too: bool) -> None:
    """Whatever goes wrong besides."""
    plant, gripper, hand = halting()
    fresh(plant)
    plant.step(CLOSE)
    if when == "between steps":
        plant.stop()
    else:
        gripper.at[when] = plant.stop
    if broken_too:
        hand.fingertips.broken_thermistors.add(1)
    errors = [plant.step(CLOSE).error[0] for _ in range(10)]
    assert "stopped where they are" in errors[-1]
    assert gripper.moves[-1] == "stop"
    hand.fingertips.broken_thermistors.clear()
    assert fresh(plant).error == ("",)
    assert gripper.moves[-1] == 0.085


@pytest.mark.parametrize("when", ["activate", "status"])
def test_a_stop_ends_a_reset(when: str) -> None:
    plant, gripper, _ = halting()
    gripper.at[when] = plant.stop
    with pytest.raises(StoppedError, match="stopped where they are"):
        fresh(plant)
    assert gripper.moves[-1] == "stop"
    plant.step(CLOSE)
    assert gripper.moves[-1] == "stop"


def test_a_gripper_that_was_stopped_by_itself_is_not_opened() -> None:
    """Its own stop ends a step's command, too: the fingers hold what they hold."""
    plant, gripper, _ = halting()
    fresh(plant)
    plant.step(CLOSE)
    held = list(gripper.moves)
    gripper.stopping.set()
    assert plant.step(CLOSE).error == ("it was stopped meanwhile",)
    assert gripper.moves == held
    assert plant.step(CLOSE).error == ("it was stopped meanwhile",) and gripper.moves == held


def test_a_stop_goes_before_a_step_that_is_waiting_for_its_turn(tmp_path: Path) -> None:
    """From another thread, on real ports: after it returns, the fingers stay."""
    pytest.importorskip("serial")
    hand = Hand()
    with nothing_left(), on_ports(tmp_path, hand) as (tips, gripper):
        plant = serial_plant(f"serial://{tips.path}?gripper=robotiq://{gripper.path}", 1, speed=0.02)
        fresh(plant)
        ended = threading.Event()

        def act() -> None:
            while not ended.is_set():
                plant.step(CLOSE)

        acting = threading.Thread(target=act)
        acting.start()
        try:
            assert eventually(lambda: hand.fingers.opening < 0.08)
            plant.stop()
            stayed = hand.fingers.opening
            time.sleep(0.3)  # 6 mm of motion, had it gone on
            assert hand.fingers.opening == pytest.approx(stayed, abs=1e-4) and stayed > WIDTH
            assert "stopped where they are" in plant.step(CLOSE).error[0]
        finally:
            ended.set()
            acting.join()
            plant.close()
