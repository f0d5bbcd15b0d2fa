"""`thermograsp train`: an interrupted run goes on from its checkpoint; what it writes acts with NumPy alone."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("stable_baselines3", reason="needs stable-baselines3: make test-rl")
pytest.importorskip("tensorboard", reason="needs tensorboard: make test-rl")

from stable_baselines3 import PPO  # pyright: ignore[reportMissingImports]

from thermograsp.agents.learning import TASKS, LearningTask, Recipe, learning_task, load_agent
from thermograsp.agents.learning import training as training_module
from thermograsp.agents.learning.imitation import Seen, imitate, watched
from thermograsp.agents.learning.inputs import REPEAT
from thermograsp.agents.learning.perceiving import Perceiving
from thermograsp.agents.learning.teachers import TEACHERS
from thermograsp.agents.learning.training import MODEL, POLICY, SEEN, STATE, Progress, Training
from thermograsp.envs import force_window
from thermograsp.errors import InvalidValueError


def brief(name: str) -> LearningTask:
    """A task that ends soon."""
    task = learning_task(name)
    return replace(task, keywords={**task.keywords, "seconds": 0.4})


TINY = Recipe(
    steps=960,
    taught=0.5,
    rounds=2,
    minibatches=4,
    last_minibatches=4,
    num_envs=4,
    hidden=(8,),
    decisions=12,
    batch=24,
    epochs=1,
    checkpoints=2,
    evaluated=2,
)


@pytest.mark.parametrize("name", sorted(TASKS))
def test_every_task_is_trained_alike(name: str, tmp_path: Path) -> None:
    reports: list[Progress] = []
    training = Training(brief(name), tmp_path, recipe=TINY, report=reports.append)
    best = training.run()
    assert best["steps"] <= training.steps == reports[-1].steps >= TINY.steps
    assert {each.doing for each in reports} == {"imitation", "ppo"}
    assert list((tmp_path / "tensorboard").glob("events.*"))
    agent = load_agent(tmp_path / POLICY)
    assert agent.task == name and agent.about["seed"] == 0
    state = json.loads((tmp_path / STATE).read_text())
    assert [each["doing"] for each in state["evaluations"]][:2] == ["imitation", "imitation"]


def test_half_of_the_practice_has_everything_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """And a run that was begun with draws does not go on without."""
    recipe, seen = replace(TINY, steps=320, taught=1.0, rounds=1), []
    monkeypatch.setattr(training_module, "watched", lambda *given: seen.append(watched(*given)) or seen[-1])
    for drawn in (False, True):
        training = Training(brief("grasp"), tmp_path / str(drawn), recipe=recipe, drawn=drawn)
        training.run()
        assert load_agent(training.out / POLICY).about["randomize"] == drawn
    plain, first, second = (each.vector for each in seen)
    plain = plain.reshape(-1, recipe.num_envs, plain.shape[1])[:, : recipe.num_envs // 2].reshape(first.shape)
    assert np.array_equal(first, plain) and not np.array_equal(second, plain)
    with pytest.raises(InvalidValueError, match=r"\(randomize differ\)"):
        Training(brief("grasp"), tmp_path / "True", recipe=recipe, resume=True)


def test_the_file_acts_as_the_network_that_was_trained(tmp_path: Path) -> None:
    training = Training(brief("sort"), tmp_path, recipe=replace(TINY, taught=1.0, rounds=1))
    training.run()  # with one evaluation, which is the best
    agent = load_agent(tmp_path / POLICY)
    vector = np.random.default_rng(0).standard_normal((5, agent.inputs.size)).astype(np.float32)
    predicted, _ = PPO.load(tmp_path / MODEL).predict(vector, deterministic=True)
    np.testing.assert_allclose(agent.decide(vector), predicted, atol=1e-2)  # weights of float16


def test_scaled_inputs_change_nothing_but_the_descent(tmp_path: Path) -> None:
    """What a network does before imitation it does afterwards where nothing is learned."""
    training = Training(brief("identify"), tmp_path, recipe=TINY)
    policy, rng = training._model.policy, np.random.default_rng(0)
    size = training._env.inputs.size
    vector = (rng.standard_normal((64, size)) * rng.uniform(0.0, 3.0, size) + 1.0).astype(np.float32)
    seen = Seen(vector, np.zeros((64, 12), np.float32), np.zeros(64, np.float32))
    before, _ = policy.predict(vector, deterministic=True)
    imitate(policy, seen, 1, replace(TINY, imitation_rate=0.0), seed=0)
    after, _ = policy.predict(vector, deterministic=True)
    np.testing.assert_allclose(after, before, atol=1e-5)


def test_who_cannot_tell_moves_one_way_and_says_how_probable_it_is(tmp_path: Path) -> None:
    """Seven of ten answers were 1 and three -1: their median is 1 and their mean .4."""
    policy = Training(brief("identify"), tmp_path, recipe=TINY)._model.policy
    vector = np.zeros((200, policy.observation_space.shape[0]), np.float32)
    right = np.repeat(np.where(np.arange(200) % 10 < 7, 1.0, -1.0)[:, None], 12, axis=1).astype(np.float32)
    seen = Seen(vector, right, np.full(200, np.nan, np.float32))
    recipe = replace(TINY, batch=512, imitation_rate=0.03)
    imitate(policy, seen, 600, recipe, seed=0, averaged=slice(1, None))
    said, _ = policy.predict(vector[:1], deterministic=True)
    assert said[0, 0] > 0.9
    np.testing.assert_allclose(said[0, 1:], 0.4, atol=0.1)


def test_a_killed_run_goes_on_from_its_checkpoint(tmp_path: Path) -> None:
    code = f"""
from dataclasses import replace
from pathlib import Path
from thermograsp.agents.learning import Recipe, learning_task
from thermograsp.agents.learning.training import Training

def report(progress):
    if progress.doing == "ppo" and progress.success is None:
        Path({str(tmp_path / "ppo")!r}).touch()
        input()

task = learning_task("identify")
task = replace(task, keywords={{"seconds": 0.4}})
Training(task, {str(tmp_path / "run")!r}, recipe={TINY!r}, report=report).run()
"""
    running = subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE)
    while not (tmp_path / "ppo").exists():
        assert running.poll() is None
        time.sleep(0.05)
    os.kill(running.pid, signal.SIGKILL)
    running.wait()
    state = json.loads((tmp_path / "run" / STATE).read_text())
    assert state["rounds_done"] == 2 and len(state["evaluations"]) == 2
    again: dict[str, Any] = {"recipe": TINY, "resume": True}
    reports: list[Progress] = []
    task = brief("identify")
    training = Training(task, tmp_path / "run", report=reports.append, **again)
    assert training.steps == 480  # what it had done
    training.run()
    assert {each.doing for each in reports} == {"ppo"} and training.steps >= TINY.steps
    evaluations = json.loads((tmp_path / "run" / STATE).read_text())["evaluations"]
    assert evaluations[:2] == state["evaluations"] and len(evaluations) > 2
    done = Training(task, tmp_path / "run", report=reports.append, **again)
    assert done.steps == training.steps and done.run() == training.best


def test_imitation_goes_on_after_its_last_round(tmp_path: Path) -> None:
    class Stop(Exception):
        pass

    def stop(progress: Progress) -> None:
        if progress.success is not None:
            raise Stop

    task = brief("grasp")
    with pytest.raises(Stop):
        Training(task, tmp_path, recipe=TINY, report=stop).run()
    assert (tmp_path / MODEL).exists()
    training = Training(task, tmp_path, recipe=TINY, resume=True)
    assert training.steps == 240
    training.run()
    assert json.loads((tmp_path / STATE).read_text())["rounds_done"] == 2


def test_a_folder_is_not_overwritten_and_not_resumed_as_another(tmp_path: Path) -> None:
    task = brief("identify")
    other = {**Training(task, tmp_path / "other", recipe=TINY).about, "task": "sort", "seed": 3}
    (tmp_path / STATE).write_text(json.dumps(other))
    with pytest.raises(InvalidValueError, match="--resume"):
        Training(task, tmp_path, recipe=TINY)
    with pytest.raises(InvalidValueError, match=r"another training \(task, seed differ\)"):
        Training(task, tmp_path, recipe=TINY, resume=True)
    with pytest.raises(InvalidValueError, match="seed must be"):
        Training(task, tmp_path / "new", seed=1000, recipe=TINY)


@pytest.mark.parametrize("damaged", [STATE, SEEN, MODEL])
def test_a_damaged_folder_is_refused_by_the_name_of_its_file(tmp_path: Path, damaged: str) -> None:
    task = brief("identify")
    about = Training(task, tmp_path / "fresh", recipe=TINY).about
    state = {**about, "rounds_done": 1, "evaluations": []}
    (tmp_path / STATE).write_text("{" if damaged == STATE else json.dumps(state))
    if damaged != STATE:
        (tmp_path / damaged).write_bytes(b"half a file")
    with pytest.raises(InvalidValueError, match=f"{damaged} is damaged"):
        Training(task, tmp_path, recipe=TINY, resume=True).run()


def shown(task: LearningTask, rows: int) -> tuple[np.ndarray, list[Any]]:
    """Whether the teacher succeeds in `rows` episodes, (rows,) bool, and their objects."""
    env = Perceiving(task, rows, True, True)
    env.seed(5)
    env.reset()
    teacher, bodies = TEACHERS[task.name](env.batch), list(env.batch.plant.bodies)
    teacher.restart(np.arange(rows))
    ended, won = np.zeros(rows, bool), np.zeros(rows, bool)
    said = None  # a learner that does what it was taught last
    for _ in range(round(10.0 / 0.02 / REPEAT)):
        said = np.clip(np.nan_to_num(teacher.action(env.raw, said), nan=-1.0), -1.0, 1.0)
        _, _, now, infos = env.step(said)
        won |= ~ended & np.array([bool(info.get("success")) for info in infos])
        ended |= now
        teacher.restart(np.flatnonzero(now))
        if ended.all():
            break
    return won, bodies


@pytest.mark.parametrize("name", sorted(TASKS))
def test_the_teachers_succeed(name: str) -> None:
    """In all episodes that they are shown."""
    won, _ = shown(learning_task(name), 12)
    assert won.all()


def test_with_everything_drawn_the_grasping_teacher_fails_only_where_its_forces_slip() -> None:
    won, bodies = shown(learning_task("grasp").drawn(), 48)
    least = np.array([force_window(body)[0] for body in bodies])
    soft = np.array([force_window(body)[1] < 40.0 for body in bodies])
    assert 0 < (~won).sum() < 12
    assert np.all(least[~won] > np.where(soft[~won], 9.5, 38.0))
