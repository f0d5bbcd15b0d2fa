"""Ways to run many Grasp-v0 at once: the native vector environment, and Gymnasium's around single ones."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy as np

from thermograsp.bench.speed.measure import ID

MODES: dict[str, dict[str, Any]] = {
    "native": {"vectorization_mode": "vector_entry_point"},
    "native, all threads": {"vectorization_mode": "vector_entry_point", "threads": 0},
    "SyncVectorEnv": {"vectorization_mode": "sync"},
    "AsyncVectorEnv": {"vectorization_mode": "async"},
}
_WARM = 20  # control steps


@dataclass(frozen=True, slots=True)
class ModeSpeed:
    """The speed of one of Gymnasium's vector modes. seconds: wall clock per environment and control step (median over
    blocks). ratio: the native mode's over it, the median of the blocks. same: rewards and observations equal the native
    mode's, bit for bit."""

    mode: str
    num_envs: int
    seconds: float
    ratio: float
    same: bool


def compare(
    num_envs: int, blocks: int, steps: int, seed: int, shown: Callable[[str], None]
) -> list[ModeSpeed]:
    """Steps all modes with the same seeds and random actions, block by block in random order. By the wall clock:
    AsyncVectorEnv works in other processes. shown: called with what is being done."""
    rng = np.random.default_rng(seed)
    envs = {}
    for name, options in MODES.items():
        shown(f"starting {num_envs} environments, {name}")
        envs[name] = gymnasium.make_vec(ID, num_envs=num_envs, **options)
        envs[name].reset(seed=seed)
    times: dict[str, list[float]] = {name: [] for name in MODES}
    same = dict.fromkeys(MODES, True)
    for block in range(blocks + 1):
        count = steps if block else _WARM
        actions = rng.uniform(-1.0, 1.0, (count, num_envs, 3)).astype(np.float32)
        last: dict[str, Any] = {}
        for i in rng.permutation(len(MODES)):
            name = list(MODES)[i]
            shown(name)
            begun = time.perf_counter()
            for action in actions:
                last[name] = envs[name].step(action)
            times[name].append((time.perf_counter() - begun) / (count * num_envs))
        for name in MODES:
            same[name] &= _equal(last[name], last["native"])
    for env in envs.values():
        env.close()
    found = {name: np.array(values[1:]) for name, values in times.items()}
    return [
        ModeSpeed(
            name,
            num_envs,
            float(np.median(found[name])),
            float(np.median(found["native"] / found[name])),
            same[name],
        )
        for name in MODES
    ]


def _equal(step: Any, other: Any) -> bool:
    observation, expected = step[0], other[0]
    return np.array_equal(step[1], other[1]) and all(
        np.array_equal(observation[k], expected[k]) for k in expected
    )
