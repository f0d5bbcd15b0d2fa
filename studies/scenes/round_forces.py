"""How far environments are from ThermalTouch on balls, rods and a ball's mesh at three forces, with anywhere=False and
as shipped.

    python studies/scenes/round_forces.py
    python studies/scenes/round_forces.py --materials steel wood --json

Two fingertips hold a ball of 40 mm or an upright rod of 30 mm in the middle; the drop counts two seconds after the
touch, of a difference of 12 K.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import argparse
import json
import tempfile
from itertools import product
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import trimesh

from thermograsp import Fingertip, ThermalTouch
from thermograsp.envs import GraspBatch, GraspTask, ObjectSpec, action_of

SHAPES = {
    "ball": ObjectSpec(shape="sphere", size=(0.04, 0.04, 0.04)),
    "rod": ObjectSpec(shape="cylinder", size=(0.03, 0.03, 0.05)),
}
GEOMS = {"ball": 'type="sphere" size=".02"', "rod": 'type="cylinder" size=".015 .025"'}
MESH = "ball's mesh"
FORCES, SECONDS = (3.0, 8.0, 25.0), 2.0
ENDLESS = GraspTask(hold_seconds=1e3, seconds=1e3)


def with_mesh(folder: Path) -> None:
    """Adds the ball's mesh to SHAPES and GEOMS, a file in that folder."""
    file = folder / "ball.stl"
    trimesh.creation.icosphere(subdivisions=4, radius=0.02).export(file)
    SHAPES[MESH] = ObjectSpec(shape="mesh", mesh=str(file))
    GEOMS[MESH] = 'type="mesh" mesh="ball"'


def environment(shape: str, name: str, skin: str | None, force: float, anywhere: Any) -> float:
    """K of drop."""
    batch = GraspBatch(
        1,
        material=name,
        task=ENDLESS,
        objects=SHAPES[shape],
        placement=(0.0, 0.0),
        skin=skin,
        air=0.0,
        anywhere=anywhere,
    )
    batch.reset([0], [np.random.default_rng(0)])
    drops = [0.0]
    while np.count_nonzero(drops) < SECONDS / batch.dt:
        step = batch.step(action_of(0.0, force, 0.0)[None])
        drops.append(float(step.info(0)["temperature_drop"][0]))
    return drops[-1]


def touched(shape: str, name: str, skin: str | None, force: float) -> float:
    """The same of ThermalTouch."""
    away = SHAPES[shape].width / 2 + 0.0041
    tips = "".join(
        f'<body pos="{way * away} 0 0"><joint name="{tip}" type="slide" axis="{-way} 0 0" damping="20"/>'
        f'<geom name="{tip}" type="box" size=".004 .01 .01" mass=".05" friction="0 0 0"/></body>'
        for way, tip in ((1, "right"), (-1, "left"))
    )
    asset = f'<asset><mesh name="ball" file="{SHAPES[shape].mesh}"/></asset>' if shape == MESH else ""
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco>{asset}<option gravity="0 0 0"/><worldbody><body name="thing"><geom {GEOMS[shape]}/></body>{tips}'
        '</worldbody><actuator><motor joint="right"/><motor joint="left"/></actuator></mujoco>'
    )
    data, began = mujoco.MjData(model), None
    touch = ThermalTouch(
        model,
        fingertips={tip: Fingertip(tip, skin=skin) for tip in ("right", "left")},
        objects={"thing": name},
        air=0.0,
        chain="ideal",
    )
    data.ctrl[:] = force
    while began is None or data.time < began + SECONDS:
        mujoco.mj_step(model, data)
        touch.update(data)
        began = data.time if began is None and touch.reading.force[0] > 0 else began
    return float(touch.reading.temperature_drop[0])


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--materials", nargs="+", default=["aluminium", "glass"])
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        with_mesh(Path(folder))
        told(given)


def told(given: argparse.Namespace) -> None:
    """The table."""
    rows = []
    for shape, name in product(SHAPES, given.materials):
        for skin, force in product(("filled_silicone", None), FORCES):
            ways = [environment(shape, name, skin, force, anywhere) for anywhere in (False, "auto")]
            row = (f"{shape} of {name}, {skin or 'bare'}", force, *ways, touched(shape, name, skin, force))
            rows.append(
                dict(zip(("object", "force_N", "middle_K", "shipped_K", "touch_K"), row, strict=True))
            )
            if not given.json:
                print(
                    "{:40}{:4.0f} N  anywhere=False {:5.2f}  as shipped {:5.2f}  ThermalTouch {:5.2f} K".format(
                        *row
                    )
                )
    if given.json:
        print(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
