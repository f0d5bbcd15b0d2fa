"""robosuite's Lift and Stack feel aluminium colder than wood."""

# pyright: reportMissingImports=false

from typing import Any

import numpy as np
import pytest

import thermograsp

robosuite = pytest.importorskip("robosuite")

PADS = {f"finger{n}": f"gripper0_right_finger{n}_pad_collision" for n in (1, 2)}


def grasped(task: str, seen: str, objects: dict[str, str]) -> Any:
    """The touch after a scripted grasp of a cube, whose place is observed by that name."""
    env = thermograsp.wrappers.RobosuiteThermalWrapper(
        robosuite.make(
            task,
            robots="Panda",
            has_renderer=False,
            has_offscreen_renderer=False,
            use_camera_obs=False,
            ignore_done=True,
            seed=0,
        ),
        fingertips=PADS,
        objects=objects,
        chain="ideal",
    )
    observation, info = env.reset(), {}
    for step in range(80):
        away = observation[seen] - observation["robot0_eef_pos"]
        if step < 25:
            away = away + (0.0, 0.0, 0.08)
        action = np.concatenate((np.clip(10 * away, -1, 1), np.zeros(3), [-1.0 if step < 45 else 1.0]))
        observation, _, _, info = env.step(action)
    assert observation["voltage"].shape == (2, 16)
    return info["touch"]


def test_lift_feels_aluminium_colder_than_wood() -> None:
    metal, wood = (grasped("Lift", "cube_pos", {"cube_main": name}) for name in ("aluminium", "wood"))
    assert metal.touching == ("cube_main", "cube_main")
    assert (metal.temperature_drop > 2.0).all()
    assert (metal.temperature_drop > 2 * wood.temperature_drop).all()


def test_stack_feels_which_of_its_cubes_is_aluminium() -> None:
    both = {"cubeA_main": "aluminium", "cubeB_main": "wood"}
    metal, wood = grasped("Stack", "cubeA_pos", both), grasped("Stack", "cubeB_pos", both)
    assert metal.touching == ("cubeA_main",) * 2
    assert wood.touching == ("cubeB_main",) * 2
    assert (metal.temperature_drop > 2.0).all()
    assert (metal.temperature_drop > 2 * wood.temperature_drop).all()
