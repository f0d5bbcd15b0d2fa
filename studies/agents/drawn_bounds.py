"""What anybody could do in Grasp-v0 with stakes and, with everything drawn, in Identify-v0: bounds for agents.

Of the first held-out episodes of Grasp-v0 with everything drawn it counts those where a force of the gripper lifts the
object without a slip and without crushing it, and those where the teacher succeeds, which knows the truth. In
Identify-v0 it counts how often a posterior is right that takes each material's samples so far as jointly normal, with
mean and covariance of other episodes. For Grasp-v0, with nothing and with everything drawn, the same posterior chooses
the force that is right with the highest probability, and it is counted how often that force is right. None of these
is an exact limit: samples enter as agents get them, and the best of three regularisations is printed.

    python studies/agents/drawn_bounds.py                                            5 minutes
    python studies/agents/drawn_bounds.py --episodes 20 --examples 200 --json
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from contextlib import closing
from typing import Any

import numpy as np

from thermograsp.agents.episodes import rollout
from thermograsp.agents.learning import HELD_OUT, TASKS, LearningTask
from thermograsp.agents.learning.inputs import REPEAT, STEP
from thermograsp.agents.learning.teachers import TEACHERS
from thermograsp.envs import action_of, force_window
from thermograsp.envs.limits import MAX_FORCE

EXAMPLES = 700_000_000
"""Seed of the first episode that the posterior learns from."""
TIMES = (1.0, 2.0, 3.5)
"""s after the start of an episode of Identify-v0."""
GRASP_TIMES = (0.4, 0.5, 0.6, 0.8, 1.0)
"""s after the start of an episode of Grasp-v0, whose fingers touch at about .3 s; a lift and a hold take 1.6 s of 3."""
FORCES = np.arange(0.5, MAX_FORCE + 0.25, 0.5)
"""N that the posterior chooses from."""
GENTLE = 9.5
"""N with which the fingers wait, less than what breaks butter."""
RIDGES = (1e-6, 1e-4, 1e-3)
"""Added to the variances of the inputs, which are of order one."""
_VOLTAGE, _EACH = (
    3e-4,
    5,
)  # V, where arsinh turns from even to logarithmic; samples in one input, as in inputs.py
_AT_ONCE = 50


class _Taught:
    """A teacher as a policy, which decides every REPEAT control steps as agents do."""

    def __init__(self, batch: Any) -> None:
        self._teacher, self._steps = TEACHERS["grasp"](batch), 0

    def restart(self, rows: Sequence[int] | np.ndarray, seeds: Sequence[int]) -> None:
        del seeds
        self._teacher.restart(np.asarray(rows))
        self._steps = 0

    def action(self, observation: Any) -> np.ndarray:
        if self._steps % REPEAT == 0:
            self._last = self._teacher.action(observation)
        self._steps += 1
        return self._last


def grasps(episodes: int) -> tuple[int, int]:
    """In how many of the episodes some force is right, and in how many the teacher succeeds."""
    task, liftable = TASKS["grasp"].drawn(), 0
    at_once = min(episodes, _AT_ONCE)
    with closing(task.make(at_once)) as env:
        unwrapped: Any = env.unwrapped
        for first in range(0, episodes, at_once):
            unwrapped.reset(seed=[HELD_OUT + first + row for row in range(at_once)])
            windows = np.array([force_window(body) for body in unwrapped.batch.plant.bodies])
            right = windows[:, 0] < np.minimum(windows[:, 1], MAX_FORCE)
            liftable += int(right[: episodes - first].sum())
        return liftable, rollout(env, episodes, HELD_OUT, _Taught(unwrapped.batch)).successes


def touches(
    task: LearningTask, action: Sequence[float], seconds: float, first: int, episodes: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(E, inputs in time, 2) scaled voltages while one action lasts, (E,) the materials' numbers and (E, 2) N the force
    windows."""
    steps, inputs, materials, windows = round(seconds / STEP), [], [], []
    at_once = min(episodes, _AT_ONCE)
    with closing(task.make(at_once)) as env:
        unwrapped: Any = env.unwrapped
        batch = unwrapped.batch
        new = round(STEP * 100)  # samples of a control step at 100 Hz
        actions = np.tile(np.array(action, np.float32), (at_once, 1))
        for begun in range(0, episodes, at_once):
            unwrapped.reset(seed=[first + begun + row for row in range(at_once)])
            names = [material.name for material in batch.plant.config.choices]
            materials += [names.index(name) for name in batch.reading.truth["material"]]
            windows += [force_window(body) for body in batch.plant.bodies]
            voltage = [env.step(actions)[0]["voltage"][:, :, -new:].copy() for _ in range(steps)]
            volts = np.concatenate(voltage, axis=2).reshape(at_once, 2, -1, _EACH).mean(axis=3)
            inputs.append(np.arcsinh(volts / _VOLTAGE).transpose(0, 2, 1))
    return np.concatenate(inputs)[:episodes], np.array(materials[:episodes]), np.array(windows)[:episodes]


def posterior(episodes: int, examples: int) -> dict[float, float]:
    """Share of right answers by the time in the episode, s."""
    task = TASKS["identify"].drawn()
    closing_with_10_newtons = (0.25, *[-1.0] * 11)
    new, truth, _ = touches(task, closing_with_10_newtons, max(TIMES), HELD_OUT, episodes)
    old, known, _ = touches(task, closing_with_10_newtons, max(TIMES), EXAMPLES, examples)
    found = {}
    for seconds in TIMES:
        likely = _likely_by_ridge(new, old, known, seconds)
        found[seconds] = max(float((each.argmax(axis=1) == truth).mean()) for each in likely)
    return found


def forces(task: LearningTask, episodes: int, examples: int) -> dict[float, float]:
    """Share of episodes of Grasp-v0 in which the force that is most probably right is right, by the time at which it is
    chosen, s."""
    gently = action_of(opening=0.0, force_limit=GENTLE, lift_rate=0.0).tolist()
    new, _, windows = touches(task, gently, max(GRASP_TIMES), HELD_OUT, episodes)
    old, known, examples_windows = touches(task, gently, max(GRASP_TIMES), EXAMPLES, examples)
    right = _fit(windows)
    fits = np.array([_fit(examples_windows[known == each]).mean(axis=0) for each in range(known.max() + 1)])
    found = {}
    for seconds in GRASP_TIMES:
        shares = []
        for likely in _likely_by_ridge(new, old, known, seconds):
            probable = np.exp(likely - likely.max(axis=1, keepdims=True))
            chosen = (probable @ fits).argmax(axis=1)
            shares.append(float(right[np.arange(len(new)), chosen].mean()))
        found[seconds] = max(shares)
    return found


def _fit(windows: np.ndarray) -> np.ndarray:
    """(E, forces) whether each of FORCES lies in the windows (E, 2)."""
    return (FORCES > windows[:, :1]) & (FORCES < windows[:, 1:])


def _likely_by_ridge(new: np.ndarray, old: np.ndarray, known: np.ndarray, seconds: float) -> list[np.ndarray]:
    """(E, materials) each, log likelihoods of what was felt up to that time but for a constant, for all RIDGES."""
    count = round(seconds * 100) // _EACH
    ahead, behind = (each[:, :count].reshape(len(each), -1) for each in (new, old))
    return [_likely(ahead, behind, known, ridge) for ridge in RIDGES]


def _likely(new: np.ndarray, old: np.ndarray, known: np.ndarray, ridge: float) -> np.ndarray:
    likely = []
    for material in range(known.max() + 1):
        examples = old[known == material]
        away = new - examples.mean(axis=0)
        spread = np.cov(examples.T) + ridge * np.eye(new.shape[1])
        likely.append(-(away * np.linalg.solve(spread, away.T).T).sum(axis=1) - np.linalg.slogdet(spread)[1])
    return np.stack(likely, axis=1) / 2


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the bounds."""
    parser = argparse.ArgumentParser(description="What anybody could do, with nothing and everything drawn.")
    parser.add_argument("--episodes", type=int, default=200, help="held-out ones of each task (default 200)")
    parser.add_argument("--examples", type=int, default=5000, help="for the posterior (default 5000)")
    parser.add_argument("--json", action="store_true", help="one JSON object")
    options = parser.parse_args(arguments)
    if options.episodes < 1 or options.examples < 100:
        parser.error("give an episode at least, and 100 examples")
    liftable, taught = grasps(options.episodes)
    right = posterior(options.episodes, options.examples)
    tasks = {"nothing": TASKS["grasp"], "everything": TASKS["grasp"].drawn()}
    chosen = {name: forces(task, options.episodes, options.examples) for name, task in tasks.items()}
    if options.json:
        found = {"liftable": liftable, "taught": taught, "right": right, "forces": chosen}
        print(json.dumps({**found, **vars(options)}))
        return 0
    print(
        f"Grasp-v0, everything drawn: a force is right in {liftable} of {options.episodes}, the teacher succeeds in "
        f"{taught}"
    )
    for name, shares in chosen.items():
        for seconds, share in shares.items():
            print(
                f"Grasp-v0, {name} drawn: after {seconds:g} s the most probable force is right in {100 * share:.1f} %"
            )
    for seconds, share in right.items():
        print(f"Identify-v0: after {seconds:g} s the posterior is right in {100 * share:.1f} %")
    return 0


if __name__ == "__main__":
    sys.exit(main())
