"""FetchPickAndPlace of gymnasium-robotics holding its block: the environment in AddThermalObservation, and its scene
with heat inside mj_step. gymnasium-robotics 1.4.2 runs beside MuJoCo 3.3.7, Grasp-v0 from 4.0 on: where only one
is installed, `python -m thermograsp.bench.speed.scenes` measures what can be had there."""

# mujoco ships no type stubs for its compiled names; gymnasium-robotics lives in an environment of its own
# pyright: reportAttributeAccessIssue=false, reportMissingImports=false

from __future__ import annotations

from typing import Any

import gymnasium
import mujoco
import numpy as np

from thermograsp.bench.speed.beside import Pair
from thermograsp.errors import MissingDependencyError
from thermograsp.touch import install
from thermograsp.touch.wrappers import AddThermalObservation

ID = "FetchPickAndPlace-v4"
_WORDS: dict[str, Any] = {
    "fingertips": {side: f"robot0:{side}_gripper_finger_link" for side in ("r", "l")},
    "objects": {"object0": "aluminium"},
}
_ABOVE, _OPEN, _GRASP = 12, 24, 49  # environment steps: over the block, down to it, closed round it
_HOLD = np.array([0.0, 0.0, 0.0, -1.0], np.float32)
_SUBSTEPS = 20  # of an environment step


def wrapped(name: str) -> Pair:
    """The environment's own steps, with and without the wrapper."""
    plain = _made()
    with_touch = AddThermalObservation(_made(), **_WORDS)
    for env in (plain, with_touch):
        _grasp(env)

    def bare(steps: int) -> None:
        for _ in range(steps):
            plain.step(_HOLD)

    def touch(steps: int) -> None:
        for _ in range(steps):
            with_touch.step(_HOLD)

    at = [env.unwrapped.data for env in (plain, with_touch)]
    return Pair(name, "step of 20 substeps", bare, touch, lambda: np.array_equal(at[0].qpos, at[1].qpos))


def inside(name: str) -> Pair:
    """The environment's scene from where the block is held, stepped by MuJoCo alone."""
    env = _made()
    _grasp(env)
    held, path = env.unwrapped, env.unwrapped.fullpath
    models = mujoco.MjSpec.from_file(path).compile(), install(mujoco.MjSpec.from_file(path), **_WORDS)
    datas = []
    for model in models:
        model.eq_data[:] = held.model.eq_data  # the environment has moved its welds
        data = mujoco.MjData(model)
        for field in ("qpos", "qvel", "act", "ctrl", "mocap_pos", "mocap_quat", "qacc_warmstart"):
            getattr(data, field)[:] = getattr(held.data, field)
        datas.append(data)
    (without, with_heat), (alone, heated) = models, datas

    def bare(steps: int) -> None:
        for _ in range(steps):
            mujoco.mj_step(without, alone, _SUBSTEPS)

    def touch(steps: int) -> None:
        for _ in range(steps):
            mujoco.mj_step(with_heat, heated, _SUBSTEPS)

    return Pair(name, "20 substeps", bare, touch, lambda: np.array_equal(alone.qpos, heated.qpos))


def _made() -> gymnasium.Env:
    """Raises MissingDependencyError where gymnasium-robotics does not run beside the MuJoCo that is installed."""
    import gymnasium_robotics

    gymnasium.register_envs(gymnasium_robotics)
    try:
        return gymnasium.make(ID, max_episode_steps=10**9)
    except AssertionError as error:  # it finds joints of no kind that it knows
        raise MissingDependencyError(
            f"gymnasium-robotics {gymnasium_robotics.__version__} does not run beside MuJoCo {mujoco.__version__}"
        ) from error


def _grasp(env: gymnasium.Env) -> None:
    observation, _ = env.reset(seed=3)
    for step in range(_GRASP):
        grip, block = observation["observation"][:3], observation["observation"][3:6]
        goal = block + (0.0, 0.0, 0.1 if step < _ABOVE else 0.0)
        action = np.append(np.clip(10 * (goal - grip), -1, 1), 1.0 if step < _OPEN else -1.0)
        observation = env.step(action.astype(np.float32))[0]
