"""Boxes, cylinders and spheres of other sizes in a compiled scene, without compiling another one.

Compiling a scene takes milliseconds, and where every episode draws a size, sixteen episodes that end at once would wait
for sixteen scenes. What the compiler makes of such an object is known: what stands here, and what `mj_setConst` derives
from it. The numbers are those of `build_scene` to the last bit (tests/envs/mechanics/test_resized.py).
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import copy
import itertools
import math
from collections.abc import Mapping, Sequence

import mujoco
import numpy as np

from ..bodies import ObjectSpec
from ..grippers import GripperModel
from .engine import MODEL_FIELDS
from .scene import PRIMITIVES, half_sizes, principal, soften_alike

_GIVEN = (
    *("body_pos", "body_quat", "body_mass", "body_ipos", "body_iquat", "body_inertia", "bvh_aabb"),
    *("geom_type", "geom_size", "geom_rbound", "geom_aabb", "geom_friction", "geom_rgba"),
    *("qpos0", "qpos_spring"),
)
_DERIVED = (
    *("body_subtreemass", "body_invweight0", "cam_pos0", "cam_poscom0", "cam_mat0"),
    *("dof_M0", "dof_invweight0", "dof_length", "light_pos0", "light_poscom0", "light_dir0"),
)
_FIELDS = tuple(name for name in (*_GIVEN, *_DERIVED) if name in MODEL_FIELDS)
_CORNERS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))


def primitive(objects: Sequence[ObjectSpec]) -> bool:
    """Whether each is one geom of one of those shapes."""
    return all(item.shape in PRIMITIVES and not item.elements for item in objects)


class Resized:
    """A copy of a compiled model of `build_scene`, of primitive objects, that takes the place of others. base: the
    fields' bytes in the model."""

    def __init__(
        self, model: mujoco.MjModel, names: Sequence[str], gripper: GripperModel, base: Mapping[str, bytes]
    ) -> None:
        self._model, self._gripper, self._base = copy.deepcopy(model), gripper, base
        self._data = mujoco.MjData(self._model)
        self._fields = {name: getattr(self._model, name) for name in _FIELDS}
        self._wrist = model.body("wrist").id
        self._names, self._bodies = tuple(names), [model.body(name).id for name in names]
        # bvh_aabb goes on with the meshes' boxes, which all environments share
        self._boxes = int(model.body_bvhnum.sum())

    def differences(self, objects: Sequence[ObjectSpec]) -> dict[str, np.ndarray]:
        """Fields in which a compiled scene of these objects would differ from the model; the next call writes over
        them."""
        fields = self._fields
        fields["body_pos"][self._wrist] = self._gripper.wrist_at(objects[0])
        for body, item in zip(self._bodies, objects, strict=True):
            self._put(body, item)
        mujoco.mj_setConst(self._model, self._data)
        soften_alike(self._model, self._names)
        changed = {name: array for name, array in fields.items() if array.tobytes() != self._base[name]}
        if "bvh_aabb" in changed:
            changed["bvh_aabb"] = changed["bvh_aabb"][: self._boxes]
        return changed

    def _put(self, body: int, item: ObjectSpec) -> None:
        model, fields = self._model, self._fields
        geom, pose = model.body_geomadr[body], item.pose
        com, inertia = item.inertia
        moments, quat = principal(inertia)
        mujoco.mju_normalize4(quat)
        fields["body_pos"][body], fields["body_quat"][body] = pose[:3], pose[3:]
        fields["body_mass"][body], fields["body_ipos"][body] = item.weight, com
        fields["body_iquat"][body], fields["body_inertia"][body] = quat, moments
        at = model.jnt_qposadr[model.body_jntadr[body]]
        fields["qpos0"][at : at + 7] = fields["qpos_spring"][at : at + 7] = pose
        x, y, z = box = tuple(side / 2 for side in item.size)
        reach = {"box": math.sqrt(x * x + y * y + z * z), "cylinder": math.sqrt(x * x + z * z), "sphere": x}
        fields["geom_type"][geom], fields["geom_size"][geom] = PRIMITIVES[item.shape], half_sizes(item)
        fields["geom_rbound"][geom], fields["geom_aabb"][geom] = reach[item.shape], (0, 0, 0, *box)
        fields["geom_friction"][geom, 0], fields["geom_rgba"][geom] = item.sliding_friction, item.rgba
        # The box around it in the frame of its inertia's axes.
        mujoco.mju_negQuat(quat, quat)
        corners = _CORNERS * box - com
        for corner in corners:
            mujoco.mju_rotVecQuat(corner, corner.copy(), quat)
        low, high = corners.min(axis=0), corners.max(axis=0)
        fields["bvh_aabb"][model.body_bvhadr[body]] = (*(low + high) / 2, *(high - low) / 2)
