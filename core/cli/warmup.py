"""`thermograsp warmup`: compiles and builds ahead what the shipped environments need."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from typing import Any

from thermograsp.cli.shared import Output, load_mujoco

NAME = "warmup"
HELP = "Compile and build in advance what the shipped environments need, for an image or a cluster's shared cache."

_CLOSING = 50  # control steps, in which the fingers meet what lies between them
_MESH = "mug_of_coffee"
_SCENE = """<mujoco><option gravity="0 0 0"/>
  <asset><mesh name="octahedron" scale=".02 .02 .02" vertex="1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1"/></asset>
  <worldbody>
  <body name="thing"><geom {geom}/></body>
  <body name="tip" pos="0 0 .0254">
    <joint type="slide" axis="0 0 -1" damping="20"/><geom type="box" size=".01 .01 .005"/>
  </body></worldbody></mujoco>"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """It takes none."""
    del parser


def run(args: argparse.Namespace) -> int:
    """Does one stage after the other and prints how long each took."""
    output = Output(args.json)
    load_mujoco(output)
    chosen = stages()
    done = []
    with output.progress(len(chosen)) as advance:
        for name, work in chosen.items():
            advance(name, 0)
            begun = time.perf_counter()
            work()
            done.append({"stage": name, "seconds": time.perf_counter() - begun})
            advance(name, 1)
    output.table(("stage", "s"), [(one["stage"], f"{one['seconds']:.1f}") for one in done])
    output.document({"stages": done})
    return 0


def stages() -> dict[str, Callable[[], None]]:
    """What each stage is called and does."""
    from thermograsp.thermal import SEED_MATERIALS

    return {
        "Grasp-v0 on every material": lambda: _close("Grasp-v0", SEED_MATERIALS),
        "Grasp-v0 in O mode": lambda: _close("Grasp-v0", SEED_MATERIALS, mode="O"),
        "Identify-v0": lambda: _close("Identify-v0"),
        "Sort-v0": lambda: _close("Sort-v0"),
        "many at once": lambda: _close("Grasp-v0", many=2),
        "maps of pressure and temperature": lambda: _close(
            "Grasp-v0", taxels=(4, 4), face_temperature=(4, 4)
        ),
        "an object of any shape": lambda: _close("Grasp-v0", objects=_MESH),
        "the same in networks": lambda: _close("Grasp-v0", objects=_MESH, anywhere=False),
        "ThermalTouch on a ball": lambda: _touch('type="sphere" size=".02"'),
        "ThermalTouch on a mesh": lambda: _touch('type="mesh" mesh="octahedron"'),
    }


def _touch(geom: str) -> None:
    """Presses a fingertip of a scene of its own on a geom of that kind."""
    import mujoco as _mujoco

    from thermograsp.touch import Fingertip, ThermalTouch

    mujoco: Any = _mujoco  # it ships no type stubs for its compiled names
    model = mujoco.MjModel.from_xml_string(_SCENE.format(geom=geom))
    data = mujoco.MjData(model)
    tip = Fingertip("tip", (0, 0, -0.005), (0, 0, -1), (0.02, 0.02))
    touch = ThermalTouch(model, fingertips={"tip": tip}, objects={"thing": "steel"})
    data.qfrc_applied[0] = 5.0
    while not any(touch.reading.touching) and data.time < 1.0:
        mujoco.mj_step(model, data)
        touch.update(data)


def _close(env_id: str, materials: Sequence[str] = (), many: int = 0, **config: Any) -> None:
    """Makes an environment, resets it on each material (none: on what it draws), and closes the fingers. many: how many
    environments a vector of them has, 0 for a single one."""
    import gymnasium
    import numpy as np

    env: Any = (
        gymnasium.make_vec(f"thermograsp/{env_id}", many, "vector_entry_point", **config)
        if many
        else gymnasium.make(f"thermograsp/{env_id}", **config)
    )
    try:
        env.reset(seed=0)
        for name in materials:
            env.reset(options={"material": name})
        shape = env.action_space.shape
        assert shape is not None
        action = np.zeros(shape, np.float32)
        action[..., 0] = 1.0 if env_id == "Identify-v0" else -1.0  # closes the fingers
        for _ in range(_CLOSING):
            _, _, terminated, truncated, _ = env.step(action)
            if np.all(terminated) or np.all(truncated):
                break
    finally:
        env.close()
