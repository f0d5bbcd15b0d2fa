"""The simulated plant, and the serial plant on emulated devices that a second simulation moves: the same voltages.

Both simulations get the commands as the gripper takes them. Everything between them is the real driver, the real
client, their protocols, and the emulators, in virtual time.
"""

from collections.abc import Sequence

import numpy as np
import pytest

from thermograsp.envs.simulated_plant import SimulatedPlant, simulated_plant
from thermograsp.hardware import (
    EmulatedFingertips,
    EmulatedGripper,
    Feel,
    Fingertips,
    GripperModel,
    RobotiqGripper,
    VirtualLine,
)
from thermograsp.hardware.gripper import Contact
from thermograsp.hardware.pacing import VirtualTime
from thermograsp.hardware.serial_plant import SerialPlant
from thermograsp.plant import Command, Reading
from thermograsp.thermal import ADS1115

from .tiers import size

MATERIALS = ("glass", "aluminium", "wood", "copper")


class SimulatedHand:
    """Emulated devices that a simulation moves: a control step of it for every two samples, once an episode began.
    It is the Fingers of the gripper, too."""

    contact = Contact.NONE
    current = 0.0

    def __init__(self, simulation: SimulatedPlant) -> None:
        self.simulation = simulation
        self.reading: Reading | None = None
        self.opening = 0.085
        self.told = (0.085, 20.0)
        self.samples = 0
        self.fingertips = EmulatedFingertips(self.feel)
        self.gripper = EmulatedGripper(GripperModel(activation_speed=1.0), self)

    def begin(self, seed: int, material: str) -> None:
        self.reading = self.simulation.reset([0], [np.random.default_rng(seed)], {"material": material})
        self.samples = 0

    def end(self) -> None:
        self.reading = None

    def move(self, target: float, force: float, speed: float, seconds: float) -> None:
        self.told = (target, force)
        if self.reading is None:
            self.opening = target

    def feel(self, now: float) -> Feel:
        if self.reading is None:
            return Feel(thermostat=(36.0, 36.0))
        place = self.samples % 2
        self.samples += 1
        if place == 0:
            opening, force = self.told
            self.reading = self.simulation.step(
                Command(np.array([opening]), np.array([force]), np.array([0.0]))
            )
            self.opening = float(self.reading.opening[0])
        reading = self.reading
        left, right = reading.force[0].tolist()
        return Feel(tuple(reading.voltage[0, place]), (0.0, 0.0), (left, right), tuple(reading.thermostat[0]))


@pytest.fixture(scope="module")
def simulations() -> tuple[SimulatedPlant, SimulatedPlant]:
    first, second = (simulated_plant("simulated", 1, material=list(MATERIALS)) for _ in range(2))
    return first, second


def commands(rng: np.random.Generator, steps: int) -> Sequence[Command]:
    """Close at some force, hold, open again."""
    force, width = rng.uniform(20.0, 40.0, 1), rng.uniform(0.0, 0.01, 1)
    wide, still = np.full(1, 0.085), np.zeros(1)
    return [Command(wide if k > 0.8 * steps else width, force, still) for k in range(steps)]


def test_both_plants_give_the_same_voltages(simulations: tuple[SimulatedPlant, SimulatedPlant]) -> None:
    alone, behind = simulations
    hand = SimulatedHand(behind)
    lines = VirtualLine(hand.fingertips), VirtualLine(hand.gripper)
    tips = Fingertips(lines[0].open, clock=lines[0].clock, background=False, setpoint=36.0)
    gripper = RobotiqGripper(lines[1].open, clock=lines[1].clock, sleep=lines[1].advance)
    plant = SerialPlant(tips, gripper, pace=VirtualTime(lines))
    rng = np.random.default_rng(11)
    worst, felt = 0.0, 0.0
    for grasp in range(size(3, 100)):
        material = MATERIALS[grasp % len(MATERIALS)]
        hand.end()
        plant.reset([0], [rng], {})
        hand.begin(grasp, material)
        alone.reset([0], [np.random.default_rng(grasp)], {"material": material})
        for command in commands(rng, 100):
            opening, force, _ = gripper.quantised(command.opening, command.force_limit, 0.1)
            expected = alone.step(Command(opening, force, command.lift_rate))
            serial = plant.step(command)
            assert serial.error == ("",)
            worst = max(worst, float(abs(serial.voltage - expected.voltage).max()))
            felt = max(felt, float(abs(serial.voltage).max()))
            np.testing.assert_allclose(serial.force, expected.force, atol=0.0051)
            np.testing.assert_allclose(serial.thermostat, expected.thermostat, atol=0.0051)
            np.testing.assert_allclose(
                serial.opening, expected.opening, atol=0.0003
            )  # half a count is 0.19 mm
    assert felt > 3e-3  # V: the object was felt
    assert worst <= 1e-9 < ADS1115.resolution  # a nanovolt, the wire's unit
    assert (plant.counts.overruns, plant.counts.repeated, plant.counts.skipped) == (0, 0, 0)
