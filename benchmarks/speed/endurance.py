"""Whether a control step grows dearer with the length of an episode or the number of touches."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from thermograsp.bench.speed.bare import BareBatch, inputs_of
from thermograsp.envs import GraspBatch, GraspTask, action_of
from thermograsp.envs.limits import SUBSTEPS

_PERIOD = 50  # control steps of opening and closing once
_BINS = 20


@dataclass(frozen=True, slots=True)
class Endurance:
    """One episode of `steps` control steps with `touches` touches. relative: (20,) CPU time of an environment's step
    over the bare one's, in twenty parts of the episode, oldest first; the bare batch is fed the same."""

    steps: int
    touches: int
    relative: tuple[float, ...]

    @property
    def growth(self) -> float:
        """Mean of the last quarter over that of the first."""
        quarter = _BINS // 4
        return float(np.mean(self.relative[-quarter:]) / np.mean(self.relative[:quarter]))


def endure(steps: int, seed: int, shown: Callable[[], None]) -> Endurance:
    """Opens and closes on a box once a second, without an end. steps: a multiple of 1,000. shown: called after each of
    the twenty parts."""
    batch = GraspBatch(1, task=GraspTask(seconds=1e9), material="aluminium")
    rng = np.random.default_rng(seed)
    batch.reset([0], [rng])
    mechanics = batch.plant.mechanics  # pyright: ignore[reportAttributeAccessIssue]
    bare = BareBatch(mechanics, 1, SUBSTEPS)
    bare.copy(mechanics, mechanics.state())
    opened = action_of(opening=0.06, force_limit=10.0, lift_rate=0.0)[None]
    closed = action_of(opening=0.0, force_limit=10.0, lift_rate=0.0)[None]
    for action in [closed] * _PERIOD + [opened] * _PERIOD:  # compiles, and fills caches
        batch.step(action)
    bare.copy(mechanics, mechanics.state())
    touches, relative = 0, []
    for _ in range(_BINS):
        with_touch, alone = 0.0, 0.0
        for k in range(steps // _BINS):
            action = closed if k % _PERIOD < _PERIOD // 2 else opened
            begun = time.process_time()
            batch.step(action)
            with_touch += time.process_time() - begun
            inputs = inputs_of(mechanics.model, mechanics.state())
            begun = time.process_time()
            bare.step(inputs)
            alone += time.process_time() - begun
            assert batch.reading is not None
            touches += sum(kind == "touch" for kind, _ in batch.reading.truth["events"][0])
        relative.append(with_touch / alone)
        shown()
    return Endurance(steps, touches, tuple(relative))
