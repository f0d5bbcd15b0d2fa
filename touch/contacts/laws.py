"""What conducts where a pad meets a geom: the contact law of every pair, and the resistance of a small contact."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Sequence

import mujoco
import numpy as np

from ...thermal import (
    CONTACT_LAW,
    Joint,
    Pad,
    Surface,
    cylinder_law,
    flat_law,
    joint,
    sphere_law,
)
from ...thermal.contact import FLAT, skinned
from ..scene import BodyShape, PadPlace

SQUARE = 0.473  # a square source's mean temperature on a half-space over q/(k side): Carslaw & Jaeger, section 10.5
_WIDE = 10.0  # m, a face that no pad reaches the end of


def pair_laws(model: mujoco.MjModel, pads: Sequence[PadPlace], shapes: Sequence[BodyShape]) -> np.ndarray:
    """(F, G + F, 3) CONTACT_LAW records: of each pad on each geom of the objects, in their order, by the axis of the
    geom's frame that the pad looks along; and on each other pad, whose sides are taken as parallel to its own."""
    geoms = [(shape, geom) for shape in shapes for geom in shape.geoms]
    laws = np.zeros((len(pads), len(geoms) + len(pads), 3), CONTACT_LAW)
    for f, pad in enumerate(pads):
        width = float(math.sqrt(pad.size.prod()))
        sheet = skinned(Pad(width=width, face=min(pad.stack.width, width)), pad.skin)
        for g, (shape, geom) in enumerate(geoms):
            faces = joint(pad.face, Surface.of(shape.material), full_contact=pad.skin is not None)
            for axis in range(3):
                laws[f, g, axis] = _on_face(_law(model, geom, axis, sheet, faces), sheet)
        for g, other in enumerate(pads, len(geoms)):
            faces = joint(pad.face, other.face, full_contact=(pad.skin or other.skin) is not None)
            side = min(other.stack.width, float(math.sqrt(other.size.prod())))
            laws[f, g] = flat_law(sheet, faces, (side, side), (1, 2))
    return laws


def _on_face(law: np.void, pad: Pad) -> np.void:
    """The law of a curved body on springs that are stiffer on the sensor's face: the contact is narrow, and these take
    all of a ball's force and, of a cylinder's, what the softer ones along it leave. The pad around counts as if it
    ended with the face across the contact."""
    if law["shape"] == FLAT or pad.face_stiffness is None:
        return law
    law["stiffness"] *= pad.face_ratio
    law["half_pad"] = law["half_face"]
    law["pad_length"] = law["face_length"] + (law["pad_length"] - law["face_length"]) / pad.face_ratio
    return law


def _law(model: mujoco.MjModel, geom: int, axis: int, pad: Pad, faces: Joint) -> np.void:
    kind, (a, b, c) = mujoco.mjtGeom(int(model.geom_type[geom])), (float(s) for s in model.geom_size[geom])
    shapes = mujoco.mjtGeom
    if kind == shapes.mjGEOM_SPHERE:
        return sphere_law(pad, faces, a)
    if kind == shapes.mjGEOM_ELLIPSOID:
        # the radii of curvature where an axis leaves it, their geometric mean
        along, first, second = np.roll((a, b, c), -axis)
        return sphere_law(pad, faces, first * second / along)
    if kind in (shapes.mjGEOM_CYLINDER, shapes.mjGEOM_CAPSULE) and axis < 2:
        return cylinder_law(pad, faces, a, 2 * b)
    if kind == shapes.mjGEOM_CAPSULE:
        return sphere_law(pad, faces, a)
    if kind == shapes.mjGEOM_CYLINDER:
        side = math.sqrt(math.pi) * a
        return flat_law(pad, faces, (side, side), (0, 1))
    if kind == shapes.mjGEOM_BOX:
        first, second = (i for i in range(3) if i != axis)
        sizes = 2 * model.geom_size[geom]
        return flat_law(pad, faces, (float(sizes[first]), float(sizes[second])), (first, second))
    return flat_law(pad, faces, (_WIDE, _WIDE))
