"""The serial plant on emulated devices in step with virtual time, and what no serial plant can be."""

from typing import Any

import numpy as np
import pytest

import thermograsp  # noqa: F401  (registers the environments)
from thermograsp.errors import InvalidValueError
from thermograsp.hardware.plant.serial import SerialPlant, serial_plant
from thermograsp.plant import Command

from .hand import CLOSE, WIDTH, Hand, fresh, in_step


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
