"""A simulation with touch beside the same one without, in turns of one process."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np


class Pair(NamedTuple):
    """The same scene without heat and with it. bare and touch: take `steps` steps each, of the same physics. same:
    whether the two are still where they should be, beside each other. unit: what a step is."""

    name: str
    unit: str
    bare: Callable[[int], None]
    touch: Callable[[int], None]
    same: Callable[[], bool]


@dataclass(frozen=True, slots=True)
class SceneSpeed:
    """Times of a scene. unit: what a step is, all worlds together. bare and touch: s of CPU per step (medians). ratio:
    bare time over that with touch, median and quartiles of the blocks' own. same: the physics ended every block with
    the same bits."""

    scene: str
    unit: str
    bare: float
    touch: float
    ratio: float
    quartiles: tuple[float, float]
    blocks: int
    same: bool


def timed(
    pair: Pair, blocks: int, steps: int, rng: np.random.Generator, shown: Callable[[], None]
) -> SceneSpeed:
    """Times blocks of so many steps, bare and with touch in random order, after one that is not counted. By CPU time,
    as other processes of the machine take turns with this one. shown: called after each block."""
    times = np.zeros((blocks + 1, 2))
    same = True
    for block in range(blocks + 1):
        for which in rng.permutation(2):
            begun = time.process_time()
            (pair.bare, pair.touch)[which](steps)
            times[block, which] = (time.process_time() - begun) / steps
        same = same and pair.same()
        shown()
    bare, touch = times[1:].T
    low, middle, high = (float(x) for x in np.percentile(bare / touch, [25, 50, 75]))
    return SceneSpeed(
        pair.name,
        pair.unit,
        float(np.median(bare)),
        float(np.median(touch)),
        middle,
        (low, high),
        blocks,
        same,
    )
