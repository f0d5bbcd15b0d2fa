"""How good a policy is: episodes that no training has seen, the same for everybody.

N: episodes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermograsp.agents.episodes import rollout
from thermograsp.agents.policies import Policy, policy
from thermograsp.errors import whole_number

from .inputs import STEP
from .tasks import LearningTask, learning_task

HELD_OUT = 1_000_000_000
"""Seed of the first episode; episode k has HELD_OUT + k. No training may use seeds from here on."""
_AT_ONCE = 50
_Z = 1.96  # of a normal distribution: 95 % lie within


@dataclass(frozen=True, slots=True)
class Score:
    """What came of N episodes. success: share, and low .. high its 95 % interval after Wilson. mean_return: of the
    task's rewards. seconds: mean length of an episode. digest: of all observations."""

    episodes: int
    successes: int
    low: float
    high: float
    mean_return: float
    seconds: float
    digest: str

    @property
    def success(self) -> float:
        """Share of the episodes."""
        return self.successes / self.episodes


def score(
    task: LearningTask | str,
    name: str,
    episodes: int,
    load: bool = True,
    advance: Callable[[str, float], None] = lambda doing, by: None,
) -> Score:
    """Runs a policy on episodes 0 .. N - 1 of the held-out ones. task: or its name. name: as policies.policy takes
    it; it gets the observation and nothing else. load: without it, load cells read 0. advance: called with progress,
    in episodes.

    Raises UnknownNameError and InvalidValueError."""
    task = learning_task(task) if isinstance(task, str) else task
    whole_number("episodes", episodes, 1)
    at_once = 1 if "plant" in task.keywords else _AT_ONCE
    with closing(task.make(min(episodes, at_once))) as env:
        acting = _Unseeded(policy(env, name), load)
        found = rollout(env, episodes, HELD_OUT, acting, advance=advance)
    low, high = wilson(found.successes, episodes)
    return Score(
        episodes,
        found.successes,
        low,
        high,
        found.mean_return,
        found.steps / episodes * STEP,
        found.digest,
    )


def wilson(successes: int, count: int) -> tuple[float, float]:
    """The 95 % interval of a share. Wilson E. B., Probable Inference, the Law of Succession, and Statistical Inference,
    J. Am. Stat. Assoc. 22 (1927) 209."""
    share, z2 = successes / count, _Z**2
    middle = (share + z2 / (2 * count)) / (1 + z2 / count)
    half = _Z / (1 + z2 / count) * math.sqrt(share * (1 - share) / count + z2 / (4 * count**2))
    return max(middle - half, 0.0), min(middle + half, 1.0)


class _Unseeded:
    """A policy that gets no seeds of the episodes and, without load cells, no forces."""

    def __init__(self, inner: Policy, load: bool) -> None:
        self._inner, self._load, self._begun = inner, load, 0

    def restart(self, rows: Sequence[int] | np.ndarray, seeds: Sequence[int]) -> None:
        """Begins episodes; their numbers stand for their seeds."""
        del seeds
        self._inner.restart(rows, [self._begun + at for at in range(len(rows))])
        self._begun += len(rows)

    def action(self, observation: Any) -> np.ndarray:
        """The policy's."""
        if not self._load:
            observation = {**observation, "force": np.zeros_like(observation["force"])}
        return self._inner.action(observation)
