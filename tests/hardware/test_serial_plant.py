"""The serial plant on emulated devices: in step with virtual time, in real time, and when something breaks."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import gymnasium
import numpy as np
import pytest

import thermograsp  # noqa: F401  (registers the environments)
from thermograsp.errors import InvalidValueError
from thermograsp.hardware import (
    EmulatedFingertips,
    EmulatedGripper,
    Feel,
    Fingertips,
    GripperModel,
    PtyDevice,
    RobotiqGripper,
    SpringFingers,
    VirtualLine,
)
from thermograsp.hardware.pacing import VirtualTime
from thermograsp.hardware.serial_plant import SerialConfig, SerialPlant, serial_plant
from thermograsp.plant import Command, Reading

from .serving import QUICK, nothing_left

WIDTH = 0.04  # m, of the object
CLOSE = Command(np.array([0.0]), np.array([30.0]), np.array([0.0]))


class Hand:
    """Devices that know of each other: the pads feel a force where the fingers are at the object."""

    def __init__(self, warm: bool = True) -> None:
        self.fingers = SpringFingers(0.085, WIDTH)
        self.gripper = EmulatedGripper(GripperModel(activation_speed=1.0), self.fingers)
        self.warm = warm
        self.fingertips = EmulatedFingertips(self.feel)

    def feel(self, now: float) -> Feel:
        force = 1e5 * max(0.0, WIDTH - self.fingers.opening)
        pad = (force, 0.0, 0.0)
        return Feel((now * 1e-4, -now * 1e-4), (0.0, 0.0), (pad, pad), (36.0, 36.0) if self.warm else None)


def in_step(hand: Hand, **config: float) -> tuple[SerialPlant, VirtualLine]:
    lines = VirtualLine(hand.fingertips), VirtualLine(hand.gripper)
    tips = Fingertips(lines[0].open, clock=lines[0].clock, background=False, rate=100, setpoint=36.0)
    gripper = RobotiqGripper(lines[1].open, clock=lines[1].clock, sleep=lines[1].advance)
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


def broken(hand: Hand, what: str) -> None:
    if what == "silent":
        hand.fingertips.stall_until = float("inf")
    elif what == "open":
        hand.fingertips.broken_thermistors.add(1)
    elif what == "hot":
        hand.fingertips.overheat(0)
    elif what == "crushed":
        hand.fingertips.source = lambda now: Feel(
            force=((150.0, 0, 0), (150.0, 0, 0)), thermostat=(36.0, 36.0)
        )


@pytest.mark.parametrize(
    ("what", "said"),
    [
        ("silent", "no sample for"),
        ("open", "right thermistor is open"),
        ("hot", "too hot"),
        ("crushed", "150.0 N"),
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


def test_an_agent_that_stops_is_noticed(tmp_path: Path) -> None:
    pytest.importorskip("serial")
    hand = Hand()
    with nothing_left(), on_ports(tmp_path, hand) as (tips, gripper):
        plant = SerialPlant(
            Fingertips(tips.path, rate=100, setpoint=36.0, settings=QUICK),
            RobotiqGripper(gripper.path),
            SerialConfig(watchdog=0.2),
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
    ],
)
def test_what_no_serial_plant_can_be(url: str, rows: int, config: dict[str, object], said: str) -> None:
    with pytest.raises(InvalidValueError, match=said):
        serial_plant(url, rows, **config)


def test_options_of_a_reset_are_refused() -> None:
    plant, _ = in_step(Hand())
    with pytest.raises(InvalidValueError, match="no reset options"):
        plant.reset([0], [np.random.default_rng(0)], {"material": "glass"})
