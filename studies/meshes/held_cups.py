"""How a cup's wall is felt in environments: K of drop after 2, 6 and 12 s, of 12 K, of a solid cylinder and of empty
cups.

Two fingertips hold each 40 mm wide and high, by 10 N through the usual skin.

    python studies/meshes/held_cups.py
    python studies/meshes/held_cups.py --material glass --json
"""

from __future__ import annotations

import argparse
import json
import tempfile
from pathlib import Path

import numpy as np
import trimesh

from thermograsp.envs import GraspBatch, GraspTask, ObjectSpec, action_of

_RADIUS, _HEIGHT, _BASE = 0.02, 0.04, 0.003  # m
WALLS = {"solid": _RADIUS, "wall 2.5 mm": 0.0025, "wall 0.6 mm": 0.0006}
TIMES, _FORCE = (2.0, 6.0, 12.0), 10.0  # s, N
ENDLESS = GraspTask(hold_seconds=1e3, seconds=1e3)


def drops(wall: float, name: str, folder: Path) -> list[float]:
    """K after TIMES."""
    inside = _RADIUS - wall
    hollow = [[inside, _HEIGHT], [inside, _BASE], [0.0, _BASE]] if inside > 0 else [[0.0, _HEIGHT]]
    outline = [[0.0, 0.0], [_RADIUS, 0.0], [_RADIUS, _HEIGHT], *hollow]
    file = folder / f"{1e6 * wall:.0f}.stl"  # whose shape is read once
    trimesh.creation.revolve(outline, sections=64).export(file)
    cup = ObjectSpec(shape="mesh", mesh=str(file), mass=0.05, friction=0.8)
    batch = GraspBatch(1, objects=cup, material=name, task=ENDLESS, placement=(0.0, 0.0))
    batch.reset([0], [np.random.default_rng(0)])
    found: list[float] = []
    while np.count_nonzero(found) < TIMES[-1] / batch.dt:
        info = batch.step(action_of(0.0, _FORCE, 0.0)[None]).info(0)
        found.append(float(info["temperature_drop"][0]))
    touched = [drop for drop in found if drop]
    return [round(touched[round(time / batch.dt) - 1], 3) for time in TIMES]


def main() -> None:
    """See above."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--material", default="ceramic")
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        found = {name: drops(wall, given.material, Path(folder)) for name, wall in WALLS.items()}
    if given.json:
        print(json.dumps(found))
        return
    for name, kelvin in found.items():
        print(f"{name:12}" + "".join(f"{drop:8.2f}" for drop in kelvin))


if __name__ == "__main__":
    main()
