"""Scenes with heat by thermograsp.touch, each beside the same scene without: a plain loop of mj_step with a
ThermalTouch, many worlds that record their contact sensors, heat inside MuJoCo's step, and gymnasium-robotics' Fetch.

`python -m thermograsp.bench.speed.scenes` measures them alone, and only those for which everything is installed."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np

from thermograsp import ThermalTouch
from thermograsp.bench.speed import fetch
from thermograsp.bench.speed.beside import Pair, SceneSpeed, timed
from thermograsp.errors import MissingDependencyError
from thermograsp.touch import install, prepare

_FINGERS = ("thumb", "index", "middle")
_PADS = {name: f"{name}_pad" for name in _FINGERS}
_CAN = {"can": "aluminium"}
_FORCE = 8.0  # N of each finger
_WORLDS = 64
_CALL = 10  # substeps of one call, where a scene's steps are taken by calls
_SETTLE = 500  # substeps before the first block: fingers have closed, compiled code is there


def scenes(quick: bool, seed: int, shown: Callable[[str, float], None]) -> list[SceneSpeed]:
    """Times of every scene for which all is installed. shown: called with what is being done, and with the share of the
    whole by which it advanced."""
    rng, found = np.random.default_rng(seed), []
    for name, (made, blocks, steps) in _SCENES.items():
        if quick:
            blocks, steps = 2, 5
        shown(name, 0.0)
        try:
            pair = made(name)
        except (ImportError, MissingDependencyError):
            shown(f"{name}: not installed", 1 / len(_SCENES))
            continue
        share = 1 / len(_SCENES) / (blocks + 1)
        found.append(timed(pair, blocks, steps, rng, lambda what=name, part=share: shown(what, part)))
    return found


def _loop(name: str) -> Pair:
    """mj_step, and the update after it."""
    model = _hand().compile()
    data, bare = mujoco.MjData(model), mujoco.MjData(model)
    touch = ThermalTouch(model, fingertips=_PADS, objects=_CAN, seed=0)
    data.ctrl[:], bare.ctrl[:] = _FORCE, _FORCE

    def alone(steps: int) -> None:
        for _ in range(steps):
            mujoco.mj_step(model, bare)

    def with_touch(steps: int) -> None:
        for _ in range(steps):
            mujoco.mj_step(model, data)
            touch.update(data)

    alone(_SETTLE)
    with_touch(_SETTLE)
    return Pair(name, "mj_step", alone, with_touch, lambda: np.array_equal(data.qpos, bare.qpos))


def _worlds(name: str) -> Pair:
    """A batch that records its contact sensors for the update, beside one of the scene without the sensors."""
    model = prepare(_hand(), _PADS, _CAN)
    touch = ThermalTouch(model, fingertips=_PADS, objects=_CAN, seed=0, worlds=_WORLDS)
    record = {"sensordata": np.zeros((_WORLDS, _CALL, model.nsensordata))}  # the same room for every call

    def recorded(batch: Any) -> None:
        batch.rollout(nstep=_CALL, record=("sensordata",), out=record)
        touch.update(record["sensordata"])

    return _batches(name, model, recorded)


def _worlds_inside(name: str) -> Pair:
    """A batch with heat in its model, beside one of the scene without."""
    heated = install(_hand(), fingertips=_PADS, objects=_CAN)
    return _batches(name, heated, lambda batch: batch.step(nstep=_CALL))


def _batches(name: str, model: mujoco.MjModel, call: Callable[[Any], object]) -> Pair:
    """A batch of that model that is stepped by `call`, beside one of the plain scene."""
    import mujoco.batch  # from MuJoCo 4.0 on

    feeling, alone = (mujoco.batch.Batch(each, _WORLDS, 1) for each in (model, _hand().compile()))
    positions = [each.bind("qpos") for each in (feeling, alone)]
    for each in (feeling, alone):
        each.bind("ctrl")[:] = _forces()

    def bare(steps: int) -> None:
        for _ in range(steps):
            alone.step(nstep=_CALL)

    def with_touch(steps: int) -> None:
        for _ in range(steps):
            call(feeling)

    bare(_SETTLE // _CALL)
    with_touch(_SETTLE // _CALL)
    return Pair(
        name, f"{_CALL} substeps", bare, with_touch, lambda: np.array_equal(positions[0], positions[1])
    )


def _forces() -> np.ndarray:
    """N of all fingers of each world."""
    return np.linspace(0.5 * _FORCE, 1.5 * _FORCE, _WORLDS)[:, None]


def _inside(name: str) -> Pair:
    """The environment's gripper round its box, with heat in the model."""
    from thermograsp.envs import ObjectSpec  # which need MuJoCo 4.0
    from thermograsp.envs.mechanics import scene_spec

    words: dict[str, Any] = {
        "fingertips": {"left": "pad_left", "right": "pad_right"},
        "objects": {"object": "aluminium"},
    }
    models = install(scene_spec((ObjectSpec(),)), **words), scene_spec((ObjectSpec(),)).compile()
    heated, alone = (mujoco.MjData(model) for model in models)
    for model in models:
        model.actuator("grip").forcerange[:] = -_FORCE, _FORCE
    (with_heat, without) = models

    def bare(steps: int) -> None:
        for _ in range(steps):
            mujoco.mj_step(without, alone, _CALL)

    def with_touch(steps: int) -> None:
        for _ in range(steps):
            mujoco.mj_step(with_heat, heated, _CALL)

    bare(_SETTLE // _CALL)
    with_touch(_SETTLE // _CALL)
    return Pair(name, f"{_CALL} substeps", bare, with_touch, lambda: np.array_equal(heated.qpos, alone.qpos))


def _hand() -> mujoco.MjSpec:
    """Three fingers of one joint round a can on a table, a motor each."""
    fingers, motors = [], []
    for number, name in enumerate(_FINGERS):
        angle = 2 * math.pi * number / len(_FINGERS)
        x, y = 0.07 * math.cos(angle), 0.07 * math.sin(angle)
        fingers.append(f"""
          <body name="{name}" pos="{x} {y} .05" euler="0 0 {math.degrees(angle)}">
            <joint name="{name}" type="slide" axis="-1 0 0" damping="20" armature=".05"/>
            <geom name="{name}_pad" type="box" size=".004 .01 .01" mass=".02"/>
          </body>""")
        motors.append(f'<motor joint="{name}"/>')
    return mujoco.MjSpec.from_string(f"""
      <mujoco>
        <option timestep=".002" integrator="implicitfast" cone="elliptic" impratio="10"/>
        <worldbody>
          <geom type="box" pos="0 0 -.01" size=".3 .3 .01"/>
          <body name="can" pos="0 0 .05"><freejoint/><geom name="can" type="cylinder" size=".03 .05" mass=".3"/></body>
          {"".join(fingers)}
        </worldbody>
        <actuator>{"".join(motors)}</actuator>
      </mujoco>""")


_SCENES: dict[str, tuple[Callable[[str], Pair], int, int]] = {
    "three fingers, a loop of mj_step": (_loop, 40, 1000),
    "three fingers, 64 worlds": (_worlds, 24, 10),
    "three fingers, 64 worlds, inside mj_step": (_worlds_inside, 24, 10),
    "Grasp-v0's scene, inside mj_step": (_inside, 40, 100),
    "FetchPickAndPlace, wrapped": (fetch.wrapped, 30, 10),
    "FetchPickAndPlace's scene, inside mj_step": (fetch.inside, 30, 10),
}
"""Of each: what makes it, how many blocks, and steps of each."""


if __name__ == "__main__":
    for each in scenes(quick=False, seed=0, shown=lambda what, part: None):
        print(
            f"{each.scene}: {each.ratio:.3f} ({each.quartiles[0]:.3f} .. {each.quartiles[1]:.3f}) of bare, which takes "
            f"{1e6 * each.bare:.1f} us for each {each.unit}; same bits: {each.same}"
        )
