"""FetchPickAndPlace and the Shadow hand of gymnasium-robotics feel aluminium colder than wood."""

# pyright: reportMissingImports=false

from typing import Any

import gymnasium
import numpy as np
import pytest

import thermograsp
from thermograsp.bench.speed import scenes

gymnasium_robotics = pytest.importorskip("gymnasium_robotics")
gymnasium.register_envs(gymnasium_robotics)

FETCH = {side: f"robot0:{side}_gripper_finger_link" for side in ("r", "l")}
SHADOW = {name: f"robot0:{name}distal" for name in ("ff", "mf", "rf", "lf", "th")}


def grasped(material: str) -> Any:
    """The touch after a scripted grasp of two seconds."""
    env = thermograsp.wrappers.AddThermalObservation(
        gymnasium.make("FetchPickAndPlace-v4"), fingertips=FETCH, objects={"object0": material}, chain="ideal"
    )
    observation, info = env.reset(seed=3)
    for step in range(49):
        grip, block = observation["observation"][:3], observation["observation"][3:6]
        above = step < 12
        goal = block + (0.0, 0.0, 0.1 if above else 0.0)
        action = np.append(np.clip(10 * (goal - grip), -1, 1), 1.0 if step < 24 else -1.0)
        observation, _, _, _, info = env.step(action.astype(np.float32))
        assert observation in env.observation_space
    return info["touch"]


def test_fetch_feels_aluminium_colder_than_wood() -> None:
    metal, wood = grasped("aluminium"), grasped("wood")
    assert metal.touching == ("object0", "object0")
    assert (metal.temperature_drop > 3.0).all()
    assert (metal.temperature_drop > 2 * wood.temperature_drop).all()


def in_hand(material: str) -> np.ndarray:
    """Largest temperature drop of each fingertip while the hand closes round its block."""
    env = thermograsp.wrappers.AddThermalObservation(
        gymnasium.make("HandManipulateBlock-v1"),
        fingertips=SHADOW,
        objects={"object": material},
        chain="ideal",
    )
    env.reset(seed=0)
    most = np.zeros(len(SHADOW))
    action = np.ones(20, np.float32)
    action[:2] = 0.0  # the wrist
    for _ in range(60):
        _, _, _, _, info = env.step(action)
        most = np.maximum(most, info["touch"].temperature_drop)
    return most


def test_a_shadow_hand_feels_aluminium_colder_than_wood() -> None:
    metal, wood = in_hand("aluminium"), in_hand("wood")
    touching = metal > 0.1
    assert touching.any()
    assert (metal[touching] > 1.3 * wood[touching]).all()


def test_fetch_is_timed_beside_itself_without_touch() -> None:
    found = {each.scene: each for each in scenes.scenes(True, 0, lambda what, part: None)}
    for name in ("FetchPickAndPlace, wrapped", "FetchPickAndPlace's scene, inside mj_step"):
        assert found[name].same and found[name].ratio > 0
