"""Policies are scored on the same held-out episodes, and get the observation and nothing else."""

from __future__ import annotations

import json
import sys
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermograsp.agents import learning
from thermograsp.agents.learning import HELD_OUT, TASKS, Agent, learning_task, load_agent, score
from thermograsp.agents.learning.agent import Acting
from thermograsp.agents.learning.inputs import AGES, CLOSING, FRAME, REPEAT, SAMPLES, Inputs, Memory
from thermograsp.agents.learning.scoring import wilson
from thermograsp.agents.policies import load_policy, policy
from thermograsp.assets import asset
from thermograsp.cli import main
from thermograsp.errors import InvalidValueError, UnknownNameError

GUESS = """
import numpy as np

seen = []

def glass(observation):
    seen.append(sorted(observation))
    action = np.full((len(observation["gripper"]), 12), -1.0)
    action[:, 1] = action[:, 2 + 4] = 1.0
    return action

class Patient:
    def __init__(self):
        self.steps = 0

    def __call__(self, observation):
        self.steps += 1
        action = glass(observation)
        if self.steps < 5:
            action[:, 1] = -1.0
        return action

def short(observation):
    return np.zeros((1, 3))

def words(observation):
    return "glass"

def unknown(observation):
    return np.full((len(observation["gripper"]), 12), np.nan)

number = 3
"""


@pytest.fixture
def guess(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """A module of policies for Identify-v0 in the current folder."""
    (tmp_path / "guess_materials.py").write_text(GUESS)
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "guess_materials", raising=False)
    import guess_materials  # pyright: ignore[reportMissingImports]

    return guess_materials


def small_agent(task: str = "identify", actions: int = 12, goals: int = 0) -> Agent:
    rng = np.random.default_rng(0)
    inputs = Inputs(heat=False, goals=goals)
    sizes = (inputs.size, 8, actions)
    layers = tuple(
        (rng.standard_normal((out, into)).astype(np.float32), rng.standard_normal(out).astype(np.float32))
        for into, out in zip(sizes, sizes[1:], strict=False)
    )
    return Agent(task, inputs, layers, {"seed": 3})


def test_a_function_gets_the_observation_and_nothing_else(guess: Any, capsys: Any) -> None:
    line = ["score", "guess_materials:glass", "--task", "identify", "--episodes", "20", "--json"]
    assert main(line) == 0
    found = json.loads(capsys.readouterr().out)
    space = sorted(learning_task("identify").make(1).single_observation_space.spaces)  # pyright: ignore
    assert all(each == space for each in guess.seen)
    assert found["successes"] == round(20 * found["success_rate"]) and 0 < found["success_rate"] < 0.4
    assert found["mean_seconds"] == pytest.approx(0.02)  # declared at once
    low, high = found["success_interval"]
    assert low < found["success_rate"] < high
    assert main(line) == 0
    assert json.loads(capsys.readouterr().out)["digest"] == found["digest"]


def test_a_class_is_made_anew_for_each_batch_of_episodes(guess: Any) -> None:
    found = score(learning_task("identify"), "guess_materials:Patient", 60)  # 50 and 10
    assert found.seconds == pytest.approx(5 * 0.02)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("guess_materials:short", r"shape \(1, 3\)"),
        ("guess_materials:number", "is a int"),
        ("guess_materials:words", "no array of numbers"),
        ("guess_materials:unknown", "returned nan"),
        ("guess_materials:nobody", "nobody"),
        ("no_such_module:act", "no_such_module"),
    ],
)
def test_what_cannot_act_is_refused(guess: Any, name: str, message: str) -> None:
    with pytest.raises(InvalidValueError, match=message):
        score(learning_task("identify"), name, 1)


def test_unknown_tasks_and_policies_are_named(capsys: Any) -> None:
    with pytest.raises(UnknownNameError, match="identify"):
        learning_task("identfy")
    assert main(["score", "nobody", "--task", "grasp", "--episodes", "1"]) == 2
    assert "unknown policy 'nobody'" in capsys.readouterr().err


def test_training_without_its_extra_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    monkeypatch.delitem(sys.modules, "thermograsp.agents.learning.training", raising=False)
    if "training" in vars(learning):
        monkeypatch.delattr(learning, "training")
    monkeypatch.setitem(sys.modules, "tensorboard", None)
    assert main(["train", "identify", "--out", str(tmp_path / "run")]) == 2
    assert "pip install 'thermograsp[rl]'" in capsys.readouterr().err
    assert not (tmp_path / "run").exists()


def test_without_load_cells_a_script_that_needs_them_fails() -> None:
    task = learning_task("grasp")
    assert score(task, "feeling", 8).successes == 8
    assert score(task, "feeling", 8, load=False).successes == 0


@pytest.mark.slow
def test_other_grippers_and_drawn_episodes_are_scored(capsys: Any) -> None:
    line = ["score", "scripted", "--task", "grasp", "--episodes", "1", "--json"]
    digests = set()
    for more in ([], ["--randomize"], ["--gripper", str(asset("gripper.xml"))]):
        assert main(line + more) == 0
        found = json.loads(capsys.readouterr().out)
        assert found["randomize"] == ("--randomize" in more) and bool(found["gripper"]) == (
            "--gripper" in more
        )
        digests.add(found["digest"])
    assert len(digests) == 3


def test_an_agent_is_read_back_as_it_was_written(tmp_path: Path) -> None:
    written = small_agent()
    read = load_agent(written.save(tmp_path / "one.npz"))
    assert (read.task, read.inputs, read.about) == (written.task, written.inputs, written.about)
    for written_layer, read_layer in zip(written.layers, read.layers, strict=True):
        np.testing.assert_allclose(written_layer[0], read_layer[0], rtol=2**-11, atol=2**-25)  # of float16
        np.testing.assert_array_equal(written_layer[1], read_layer[1])


def test_an_agent_is_scored_from_its_file(tmp_path: Path) -> None:
    path = str(small_agent().save(tmp_path / "one.npz"))
    assert score(learning_task("identify"), path, 2).episodes == 2
    with pytest.raises(InvalidValueError, match="12 numbers"):
        score(learning_task("grasp"), path, 1)


@pytest.mark.parametrize("kind", ["empty", "text", "array", "folder"])
def test_a_file_that_holds_no_agent_is_refused(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "one.npz"
    if kind == "folder":
        path.mkdir()
    elif kind == "array":
        with path.open("wb") as file:
            np.save(file, np.zeros(3))
    else:
        path.write_text("" if kind == "empty" else "nothing")
    with pytest.raises(InvalidValueError, match="holds no trained policy"):
        load_policy(path)


def test_episodes_that_begin_at_different_times_do_not_disturb_each_other() -> None:
    env = learning_task("identify").make(2)
    both, alone = Acting(env, small_agent()), Acting(env, small_agent())
    observation, _ = env.reset(seed=0)
    both.restart([0, 1], [0, 0])
    for _ in range(3):
        both.action(observation)
    both.restart([1], [0])
    alone.restart([0, 1], [0, 0])
    for _ in range(2 * REPEAT):
        np.testing.assert_array_equal(both.action(observation)[1], alone.action(observation)[1])
        observation = env.step(np.full((2, 12), -0.5, np.float32))[0]


def test_the_newest_frame_comes_first_and_the_first_stands_for_all_before() -> None:
    env = learning_task("sort").make(2)
    observation, _ = env.reset(seed=0)
    memory = Memory(Inputs(goals=10), 2)
    memory.restart(np.arange(2))
    untouched = memory.vector(observation)
    observation["voltage"] += 2e-5  # V, of fingertips that have been in the air
    memory.restart(np.arange(2))
    first = memory.vector(observation)
    np.testing.assert_array_equal(first, untouched)
    assert first.shape == (2, Inputs(goals=10).size)
    frames = first[:, : FRAME * len(AGES)].reshape(2, len(AGES), FRAME)
    assert (frames == frames[:, :1]).all()
    observation["gripper"][:, 0] = 0.0  # closed
    second = memory.vector(observation)[:, : FRAME * len(AGES)].reshape(2, len(AGES), FRAME)
    assert (second[:, 0, 0] == -1.0).all()
    np.testing.assert_array_equal(second[:, 1:], frames[:, 1:])
    np.testing.assert_array_equal(first[:, -10:], observation["goal"])


def test_newest_samples_tell_when_a_touch_began() -> None:
    """By their differences, whatever the level, up to the newest of them."""
    env = learning_task("identify").make(1)
    observation, _ = env.reset(seed=0)
    memory, without = Memory(Inputs(samples=True), 1), Memory(Inputs(), 1)
    assert memory.inputs.size == without.inputs.size + 2 * SAMPLES
    start = FRAME * len(AGES)

    def felt(began: int) -> np.ndarray:
        """(2, SAMPLES) where both fingertips touch `began` samples ago."""
        observation["voltage"][:] = 1e-5
        observation["voltage"][:, :, -began:] = 2e-3
        vector, plain = memory.vector(observation)[0], without.vector(observation)[0]
        np.testing.assert_array_equal(np.delete(vector, range(start, start + 2 * SAMPLES)), plain)
        return vector[start : start + 2 * SAMPLES].reshape(2, SAMPLES)

    for began in (1, 3, SAMPLES):
        rises = felt(began)
        assert (rises[:, -began] > 1.0).all()
        assert np.count_nonzero(rises) == 2
    assert not felt(SAMPLES + 1).any()


def test_what_voltages_do_while_fingers_close_has_a_fixed_place() -> None:
    """Until they open again, and whatever their level is."""
    env = learning_task("identify").make(1)
    observation, _ = env.reset(seed=0)
    memory = Memory(Inputs(closing=True), 1)
    memory.restart(np.arange(1))

    def felt(opening: float, volts: float, rise: float) -> np.ndarray:
        """(CLOSING, 2, 2) by fingertip and half of a frame, as a voltage rises in the newer half."""
        observation["gripper"][0, 0] = opening
        observation["voltage"][0, :, -10:-5], observation["voltage"][0, :, -5:] = volts, volts + rise
        start = FRAME * len(AGES)
        return memory.vector(observation)[0, start : start + 4 * CLOSING].reshape(CLOSING, 2, 2)

    felt(0.085, 1e-3, 0.0)
    felt(0.085, 1e-3, 0.0)  # an episode's first frame counts as 0 V
    felt(0.06, 1e-3, 0.0)
    touched = felt(0.04, 1e-3, 2e-3)
    assert (touched[2, :, 1] > 1.0).all() and not touched[1].any() and not touched[3:].any()
    for _ in range(CLOSING):
        still = felt(0.04, 3e-3, 0.0)
    np.testing.assert_array_equal(still[:3], touched[:3])  # pyright: ignore[reportPossiblyUnboundVariable]
    assert not still[3:].any()  # pyright: ignore[reportPossiblyUnboundVariable]
    opened = felt(0.085, 3e-3, 0.0)
    assert (opened[0, :, 0] > 1.0).all() and not opened[1:].any()
    assert not felt(0.06, 3e-3, 0.0)[1:].any()


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name == "hotter" else name for name in TASKS]
)
def test_a_shipped_agent_may_begin_with_fingertips_that_have_been_in_the_air(name: str) -> None:
    """As real ones have: they show some 20 uV before they touch anything."""
    rows = 4
    with closing(learning_task(name).make(rows)) as env:
        (size,) = env.single_action_space.shape  # pyright: ignore[reportGeneralTypeIssues]
        still = np.zeros((rows, size), np.float32)
        still[:, :2] = (-1.0, -1.0) if name == "identify" else (1.0, -1.0)  # open, no force
        observation, _ = env.reset(seed=HELD_OUT)
        for _ in range(25):
            observation = env.step(still)[0]
        assert (observation["voltage"][:, :, -8:].mean(axis=2) > 5e-6).all()  # V
        agent = policy(env, "trained")
        agent.restart(range(rows), range(rows))
        over, won = np.zeros(rows, bool), np.zeros(rows, bool)
        while not over.all():
            observation, _, terminated, truncated, info = env.step(agent.action(observation))
            won |= info["success"] & ~over
            over |= terminated | truncated
        assert won.all()


def test_wilsons_interval_is_that_of_the_literature() -> None:
    """81 of 263: Newcombe R. G., Stat. Med. 17 (1998) 857, table I: .2553 .. .3662."""
    low, high = wilson(81, 263)
    assert (round(low, 4), round(high, 4)) == (0.2553, 0.3662)
    assert wilson(0, 20)[0] == 0.0 and wilson(20, 20)[1] == 1.0
