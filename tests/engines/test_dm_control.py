"""dm_control's manipulator and finger feel aluminium colder than wood."""

# pyright: reportMissingImports=false

from typing import Any

import numpy as np
import pytest

import thermograsp

suite = pytest.importorskip("dm_control.suite")

TIPS = {"thumb": "thumb2", "finger": "finger2"}


def manipulated(material: str) -> Any:
    """The largest drops while the manipulator's hand holds its ball."""
    env = thermograsp.wrappers.DmControlThermalWrapper(
        suite.load("manipulator", "bring_ball", {"random": 0}),
        fingertips=TIPS,
        objects={"ball": material},
        chain="ideal",
        dt=0.01,
    )
    step = env.reset()
    physics = env.physics
    most = np.zeros(len(TIPS))
    action = np.zeros(5)
    action[-1] = 1.0
    for number in range(150):
        if number < 60:  # held where the hand closes
            at = physics.named.data.site_xpos["grasp"]
            physics.named.data.qpos["ball_x"], physics.named.data.qpos["ball_z"] = at[0], at[2]
            for joint in ("ball_x", "ball_z", "ball_y"):
                physics.named.data.qvel[joint] = 0.0
        step = env.step(action)
        most = np.maximum(most, env.touch.reading.temperature_drop)
    assert step.observation["voltage"].shape == env.observation_spec()["voltage"].shape == (2, 16)
    return most


def test_a_manipulator_feels_aluminium_colder_than_wood() -> None:
    metal, wood = manipulated("aluminium"), manipulated("wood")
    touching = metal > 0.1
    assert touching.any()
    assert (metal[touching] > 1.3 * wood[touching]).all()


def poked(material: str) -> float:
    """The largest drop while a finger pushes its spinner."""
    env = thermograsp.wrappers.DmControlThermalWrapper(
        suite.load("finger", "spin", {"random": 0}),
        fingertips={
            "tip": thermograsp.Fingertip("fingertip", (0.025, 0.0, -0.155), (1.0, 0.0, 0.0), (0.04, 0.04))
        },
        objects={"spinner": material},
        chain="ideal",
    )
    env.reset()
    most = 0.0
    for number in range(300):
        env.step(np.full(2, 1.0 if number % 60 < 30 else -1.0))
        most = max(most, float(env.touch.reading.temperature_drop[0]))
    return most


def test_a_finger_feels_aluminium_colder_than_wood() -> None:
    metal, wood = poked("aluminium"), poked("wood")
    assert metal > 0.02
    assert metal > 1.3 * wood
