"""Meta-World's pick-place feels aluminium colder than wood."""

# pyright: reportMissingImports=false

from typing import Any

import gymnasium
import numpy as np
import pytest

import thermograsp

pytest.importorskip("metaworld")


def picked(material: str) -> Any:
    """The touch while Meta-World's own policy holds the puck."""
    from metaworld.policies import SawyerPickPlaceV3Policy

    env = thermograsp.wrappers.AddThermalObservation(
        gymnasium.make("Meta-World/MT1", env_name="pick-place-v3", seed=1),
        fingertips={
            side: thermograsp.Fingertip(f"{side}pad", (0.033, y, -0.006), (0, y / 0.003, 0), (0.024, 0.018))
            for side, y in (("left", -0.003), ("right", 0.003))
        },
        objects={"obj": material},
        chain="ideal",
    )
    policy = SawyerPickPlaceV3Policy()
    observation, info = env.reset(seed=1)
    for _ in range(100):
        action = np.clip(policy.get_action(observation["observation"]), -1, 1)
        observation, _, _, _, info = env.step(action.astype(np.float32))
    assert observation["voltage"].shape == (2, 16)
    return info["touch"]


def test_pick_place_feels_aluminium_colder_than_wood() -> None:
    metal, wood = picked("aluminium"), picked("wood")
    assert metal.touching == ("obj", "obj")
    assert (metal.temperature_drop > 2.0).all()
    assert (metal.temperature_drop > 2 * wood.temperature_drop).all()
