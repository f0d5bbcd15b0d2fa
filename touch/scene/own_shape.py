"""Objects whose heat flows in their own shape: those that are one closed mesh. All others stay boxes."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import replace

import mujoco
import numpy as np

from thermograsp.errors import ThermograspError
from thermograsp.notice import busy

from ...thermal import Solid, SolidPart
from .bodies import BodyShape
from .faces import mesh_of, rotation
from .fingertips import PadPlace
from .names import geom_label

_LOG = logging.getLogger(__name__)
_DIGITS = 7  # of a corner's m, of which a model has single precision


def own_shapes(
    model: mujoco.MjModel, shapes: Sequence[BodyShape], pads: Sequence[PadPlace]
) -> tuple[BodyShape, ...]:
    """The objects, those that are meshes with the solids that their heat flows in. A warning says which of these stay
    boxes, and why."""
    return tuple(_own(model, shape, pads) if _is_mesh(model, shape) else shape for shape in shapes)


def warn_of_boxes(model: mujoco.MjModel, shapes: Sequence[BodyShape], why: str) -> None:
    """Says of which objects the heat flows in boxes where their own shape might have been taken."""
    for shape in shapes:
        if _is_mesh(model, shape):
            _warn(shape, why)


def _is_mesh(model: mujoco.MjModel, shape: BodyShape) -> bool:
    return [model.geom_type[geom] for geom in shape.geoms] == [mujoco.mjtGeom.mjGEOM_MESH]


def _warn(shape: BodyShape, why: str) -> None:
    _LOG.warning("object %r: its heat flows in a box of its volume and proportions: %s", shape.name, why)


def _own(model: mujoco.MjModel, shape: BodyShape, pads: Sequence[PadPlace]) -> BodyShape:
    from ...thermal.meshes import body_modes  # nothing that meshes need is loaded without them

    if len({(pad.stack, pad.surround) for pad in pads}) > 1:
        _warn(shape, "its fingertips have different sensors, skins or pads")
        return shape
    (geom,) = shape.geoms
    vertices, faces = mesh_of(model, geom)
    # MuJoCo turns a mesh to its axes of inertia; its file's are those that its walls are along
    mesh = int(model.geom_dataid[geom])
    turn, offset = rotation(model.mesh_quat[mesh]), model.mesh_pos[mesh]
    vertices = np.round(vertices @ turn.T + offset, _DIGITS)  # or flat faces would be a little crooked
    axes = rotation(model.geom_quat[geom]) @ turn.T
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    middle = (low + high) / 2
    try:
        part = SolidPart(*_welded(vertices - middle, faces), shape.material)
        solid = Solid((part,))
        with busy(f"how heat spreads in {geom_label(model, geom)}, once for its shape"):
            body_modes(solid)
    except ThermograspError as error:
        _warn(shape, f"mesh {geom_label(model, geom)} is no closed body: {error}")
        return shape
    centre = model.geom_pos[geom] + axes @ (middle - offset)
    return replace(shape, size=high - low, extent=high - low, centre=centre, axes=axes, solid=solid)


def _welded(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corners at the same place as one, without the faces that are none then."""
    distinct, which = np.unique(vertices, axis=0, return_inverse=True)
    faces = which.ravel()[faces]
    a, b, c = faces.T
    return distinct, faces[(a != b) & (b != c) & (c != a)]
