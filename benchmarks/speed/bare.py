"""Bare MuJoCo beside the gripper: a second batch of the same models that gets the same inputs."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import mujoco.batch
import numpy as np

from thermograsp.envs import Mechanics, MechanicsState
from thermograsp.envs.bodies import ObjectSpec


@dataclass(frozen=True, slots=True)
class Inputs:
    """What a gripper's actuators got in one control step. control (B, nu), MuJoCo's. force_limit (B,) N."""

    control: np.ndarray
    force_limit: np.ndarray


class BareBatch:
    """mujoco.batch with the model fields of every environment of a Mechanics, and none of its work: inputs are set,
    `substeps` steps are taken, nothing is recorded. threads: MuJoCo's."""

    def __init__(self, mechanics: Mechanics, threads: int, substeps: int) -> None:
        model = mechanics.model
        self.batch = mujoco.batch.Batch(model, mechanics.num_envs, threads)
        self._substeps = substeps
        self._control = self.batch.bind("ctrl")
        self._limits = self.batch.expand("actuator_forcerange")
        self._grip = model.actuator("grip").id
        self._base = {
            name: getattr(model, name)
            for name in sorted(mujoco.batch.MODEL_FIELDS)
            if isinstance(getattr(model, name, None), np.ndarray) and not name.startswith("name")
        }
        self._varying: set[str] = set()
        self._objects: list[tuple[ObjectSpec, ...] | None] = [None] * mechanics.num_envs
        self._scratch = mechanics.env_model(0)

    def copy(self, mechanics: Mechanics, state: MechanicsState) -> None:
        """The models of `mechanics` and a state of all its environments."""
        for row, objects in enumerate(mechanics.objects):
            if objects != self._objects[row]:
                self._copy_model(row, mechanics.env_model(row, self._scratch))
                self._objects[row] = objects
        self.batch.state[:] = state.rows
        self._limits[:, self._grip, 0] = -state.force_limit

    def _copy_model(self, row: int, model: mujoco.MjModel) -> None:
        for name, base in self._base.items():
            field = getattr(model, name)
            if name not in self._varying and field.tobytes() == base.tobytes():
                continue
            self._varying.add(name)
            rows = self.batch.expand(name)
            rows[row] = field[: rows.shape[1]]  # bvh_aabb goes on with the meshes' boxes, which all share

    def step(self, inputs: Inputs) -> None:
        """One control step of all environments."""
        self._control[:] = inputs.control
        self._limits[:, self._grip, 0] = -inputs.force_limit
        self.batch.step(nstep=self._substeps)


def inputs_of(model: mujoco.MjModel, state: MechanicsState) -> Inputs:
    """What the step before this state was fed; both stay in the state."""
    control = np.zeros((len(state.rows), model.nu))
    for row, values in zip(state.rows, control, strict=True):
        mujoco.mj_extractState(
            model, row, mujoco.mjtState.mjSTATE_INTEGRATION, values, mujoco.mjtState.mjSTATE_CTRL
        )
    return Inputs(control, state.force_limit)
