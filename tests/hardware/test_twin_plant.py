"""plant="twin": environments and policies on the emulated gripper, in virtual time."""

import json
from typing import Any

import gymnasium
import numpy as np
import pytest

import thermograsp  # noqa: F401  registers the environments
from thermograsp.cli import main
from thermograsp.envs import STAKES, action_of
from thermograsp.envs.plant import pair_plant
from thermograsp.errors import InvalidValueError, UnknownKeywordError
from thermograsp.hardware import Fingertips, GripperModel, RobotiqGripper, VirtualLine
from thermograsp.hardware.plant import SerialPlant, VirtualTime
from thermograsp.plant import Command, Reading
from thermograsp.twin.plant import twin_pair_plant
from thermograsp.twin.simulated_hand import SimulatedHand

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


def test_a_grasp_is_lifted_and_judged_through_the_line(capsys: Any) -> None:
    """By a gripper of the simulated one's forces; a 2F-85, which presses with 20 N at least, crushes what is soft."""
    words = ["score", "trained", "--task", "grasp", "--no-load", "--twin", "--episodes", "4", "--json"]
    assert main([*words, "--force-range", "1", "40"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["force_range"] == [1.0, 40.0] and found["successes"] == 4
    env = gymnasium.make("thermograsp/Grasp-v0", plant="twin", **{**STAKES, "material": "butter"})
    env.reset(seed=0)
    gentle = action_of(opening=0.0, force_limit=8.0, lift_rate=0.0)
    while True:
        *_, terminated, truncated, info = env.step(gentle)
        if terminated or truncated:
            break
    assert info.get("crushed")
    env.close()


def test_the_arm_goes_where_a_simulation_alone_has_it(twin: gymnasium.Env) -> None:
    """Also with open fingers, and opening them wide puts no other object there."""
    alone = gymnasium.make("thermograsp/Grasp-v0", material=["glass", "copper"])
    heights: list[list[float]] = []
    for env in (twin, alone):
        env.reset(seed=5)
        rates = [0.05] * 40 + [-0.05] * 20 + [0.0] * 20
        steps = [
            env.step(action_of(opening=0.085, force_limit=20.0, lift_rate=rate))[0]["gripper"][2]
            for rate in rates
        ]
        heights.append(steps)
    np.testing.assert_allclose(heights[0], heights[1], atol=1e-6)
    assert max(heights[0]) > 0.03
    twin.reset(seed=0, options={"material": "glass"})
    for _ in range(50):
        twin.step(CLOSE)
    wide = action_of(opening=0.085, force_limit=20.0, lift_rate=0.0)
    hand = twin.unwrapped.batch.plant._hand  # pyright: ignore[reportAttributeAccessIssue]
    before = hand.episodes
    for _ in range(60):
        twin.step(wide)
    assert hand.opening > 0.0849 and hand.episodes == before
    alone.close()


WEAK = ["--force-range", "1", "40"]


@pytest.mark.parametrize(
    ("task", "policy", "forces", "episodes"),
    [
        ("sort", "trained", [], 2),
        ("hotter", "trained", WEAK, 2),
        ("hotter", "scripted", [], 2),
        *(
            pytest.param(task, policy, forces, 4, marks=pytest.mark.slow)
            for task, policy in (("sort", "trained"), ("hotter", "trained"), ("hotter", "scripted"))
            for forces in ([], WEAK)
        ),
    ],
)
def test_objects_are_sorted_and_judged_through_the_line(
    task: str, policy: str, forces: list[str], episodes: int, capsys: Any
) -> None:
    words = ["score", policy, "--task", task, "--twin", "--episodes", str(episodes), "--json", *forces]
    assert main(words + ["--no-load"] * (policy == "trained")) == 0
    assert json.loads(capsys.readouterr().out)["successes"] == episodes


def to(place: float, reading: Reading, opening: float) -> Command:
    """Sideways to that place, m."""
    assert reading.lateral is not None
    rate = np.clip((place - reading.lateral) / 0.1, -0.1, 0.1)
    return Command(np.array([opening]), np.array([20.0]), np.zeros(1), rate)


def test_a_pair_is_felt_as_in_the_simulation_alone_and_stays_while_the_fingers_open() -> None:
    """There and back between two objects, which keep what heat they have been given."""
    keywords: dict[str, Any] = {"material": ["glass", "copper"]}
    alone, behind = pair_plant("alone", 1, **keywords), twin_pair_plant("twin-pair", 1, **keywords)
    seen, bits = [], []
    for _ in range(2):
        expected = alone.reset([0], [np.random.default_rng(7)], {})
        reading = behind.reset([0], [np.random.default_rng(7)], {})
        episodes, worst, largest, touched = behind._hand.episodes, 0.0, 0.0, []
        for side in (0, 1, 0):
            for k in range(140):
                opening = 0.085 if k < 50 or k > 105 else 0.0
                command = to(alone.layout.places[side], reading, opening)  # pyright: ignore[reportAttributeAccessIssue]
                expected = alone.step(behind._serial.quantised(command))
                reading = behind.step(command)
                assert reading.error == ("",)
                np.testing.assert_allclose(reading.lateral, expected.lateral, atol=1e-12)  # pyright: ignore[reportArgumentType, reportCallIssue]
                worst = max(worst, float(abs(reading.voltage - expected.voltage).max()))
                largest = max(largest, float(abs(reading.voltage).max()))
                bits.append(reading.voltage.tobytes() + reading.force.tobytes())
            touched.append(expected.truth["touched"][0].tolist())
        assert touched == [[0, 0], [1, 1], [0, 0]]
        assert behind._hand.episodes == episodes and largest > 3e-3
        assert worst <= 1e-9  # V, the wire's unit
        assert behind._hand.reading is not None
        for name in ("object_temperatures", "right", "goal"):
            np.testing.assert_array_equal(behind._hand.reading.truth[name], expected.truth[name])
        np.testing.assert_array_equal(reading.truth["goal"], expected.truth["goal"])
        seen.append(bits.copy())
        bits.clear()
    assert seen[0] == seen[1]  # the same seed, the same bits
    behind.close()
    with pytest.raises(InvalidValueError, match="num_envs must be 1"):
        twin_pair_plant("twin-pair", 2)


def test_a_hand_that_draws_by_itself_keeps_a_pair_until_it_is_activated_anew() -> None:
    hand = SimulatedHand(
        pair_plant("behind", 1, material=["glass", "copper"]), model=GripperModel(activation_speed=1.0)
    )
    lines = VirtualLine(hand.fingertips), VirtualLine(hand.gripper)
    gripper = RobotiqGripper(lines[1].open, clock=lines[1].clock, sleep=lines[1].advance)
    tips = Fingertips(lines[0].open, clock=lines[0].clock, background=False, setpoint=36.0)
    plant = SerialPlant(tips, gripper, pace=VirtualTime(lines), lift=hand.lift, lateral=hand.lateral)
    reading = plant.reset([0], [np.random.default_rng(0)], {})
    for opening in (0.085, 0.0, 0.085):
        for _ in range(60):
            reading = plant.step(to(0.03, reading, opening))
    assert hand.episodes == 1 and reading.lateral == pytest.approx(0.03, abs=1e-3)
    reading = plant.reset([0], [np.random.default_rng(0)], {})
    assert hand.episodes == 1 and reading.lateral == pytest.approx(0.0, abs=5e-4)
    hand.gripper.power_cycle()
    plant.step(to(0.0, reading, 0.085))
    plant.reset([0], [np.random.default_rng(0)], {})
    assert hand.episodes == 2
    plant.close()


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
    for forces in ("weak=1", "weakest=one", "weakest"):
        with pytest.raises(InvalidValueError, match="N in newtons"):
            gymnasium.make("thermograsp/Grasp-v0", plant=f"twin:?{forces}")
    with pytest.raises(InvalidValueError, match="limits"):
        gymnasium.make("thermograsp/Grasp-v0", plant="twin:?weakest=50&strongest=40")
    with pytest.raises(UnknownKeywordError, match="material"):
        gymnasium.make("thermograsp/Grasp-v0", plant="twin", materials="glass")
    with pytest.raises(InvalidValueError, match="num_envs must be 1"):
        gymnasium.make_vec(
            "thermograsp/Grasp-v0", num_envs=2, plant="twin", vectorization_mode="vector_entry_point"
        )
    assert main(["score", "trained", "--task", "grasp", "--force-range", "1", "40"]) == 2
    assert "give --twin" in capsys.readouterr().err
