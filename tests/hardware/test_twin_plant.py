"""plant="twin": environments and policies on the emulated gripper, in virtual time."""

import json
from typing import Any

import gymnasium
import numpy as np
import pytest

import thermograsp  # noqa: F401  registers the environments
from thermograsp.cli import main
from thermograsp.errors import InvalidValueError, UnknownKeywordError

CLOSE = np.array([-1.0, 0.5, 1.0], np.float32)


def grasped(env: gymnasium.Env, seed: int, options: dict[str, Any] | None = None) -> tuple[np.ndarray, dict]:
    """The voltages of 1 s, and the last info."""
    env.reset(seed=seed, options=options)
    steps = [env.step(CLOSE) for _ in range(50)]
    return np.array([step[0]["voltage"] for step in steps]), steps[-1][4]


@pytest.fixture(scope="module")
def twin() -> Any:
    env = gymnasium.make("thermograsp/Grasp-v0", plant="twin", material=["glass", "copper"])
    yield env
    env.close()


def test_the_same_seed_gives_the_same_bits_and_another_does_not(twin: gymnasium.Env) -> None:
    first, _ = grasped(twin, 3)
    other, _ = grasped(twin, 4)
    again, _ = grasped(twin, 3)
    np.testing.assert_array_equal(first, again)
    assert (first != other).any()


def test_it_tells_the_material_and_what_no_real_gripper_knows(twin: gymnasium.Env) -> None:
    drawn = {grasped(twin, seed)[1]["material"] for seed in range(8)}
    assert drawn == {"glass", "copper"}
    glass, info = grasped(twin, 0, {"material": "glass"})
    copper, _ = grasped(twin, 0, {"material": "copper"})
    assert info["material"] == "glass" and "conductance" in info["unknown"]
    assert copper[-1, :, -1].min() > 1.5 * glass[-1, :, -1].max()


def test_a_reset_before_the_fingers_closed_takes_another_object(twin: gymnasium.Env) -> None:
    twin.reset(seed=0, options={"material": "glass"})
    _, info = twin.reset(seed=0, options={"material": "copper"})
    assert info["material"] == "copper"


def test_a_policy_is_judged_through_the_line(capsys: Any) -> None:
    assert main(["score", "trained", "--task", "identify", "--twin", "--episodes", "4", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["twin"] and found["successes"] == 4


def test_what_no_line_has_is_refused(twin: gymnasium.Env, capsys: Any) -> None:
    with pytest.raises(InvalidValueError, match="unknown reset options"):
        twin.reset(options={"colour": "red"})
    refused: list[tuple[dict[str, Any], str]] = [
        ({"taxels": (4, 4)}, "one load cell"),
        ({"sensor_temperature": (30.0, 36.0)}, "both are alike"),
    ]
    for keywords, message in refused:
        with pytest.raises(InvalidValueError, match=message):
            gymnasium.make("thermograsp/Grasp-v0", plant="twin", **keywords)
    with pytest.raises(InvalidValueError, match="has no port"):
        gymnasium.make("thermograsp/Grasp-v0", plant="twin:///dev/ttyACM0")
    with pytest.raises(UnknownKeywordError, match="material"):
        gymnasium.make("thermograsp/Grasp-v0", plant="twin", materials="glass")
    with pytest.raises(InvalidValueError, match="num_envs must be 1"):
        gymnasium.make_vec(
            "thermograsp/Grasp-v0", num_envs=2, plant="twin", vectorization_mode="vector_entry_point"
        )
    assert main(["score", "trained", "--task", "grasp", "--twin"]) == 2
    assert "no lift axis" in capsys.readouterr().err
