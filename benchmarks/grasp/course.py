"""The grasp that solver settings are compared on: close with 10 N, lift, shake up and down, hold.

Shapes: K control steps, B placements, S substeps in a control step, T = 2 fingertips.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import mujoco
import numpy as np
import trimesh

from thermograsp.envs import Mechanics, ObjectSpec, SolverSettings
from thermograsp.errors import InvalidValueError
from thermograsp.files import atomic_write
from thermograsp.thermal import material

MATERIAL = "aluminium"
FORCE = 10.0  # N
PERIOD = 0.02  # s, of a control step
SIDE = 0.04  # m, of every object between the pads
RATE = 0.05  # m/s, of lifting and shaking
PHASES = {"close": 60, "lift": 30, "settle": 15, "shake": 100, "hold": 30}  # control steps
_HALF_SHAKE = (
    6  # control steps between reversals: 4.2 Hz, all the while at the lift's largest acceleration, 1 m/s2
)
_SCATTER = (0.002, 2.0)  # m and degree, where objects stand: the environments' default


@dataclass(frozen=True, slots=True)
class Grasp:
    """What B grasps of one shape went through.

    normal (K, B, S, T) N, 0 where nothing touches. centroid (K, B, S, T, 2) m on the pads. place (K, B, T, 3) m, the
    pads' middles in the object's frame. offset (K, B, 3) m: the object from the gripper, world axes. height (K, B) m:
    the object's centre over the table. failed (B,): MuJoCo warned. seconds (K,): CPU time of the thread, of one grasp.
    """

    normal: np.ndarray
    centroid: np.ndarray
    place: np.ndarray
    offset: np.ndarray
    height: np.ndarray
    failed: np.ndarray
    seconds: np.ndarray


def duration() -> float:
    """s, of the whole course."""
    return PERIOD * sum(PHASES.values())


def end_of(phase: str) -> int:
    """Number of control steps up to the end of a phase."""
    names = list(PHASES)
    return sum(PHASES[name] for name in names[: names.index(phase) + 1])


def lift_rates() -> np.ndarray:
    """(K,) m/s, what is commanded of the lift."""
    shaking = np.where(np.arange(PHASES["shake"]) // _HALF_SHAKE % 2, RATE, -RATE)
    still = {name: np.zeros(steps) for name, steps in PHASES.items()}
    return np.concatenate(list((still | {"lift": np.full(PHASES["lift"], RATE), "shake": shaking}).values()))


def shapes(folder: Path) -> dict[str, ObjectSpec]:
    """Box, cylinder, sphere and a mesh (a hexagonal nut, flats to the pads, written into `folder`), of aluminium."""
    nut = trimesh.creation.annulus(0.25 * SIDE, SIDE / np.sqrt(3), SIDE, sections=6)
    nut.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (0, 0, 1)))
    file = folder / "nut.stl"
    with atomic_write(file) as temporary:
        nut.export(temporary, file_type="stl")
    metal = material(MATERIAL)
    common = {"size": (SIDE,) * 3, "density": metal.density, "friction": metal.friction}
    return {
        "box": ObjectSpec(**common),
        "cylinder": ObjectSpec(shape="cylinder", **common),
        "sphere": ObjectSpec(shape="sphere", **common),
        "mesh": ObjectSpec(shape="mesh", mesh=str(file), **common),
    }


def placements(spec: ObjectSpec, count: int, rng: np.random.Generator) -> list[ObjectSpec]:
    """The object at `count` places near the middle, turned a little."""
    reach, turn = _SCATTER
    return [
        replace(spec, position=(x * reach, y * reach), yaw=np.deg2rad(turn * angle))
        for x, y, angle in rng.uniform(-1.0, 1.0, (count, 3))
    ]


def grasp(settings: SolverSettings, placed: list[ObjectSpec]) -> Grasp:
    """One course of every placement. Raises InvalidValueError unless substeps fill a control step."""
    substeps = round(PERIOD / settings.timestep)
    if abs(substeps * settings.timestep - PERIOD) > 1e-9:
        raise InvalidValueError(f"time step {settings.timestep} s: it must divide {PERIOD} s")
    count = len(placed)
    mechanics = Mechanics((placed[0],), count, settings=settings)
    mechanics.reset(objects=[(spec,) for spec in placed])
    kept: dict[str, list[np.ndarray]] = {
        "normal": [],
        "centroid": [],
        "place": [],
        "offset": [],
        "height": [],
    }
    seconds = []
    with _silent():
        for rate in lift_rates():
            begun = time.thread_time()
            record = mechanics.step(np.zeros(count), np.full(count, FORCE), np.full(count, rate), substeps)
            seconds.append((time.thread_time() - begun) / count)
            position = record.object_pose[:, -1, 0, :3]
            lifted = np.stack([np.zeros(count), np.zeros(count), record.height[:, -1]], axis=-1)
            kept["normal"].append(np.where(record.touching[..., 0], record.force[..., 0, 0], 0.0))
            kept["centroid"].append(record.centroid[:, :, :, 0])
            kept["place"].append(record.place[:, -1, :, 0])
            kept["offset"].append(position - lifted)
            kept["height"].append(position[:, 2])
    arrays = {name: np.array(rows) for name, rows in kept.items()}
    return Grasp(**arrays, failed=mechanics.failed, seconds=np.array(seconds))


@contextmanager
def _silent() -> Iterator[None]:
    """MuJoCo's warnings go neither to the terminal nor to a file; Mechanics reports them."""
    before = mujoco.MjLogConfig.get()
    quiet = mujoco.MjLogConfig.get()
    quiet.logto_console, quiet.logto_file = False, False
    quiet.set()
    try:
        yield
    finally:
        before.set()
