"""What anybody could do with everything drawn, in Grasp-v0 with stakes and in Identify-v0: bounds for agents.

Of the first held-out episodes of Grasp-v0 it counts those where a force of the gripper lifts the object without a slip
and without crushing it, and those where the teacher succeeds, which knows the truth. In Identify-v0 it counts how often
a posterior is right that takes each material's samples so far as jointly normal, with mean and covariance of other
episodes. That is no exact limit: samples enter as agents get them, and the best of three regularisations is printed.

    python studies/drawn_bounds.py                                            4 minutes
    python studies/drawn_bounds.py --episodes 20 --examples 200 --json
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
from thermograsp.agents.learning import HELD_OUT, TASKS
from thermograsp.agents.learning.inputs import REPEAT, STEP
from thermograsp.agents.learning.teachers import TEACHERS
from thermograsp.envs import force_window
from thermograsp.envs.limits import MAX_FORCE

EXAMPLES = 700_000_000
"""Seed of the first episode that the posterior learns from."""
TIMES = (1.0, 2.0, 3.5)
"""s after an episode's start."""
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


def touches(first: int, episodes: int) -> tuple[np.ndarray, np.ndarray]:
    """(E, inputs in time, 2) scaled voltages of fingers that close with 10 N and wait, and (E,) the materials."""
    steps, inputs, materials = round(max(TIMES) / STEP), [], []
    at_once = min(episodes, _AT_ONCE)
    with closing(TASKS["identify"].drawn().make(at_once)) as env:
        unwrapped: Any = env.unwrapped
        batch = unwrapped.batch
        new = round(STEP * 100)  # samples of a control step at 100 Hz
        action = np.full((at_once, *unwrapped.single_action_space.shape), -1.0, np.float32)
        action[:, 0] = 0.25
        for begun in range(0, episodes, at_once):
            unwrapped.reset(seed=[first + begun + row for row in range(at_once)])
            materials += [batch.task.classes.index(name) for name in batch.reading.truth["material"]]
            voltage = [env.step(action)[0]["voltage"][:, :, -new:].copy() for _ in range(steps)]
            volts = np.concatenate(voltage, axis=2).reshape(at_once, 2, -1, _EACH).mean(axis=3)
            inputs.append(np.arcsinh(volts / _VOLTAGE).transpose(0, 2, 1))
    return np.concatenate(inputs)[:episodes], np.array(materials[:episodes])


def posterior(episodes: int, examples: int) -> dict[float, float]:
    """Share of right answers by the time in the episode, s."""
    new, truth = touches(HELD_OUT, episodes)
    old, known = touches(EXAMPLES, examples)
    found = {}
    for seconds in TIMES:
        count = round(seconds * 100) // _EACH
        ahead, behind = (each[:, :count].reshape(len(each), -1) for each in (new, old))
        right = [(_likeliest(ahead, behind, known, ridge) == truth).mean() for ridge in RIDGES]
        found[seconds] = float(max(right))
    return found


def _likeliest(new: np.ndarray, old: np.ndarray, known: np.ndarray, ridge: float) -> np.ndarray:
    likely = []
    for material in range(known.max() + 1):
        examples = old[known == material]
        away = new - examples.mean(axis=0)
        spread = np.cov(examples.T) + ridge * np.eye(new.shape[1])
        likely.append(-(away * np.linalg.solve(spread, away.T).T).sum(axis=1) - np.linalg.slogdet(spread)[1])
    return np.argmax(likely, axis=0)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the bounds."""
    parser = argparse.ArgumentParser(description="What anybody could do with everything drawn.")
    parser.add_argument("--episodes", type=int, default=200, help="held-out ones of each task (default 200)")
    parser.add_argument("--examples", type=int, default=5000, help="for the posterior (default 5000)")
    parser.add_argument("--json", action="store_true", help="one JSON object")
    options = parser.parse_args(arguments)
    if options.episodes < 1 or options.examples < 100:
        parser.error("give an episode at least, and 100 examples")
    liftable, taught = grasps(options.episodes)
    right = posterior(options.episodes, options.examples)
    if options.json:
        print(json.dumps({"liftable": liftable, "taught": taught, "right": right, **vars(options)}))
        return 0
    print(f"Grasp-v0: a force is right in {liftable} of {options.episodes}, the teacher succeeds in {taught}")
    for seconds, share in right.items():
        print(f"Identify-v0: after {seconds:g} s the posterior is right in {100 * share:.1f} %")
    return 0


if __name__ == "__main__":
    sys.exit(main())
