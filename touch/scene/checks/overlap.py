"""Fingertips that begin inside an object: nothing that they feel would mean anything."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError

from ..bodies import BodyShape
from ..fingertips import PadPlace
from ..names import geom_label

DEEPEST = 0.004  # m of a pad's middle below an object's surface; a soft contact sinks in by less


def refuse_overlap(
    model: mujoco.MjModel, data: mujoco.MjData, pads: Sequence[PadPlace], shapes: Sequence[BodyShape]
) -> None:
    """Raises InvalidValueError where a pad's middle is inside an object."""
    for pad in pads:
        middle = data.xpos[pad.body] + data.xmat[pad.body].reshape(3, 3) @ pad.position
        for shape in shapes:
            for geom in shape.touched:
                turn = data.geom_xmat[geom].reshape(3, 3)
                depth = _depth(model, geom, turn.T @ (middle - data.geom_xpos[geom]))
                if depth > DEEPEST:
                    raise InvalidValueError(
                        f"fingertip {pad.label!r} is inside object {shape.name!r}: its pad's middle lies "
                        f"{1e3 * depth:.1f} mm below the surface of geom {geom_label(model, geom)}; begin with the two "
                        "apart, or give the pad's position and normal"
                    )


def _depth(model: mujoco.MjModel, geom: int, at: np.ndarray) -> float:
    """m below the surface of a round or box geom, at a place in its frame; of a mesh nothing is known."""
    kind, size, kinds = model.geom_type[geom], model.geom_size[geom], mujoco.mjtGeom
    if kind == kinds.mjGEOM_BOX:
        return float((size - np.abs(at)).min())
    if kind == kinds.mjGEOM_CYLINDER:
        return float(min(size[0] - np.hypot(at[0], at[1]), size[1] - abs(at[2])))
    if kind == kinds.mjGEOM_CAPSULE:
        beyond = max(abs(at[2]) - size[1], 0.0)
        return float(size[0] - np.sqrt(at[0] ** 2 + at[1] ** 2 + beyond**2))
    if kind in (kinds.mjGEOM_SPHERE, kinds.mjGEOM_ELLIPSOID):
        axes = np.full(3, size[0]) if kind == kinds.mjGEOM_SPHERE else size
        return float((1 - np.sqrt(np.sum((at / axes) ** 2))) * axes.min())
    return -np.inf
