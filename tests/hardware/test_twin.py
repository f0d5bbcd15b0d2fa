"""The simulated plant, and the serial plant on emulated devices that a second simulation moves: the same voltages.

Both simulations get the commands as the gripper takes them. Everything between them is the real driver, the real
client, their protocols, and the emulators, in virtual time.
"""

from collections.abc import Sequence

import numpy as np
import pytest

from thermograsp.envs.plant.simulated import SimulatedPlant, simulated_plant
from thermograsp.hardware import (
    Fingertips,
    GripperModel,
    RobotiqGripper,
    VirtualLine,
)
from thermograsp.hardware.plant.pacing import VirtualTime
from thermograsp.hardware.plant.serial import SerialPlant
from thermograsp.plant import Command
from thermograsp.thermal import ADS1115
from thermograsp.twin.simulated_hand import SimulatedHand

from .tiers import size

MATERIALS = ("glass", "aluminium", "wood", "copper")


@pytest.fixture(scope="module")
def simulations() -> tuple[SimulatedPlant, SimulatedPlant]:
    first, second = (simulated_plant("simulated", 1, material=list(MATERIALS)) for _ in range(2))
    return first, second


def commands(rng: np.random.Generator, steps: int) -> Sequence[Command]:
    """Close at some force, hold, open again, but not so wide that the hand takes a fresh object."""
    force, width = rng.uniform(20.0, 40.0, 1), rng.uniform(0.0, 0.01, 1)
    wide, still = np.full(1, 0.08), np.zeros(1)
    return [Command(wide if k > 0.8 * steps else width, force, still) for k in range(steps)]


def test_both_plants_give_the_same_voltages(simulations: tuple[SimulatedPlant, SimulatedPlant]) -> None:
    alone, behind = simulations
    hand = SimulatedHand(behind, model=GripperModel(activation_speed=1.0))
    lines = VirtualLine(hand.fingertips), VirtualLine(hand.gripper)
    tips = Fingertips(lines[0].open, clock=lines[0].clock, background=False, setpoint=36.0)
    gripper = RobotiqGripper(lines[1].open, clock=lines[1].clock, sleep=lines[1].advance)
    plant = SerialPlant(tips, gripper, pace=VirtualTime(lines))
    rng = np.random.default_rng(11)
    worst, largest = 0.0, 0.0
    for grasp in range(size(3, 100)):
        plant.reset([0], [rng], {})
        alone.reset([0], [np.random.default_rng(grasp)], {})
        for command in commands(rng, 100):
            expected = alone.step(plant.quantised(command))
            serial = plant.step(command)
            assert serial.error == ("",)
            worst = max(worst, float(abs(serial.voltage - expected.voltage).max()))
            largest = max(largest, float(abs(serial.voltage).max()))
            np.testing.assert_allclose(serial.force, expected.force, atol=0.0051)
            np.testing.assert_allclose(serial.thermostat, expected.thermostat, atol=0.0051)
            np.testing.assert_allclose(
                serial.opening, expected.opening, atol=0.0003
            )  # half a count is 0.19 mm
    assert hand.episodes == size(3, 100)
    assert largest > 3e-3  # V: the object was felt
    assert worst <= 1e-9 < ADS1115.resolution  # a nanovolt, the wire's unit
    assert (plant.counts.overruns, plant.counts.repeated, plant.counts.skipped) == (0, 0, 0)
