"""robosuite's Lift feels aluminium colder than wood."""

# pyright: reportMissingImports=false

from typing import Any

import numpy as np
import pytest

import thermograsp

robosuite = pytest.importorskip("robosuite")

PADS = {f"finger{n}": f"gripper0_right_finger{n}_pad_collision" for n in (1, 2)}


def lifted(material: str) -> Any:
    """The touch after a scripted grasp of the cube."""
    env = thermograsp.wrappers.RobosuiteThermalWrapper(
        robosuite.make(
            "Lift",
            robots="Panda",
            has_renderer=False,
            has_offscreen_renderer=False,
            use_camera_obs=False,
            ignore_done=True,
            seed=0,
        ),
        fingertips=PADS,
        objects={"cube_main": material},
        chain="ideal",
    )
    observation, info = env.reset(), {}
    for step in range(80):
        away = observation["cube_pos"] - observation["robot0_eef_pos"]
        if step < 25:
            away = away + (0.0, 0.0, 0.08)
        action = np.concatenate((np.clip(10 * away, -1, 1), np.zeros(3), [-1.0 if step < 45 else 1.0]))
        observation, _, _, info = env.step(action)
    assert observation["voltage"].shape == (2, 16)
    return info["touch"]


def test_lift_feels_aluminium_colder_than_wood() -> None:
    metal, wood = lifted("aluminium"), lifted("wood")
    assert metal.touching == ("cube_main", "cube_main")
    assert (metal.temperature_drop > 2.0).all()
    assert (metal.temperature_drop > 2 * wood.temperature_drop).all()
