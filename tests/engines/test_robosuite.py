"""robosuite's Lift and Stack feel aluminium colder than wood."""

# pyright: reportMissingImports=false, reportAttributeAccessIssue=false

import os
import shutil
from typing import Any

import mujoco
import numpy as np
import pytest

import thermograsp
from thermograsp.touch import install

robosuite = pytest.importorskip("robosuite")

PADS = {f"finger{n}": f"gripper0_right_finger{n}_pad_collision" for n in (1, 2)}


def made(task: str) -> Any:
    return robosuite.make(
        task,
        robots="Panda",
        has_renderer=False,
        has_offscreen_renderer=False,
        use_camera_obs=False,
        ignore_done=True,
        seed=0,
    )


def grasp(env: Any, seen: str) -> tuple[Any, dict[str, Any]]:
    """Observation and info after a scripted grasp of a cube, whose place is observed by that name. From robosuite's
    own environment the info is empty."""
    start = env.reset()
    observation, info = start if isinstance(start, tuple) else (start, {})
    for step in range(80):
        away = observation[seen] - observation["robot0_eef_pos"]
        if step < 25:
            away = away + (0.0, 0.0, 0.08)
        action = np.concatenate((np.clip(10 * away, -1, 1), np.zeros(3), [-1.0 if step < 45 else 1.0]))
        observation, _, _, info = env.step(action)
    return observation, info


def grasped(task: str, seen: str, objects: dict[str, str]) -> Any:
    """The touch after a scripted grasp of a cube."""
    env = thermograsp.wrappers.RobosuiteThermalWrapper(
        made(task), fingertips=PADS, objects=objects, chain="ideal"
    )
    observation, info = grasp(env, seen)
    assert observation["voltage"].shape == (2, 16)
    return info["touch"]


@pytest.mark.skipif(
    shutil.which(os.environ.get("CC", "cc")) is None, reason="needs a C compiler to build the plugin"
)
def test_lift_has_the_voltages_in_its_sensordata() -> None:
    """With heat inside MuJoCo's step, in the model that the environment compiles at every reset."""
    voltage_of = {}
    for material in ("aluminium", "wood"):

        def with_heat(xml: str, material: str = material) -> str:
            spec = mujoco.MjSpec.from_string(xml)
            install(spec, fingertips=PADS, objects={"cube_main": material})
            return spec.to_xml()

        env = made("Lift")
        env.set_xml_processor(with_heat)
        grasp(env, "cube_pos")
        # robosuite 1.5.2's sim.data.get_sensor takes a sensor's number for its address
        voltage_of[material] = env.sim.data._data.sensor("heat").data.copy()
        env.reset()
        assert not env.sim.data._data.sensor("heat").data.any()
    seebeck = thermograsp.thermal.sensor("seed").seebeck
    assert voltage_of["aluminium"].shape == (2,)
    assert (voltage_of["aluminium"] > 2.0 * seebeck).all()
    assert (voltage_of["aluminium"] > 2 * voltage_of["wood"]).all()


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
