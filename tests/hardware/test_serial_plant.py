"""The serial plant on emulated devices: in step with virtual time, in real time, and when something breaks."""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

import thermograsp  # noqa: F401  (registers the environments)
from thermograsp.errors import InvalidValueError
from thermograsp.hardware import (
    Contact,
    DeviceModel,
    EmulatedFingertips,
    EmulatedGripper,
    Feel,
    Fingertips,
    GripperModel,
    GripperStatus,
    PtyDevice,
    RobotiqGripper,
    RobotiqUnits,
    SpringFingers,
    VirtualLine,
)
from thermograsp.hardware.errors import DeviceError, StoppedError
from thermograsp.hardware.plant import SerialConfig
from thermograsp.hardware.plant.pacing import VirtualTime
from thermograsp.hardware.plant.serial import SerialPlant, serial_plant
from thermograsp.plant import Command, Reading

from .serving import QUICK, nothing_left

WIDTH = 0.04  # m, of the object
CLOSE = Command(np.array([0.0]), np.array([30.0]), np.array([0.0]))


class Hand:
    """Devices that know of each other: the pads feel a force where the fingers are at the object."""

    def __init__(self, warm: bool = True, stroke: float = 0.085) -> None:
        self.units = RobotiqUnits(stroke=stroke)
        self.fingers = SpringFingers(stroke, WIDTH)
        self.gripper = EmulatedGripper(GripperModel(units=self.units, activation_speed=1.0), self.fingers)
        self.warm = warm
        self.fingertips = EmulatedFingertips(self.feel)

    def feel(self, now: float) -> Feel:
        force = 1e5 * max(0.0, WIDTH - self.fingers.opening)
        pad = (force, 0.0, 0.0)
        return Feel((now * 1e-4, -now * 1e-4), (0.0, 0.0), (pad, pad), (36.0, 36.0) if self.warm else None)


def in_step(hand: Hand, **config: float) -> tuple[SerialPlant, VirtualLine]:
    lines = VirtualLine(hand.fingertips), VirtualLine(hand.gripper)
    tips = Fingertips(lines[0].open, clock=lines[0].clock, background=False, rate=100, setpoint=36.0)
    gripper = RobotiqGripper(lines[1].open, units=hand.units, clock=lines[1].clock, sleep=lines[1].advance)
    return SerialPlant(tips, gripper, SerialConfig(**config), VirtualTime(lines)), lines[0]  # pyright: ignore[reportArgumentType]


def fresh(plant: SerialPlant) -> Reading:
    return plant.reset([0], [np.random.default_rng(0)], {})


def test_in_step_every_sample_is_read_once() -> None:
    plant, line = in_step(Hand())
    reading = fresh(plant)
    assert reading.error == ("",) and reading.opening[0] == pytest.approx(0.085, abs=1e-3)
    seen, openings, forces = [], [], []
    for _ in range(100):
        reading = plant.step(CLOSE)
        assert reading.error == ("",) and reading.truth["late"] == 0.0
        seen.append(reading.voltage[0])
        openings.append(reading.opening[0])
        forces.append(reading.force[0, :, 0])
    voltage = np.concatenate(seen)
    np.testing.assert_allclose(np.diff(voltage[:, 0]), 1e-6, atol=1.5e-9)
    np.testing.assert_allclose(voltage[:, 1], -voltage[:, 0], atol=1.5e-9)
    assert voltage[-1, 0] == pytest.approx(line.now * 1e-4, abs=2e-9)  # the newest
    assert (plant.counts.overruns, plant.counts.repeated, plant.counts.skipped) == (0, 0, 0)
    assert openings[-1] == pytest.approx(WIDTH, abs=1e-3)
    np.testing.assert_allclose(forces[-1], 30.0, atol=2.0)
    assert "material" in reading.truth["unknown"][0]


def test_in_step_it_is_the_same_every_time() -> None:
    def run() -> bytes:
        plant, _ = in_step(Hand())
        fresh(plant)
        readings = [plant.step(CLOSE) for _ in range(50)]
        return b"".join(r.voltage.tobytes() + r.opening.tobytes() + r.force.tobytes() for r in readings)

    assert run() == run()


def test_a_reset_waits_for_the_thermostats() -> None:
    hand = Hand(warm=False)
    plant, line = in_step(hand)
    begun = line.now
    reading = fresh(plant)
    assert line.now - begun > 4.0  # 12 K with 5 W
    np.testing.assert_allclose(reading.thermostat, 36.0, atol=1.1)
    hand.fingertips.broken_heaters.add(0)
    hand.fingertips.overheat(0)
    with pytest.raises(RuntimeError, match="too hot"):
        fresh(plant)


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


@contextmanager
def on_ports(folder: Path, hand: Hand) -> Iterator[tuple[PtyDevice, PtyDevice]]:
    with (
        PtyDevice(hand.fingertips, folder / "tips") as tips,
        PtyDevice(hand.gripper, folder / "gripper") as gripper,
    ):
        yield tips, gripper


def eventually(true: Callable[[], bool], seconds: float = 3.0) -> bool:
    deadline = time.monotonic() + seconds
    while not true() and time.monotonic() < deadline:
        time.sleep(0.01)
    return true()


def test_the_environment_runs_on_ports_without_a_changed_line(tmp_path: Path) -> None:
    pytest.importorskip("serial")
    hand = Hand()
    with nothing_left(), on_ports(tmp_path, hand):
        url = f"serial://{tmp_path}/tips?gripper=robotiq://{tmp_path}/gripper"
        env = gymnasium.make("thermograsp/Grasp-v0", plant=url, disable_env_checker=True)
        simulated = gymnasium.make("thermograsp/Grasp-v0", material="glass")
        assert env.observation_space == simulated.observation_space
        assert env.action_space == simulated.action_space
        observation, info = env.reset(seed=0)
        begun = time.monotonic()
        for _ in range(50):
            observation, _, _, _, info = env.step(np.array([-1.0, 0.5, 0.0], np.float32))
            assert env.observation_space.contains(observation)
        assert time.monotonic() - begun > 0.98
        assert "error" not in info
        assert "conductance" in info["unknown"] and info["late"] >= 0
        assert observation["gripper"][0] < 0.05
        env.close()
        simulated.close()


def test_a_declaration_is_made_on_ports(tmp_path: Path) -> None:
    pytest.importorskip("serial")
    with nothing_left(), on_ports(tmp_path, Hand()):
        url = f"serial://{tmp_path}/tips?gripper=robotiq://{tmp_path}/gripper"
        env = gymnasium.make("thermograsp/Identify-v0", plant=url, disable_env_checker=True)
        env.reset(seed=0)
        action = np.array([0.5, 1.0, 1.0, *[-1.0] * 9], np.float32)
        _, _, terminated, _, info = env.step(action)
        assert terminated and info["prediction"].argmax() == 0
        assert not info["success"]  # nobody knows what it is
        env.close()


def test_an_agent_that_stops_is_noticed(tmp_path: Path) -> None:
    pytest.importorskip("serial")
    hand = Hand()
    with nothing_left(), on_ports(tmp_path, hand) as (tips, gripper):
        plant = SerialPlant(
            Fingertips(tips.path, rate=100, setpoint=36.0, settings=QUICK),
            RobotiqGripper(gripper.path),
            SerialConfig(watchdog=0.8),  # longer than a busy machine stalls
        )
        fresh(plant)
        for _ in range(40):
            assert plant.step(CLOSE).error == ("",)
        assert hand.fingers.opening < 0.05
        assert eventually(lambda: hand.fingers.opening > 0.08)  # nobody steps
        assert "no step for" in plant.step(CLOSE).error[0]
        plant.close()
        plant.close()


@pytest.mark.parametrize("gone", ["fingertips", "gripper"])
def test_a_line_that_is_unplugged(tmp_path: Path, gone: str) -> None:
    pytest.importorskip("serial")
    hand = Hand()
    with nothing_left(), on_ports(tmp_path, hand) as (tips, gripper):
        plant = serial_plant(f"serial://{tips.path}?gripper=robotiq://{gripper.path}", 1)
        fresh(plant)
        for _ in range(20):
            plant.step(CLOSE)
        (tips if gone == "fingertips" else gripper).unplug()
        begun = time.monotonic()
        while not (error := plant.step(CLOSE).error[0]):
            assert time.monotonic() - begun < 1.0
        assert error
        if gone == "fingertips":
            assert eventually(lambda: hand.fingers.opening > 0.08)
        plant.close()


@pytest.mark.parametrize(
    ("url", "rows", "config", "said"),
    [
        ("serial:///dev/x", 1, {}, r"serial://PORT\?gripper=URL"),
        ("serial://host/x?gripper=robotiq:///y", 1, {}, "give serial"),
        ("serial:///x?gripper=robotiq:///y&speed=3", 1, {}, "give serial"),
        ("serial:///x?gripper=robotiq:///y", 2, {}, "num_envs must be 1"),
        ("serial:///x?gripper=robotiq:///y", 1, {"material": "glass"}, "a serial plant takes rate, dt"),
        ("serial:///x?gripper=robotiq:///y", 1, {"dt": 0.015}, "whole number of samples"),
        ("serial:///x?gripper=robotiq:///y", 1, {"watchdog": 0.01}, "at least 2 steps"),
        (
            "serial:///x?gripper=robotiq:///y",
            1,
            {"watchdog": float("nan")},
            "watchdog must be a finite number",
        ),
        (
            "serial:///x?gripper=robotiq:///y",
            1,
            {"watchdog": float("inf")},
            "watchdog must be a finite number",
        ),
        (
            "serial:///x?gripper=robotiq:///y",
            1,
            {"setpoint": float("nan")},
            "setpoint must be a finite number",
        ),
    ],
)
def test_what_no_serial_plant_can_be(url: str, rows: int, config: dict[str, Any], said: str) -> None:
    with pytest.raises(InvalidValueError, match=said):
        serial_plant(url, rows, **config)


def test_options_of_a_reset_are_refused() -> None:
    plant, _ = in_step(Hand())
    with pytest.raises(InvalidValueError, match="no reset options"):
        plant.reset([0], [np.random.default_rng(0)], {"material": "glass"})


@pytest.mark.parametrize(("stroke", "widest"), [(0.05, 0.05), (0.085, 0.085), (0.14, 0.085)])
def test_a_gripper_of_another_stroke(stroke: float, widest: float) -> None:
    """A shorter one opens as far as it can, a longer one as far as an observation can tell."""
    hand = Hand(stroke=stroke)
    plant, _ = in_step(hand)
    assert fresh(plant).opening[0] == pytest.approx(widest, abs=1e-3)
    for _ in range(60):
        assert plant.step(CLOSE).error == ("",)
    assert hand.fingers.opening < WIDTH
    wide = Command(np.array([0.085]), np.array([30.0]), np.array([0.0]))
    assert plant.quantised(wide).opening[0] == pytest.approx(widest, abs=1e-3)
    for _ in range(60):
        assert plant.step(wide).error == ("",)
    assert plant.step(wide).opening[0] == pytest.approx(widest, abs=1e-3)


class Older:
    """A gripper whose class was written before grippers told their stroke."""

    def __init__(self, gripper: Any, **attributes: float) -> None:
        self._gripper = gripper
        self.__dict__ |= attributes

    def __getattr__(self, name: str) -> Any:
        if name == "stroke":
            raise AttributeError(name)
        return getattr(self._gripper, name)


def test_a_gripper_that_does_not_tell_its_stroke() -> None:
    hand = Hand()
    plain, _ = in_step(hand)
    plant = SerialPlant(plain._tips, Older(plain._gripper), plain.config, plain._pace)  # pyright: ignore[reportArgumentType]
    assert fresh(plant).opening[0] == pytest.approx(0.085, abs=1e-3)
    assert plant.step(CLOSE).error == ("",)
    for stroke in (float("nan"), 0.0, -0.05):
        older = Older(plain._gripper, stroke=stroke)
        with pytest.raises(InvalidValueError, match="the gripper's stroke"):
            SerialPlant(plain._tips, older, plain.config, plain._pace)  # pyright: ignore[reportArgumentType]


class Stubborn:
    """A gripper of another package, which raises what it likes."""

    stroke = 0.085

    def __init__(self) -> None:
        self.failures = 0
        self.moves: list[Any] = []

    def move(self, opening: float, force: float, speed: float) -> GripperStatus:
        if self.failures:
            self.failures -= 1
            raise OSError("the bus is busy")
        self.moves.append(opening)
        return self.status()

    def status(self) -> GripperStatus:
        opening = next((one for one in reversed(self.moves) if one != "stop"), 0.0)
        return GripperStatus(opening, opening, False, Contact.NONE, 0.0, True, "")

    def activate(self) -> None:
        pass

    def close(self) -> None:
        pass


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
