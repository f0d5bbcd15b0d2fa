"""What a control step costs by the object that is held and how its heat is known: us of processor time for each of 16
environments of Grasp-v0, resets and new places among them.

Episodes last 1 s, actions are random, and grippers close for half of the time. The environments step in turn, block by
block; the median of the blocks counts.

    python studies/speed/held_objects.py
    python studies/speed/held_objects.py --blocks 40 --json
"""

from __future__ import annotations

import argparse
import json
import time
from typing import Any, Literal

import gymnasium
import numpy as np

import thermograsp  # noqa: F401
from thermograsp.envs import ObjectSpec

_ENVS, _STEPS = 16, 50  # of a block, as long as an episode
Shape = Literal["box", "cylinder", "sphere"]
_SHAPES: dict[Shape, tuple[float, float, float]] = {
    "box": (0.04, 0.04, 0.04),
    "cylinder": (0.03, 0.03, 0.06),
    "sphere": (0.04, 0.04, 0.04),
}
_WAYS: dict[str, dict[str, Any]] = {
    "anywhere=False": {"anywhere": False},
    "anywhere=True": {"anywhere": True},
    "and a pad": {"anywhere": True, "surround": "silicone"},
}


def measured(blocks: int, seed: int) -> dict[str, dict[str, float]]:
    """us a step, by shape and way."""
    rng = np.random.default_rng(seed)
    envs: dict[tuple[Shape, str], Any] = {
        (shape, way): _environment(shape, way) for shape in _SHAPES for way in _WAYS
    }
    times: dict[tuple[Shape, str], list[float]] = {each: [] for each in envs}
    for env in envs.values():
        env.reset(seed=seed)
    for block in range(blocks + 1):
        actions = rng.uniform(-1.0, 1.0, (_STEPS, _ENVS, 3)).astype(np.float32)
        actions[: _STEPS // 2, :, 0] = -1.0
        for each, env in envs.items():
            begun = time.process_time()
            for action in actions:
                env.step(action)
            if block:  # the first compiles
                times[each].append((time.process_time() - begun) / (_STEPS * _ENVS))
    for env in envs.values():
        env.close()
    return {
        shape: {way: round(1e6 * float(np.median(times[shape, way])), 1) for way in _WAYS}
        for shape in _SHAPES
    }


def _environment(shape: Shape, way: str) -> Any:
    return gymnasium.make_vec(
        "thermograsp/Grasp-v0",
        num_envs=_ENVS,
        vectorization_mode="vector_entry_point",
        seconds=1.0,
        objects=ObjectSpec(shape=shape, size=_SHAPES[shape], material="glass"),
        **_WAYS[way],
    )


def main() -> None:
    """See above."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--blocks", type=int, default=20, help="episodes of each environment (default: 20)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    if given.blocks < 1:
        parser.error(f"--blocks must be 1 or more, got {given.blocks}")
    found = measured(given.blocks, given.seed)
    if given.json:
        print(json.dumps(found))
        return
    print(f"{'us a step':10}" + "".join(f"{way:>16}" for way in _WAYS))
    for shape, ways in found.items():
        print(f"{shape:10}" + "".join(f"{ways[way]:16.0f}" for way in _WAYS))


if __name__ == "__main__":
    main()
