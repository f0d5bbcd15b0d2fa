"""The serial plant on emulated devices behind ports, in real time: environments, idle agents, unplugged lines."""

import time
from pathlib import Path

import gymnasium
import numpy as np
import pytest

import thermograsp  # noqa: F401  (registers the environments)
from thermograsp.hardware import Fingertips, RobotiqGripper
from thermograsp.hardware.plant import SerialConfig
from thermograsp.hardware.plant.serial import SerialPlant, serial_plant

from .hand import CLOSE, Hand, eventually, fresh, on_ports
from .serving import QUICK, nothing_left


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
