"""Grasp-v0 whose boxes have any size and are touched anywhere, beside Grasp-v0 as shipped and beside the same draws
with heat in the middle of each face: speed, stalls and memory over many short episodes.

Boxes that stand off the middle and turned cost MuJoCo more, whatever heat does; the same draws tell heat from that."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

from thermograsp.bench.speed.measure import ID
from thermograsp.envs import EVERYTHING

_SECONDS = 1.0  # of an episode
_STEPS = 50  # control steps of a block, as long as an episode
_PLACEMENT = (0.008, 10.0)  # m and degree
_PARTS = 10


@dataclass(frozen=True, slots=True)
class Drawn:
    """Times of `num_envs` environments through `episodes` episodes of `seconds` s, in which everything is drawn: sizes
    from a continuous range, where the object stands and so where it is touched. plain and drawn: s of CPU per
    environment and control step, resets among them (means after the first block). ratio: plain time over drawn, median
    and quartiles of the blocks; heat_ratio and heat_quartiles: the same of equal draws whose heat enters in the middle
    of each face, over those where it enters as they are touched. longest: s of CPU, a control step of all drawn
    environments at most, and of plain ones. memory: bytes of the process after each tenth of the episodes, empty where
    the system does not tell."""

    num_envs: int
    episodes: int
    seconds: float
    plain: float
    drawn: float
    ratio: float
    quartiles: tuple[float, float]
    heat_ratio: float
    heat_quartiles: tuple[float, float]
    longest: tuple[float, float]
    memory: tuple[int, ...]


def compare_drawn(num_envs: int, episodes: int, seed: int, shown: Callable[[float], None]) -> Drawn:
    """Blocks of an episode each, in random order. Actions are random, but close the gripper for half of the
    time. shown: called with each block's share of the whole."""
    rng = np.random.default_rng(seed)
    draws = {"randomize": EVERYTHING, "placement": _PLACEMENT}
    envs = [
        _environment(num_envs),
        _environment(num_envs, **draws, anywhere=True),
        _environment(num_envs, **draws, anywhere=False),
    ]
    for env in envs:
        env.reset(seed=seed)
    blocks = max(episodes // num_envs, _PARTS)
    times, longest, memory = np.zeros((blocks + 1, len(envs))), np.zeros((blocks + 1, len(envs))), []
    for block in range(blocks + 1):
        actions = rng.uniform(-1.0, 1.0, (_STEPS, num_envs, 3)).astype(np.float32)
        actions[: _STEPS // 2, :, 0] = -1.0
        for which in rng.permutation(len(envs)):
            spent = [_timed(envs[which], action) for action in actions]
            times[block, which], longest[block, which] = sum(spent), max(spent)
        if block and block % (blocks // _PARTS) == 0 and len(memory) < _PARTS:
            memory += _resident()
        shown(1 / (blocks + 1))
    for env in envs:
        env.close()
    plain, other, even = times[1:].T
    low, middle, high = np.percentile(plain / other, [25, 50, 75]).tolist()
    heat_low, heat_middle, heat_high = np.percentile(even / other, [25, 50, 75]).tolist()
    slowest = longest[1:].max(axis=0)
    mean = times[1:].mean(axis=0) / (_STEPS * num_envs)
    return Drawn(
        num_envs,
        blocks * num_envs,
        _SECONDS,
        float(mean[0]),
        float(mean[1]),
        middle,
        (low, high),
        heat_middle,
        (heat_low, heat_high),
        (float(slowest[1]), float(slowest[0])),
        tuple(memory),
    )


def _environment(num_envs: int, **more: Any) -> Any:
    return gymnasium.make_vec(
        ID,
        num_envs=num_envs,
        vectorization_mode="vector_entry_point",
        seconds=_SECONDS,
        **more,
    )


def _timed(env: Any, action: np.ndarray) -> float:
    """s of CPU of a step."""
    begun = time.process_time()
    env.step(action)
    return time.process_time() - begun


def _resident() -> list[int]:
    """Bytes of this process in memory, none where Linux does not tell."""
    status = Path("/proc/self/status")
    if not status.is_file():
        return []
    return [1024 * int(status.read_text().partition("VmRSS:")[2].split()[0])]
