"""Sensor elements that are glued on objects (O mode): where they sit, and what a wrong place is."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError

from ...thermal import sensor as sensor_preset
from .bodies import BodyShape, require_box
from .faces import frame
from .fingertips import PadPlace

OFF_FACE = 1e-3  # m from a face's plane, up to which an element is on it
_ALONG = 0.999  # least cosine between an element's normal and its face's


def glued_elements(
    model: mujoco.MjModel, objects: Sequence[BodyShape], ambient: float
) -> tuple[PadPlace, ...]:
    """The objects' elements as pads that look into their objects and stay on them. Raises InvalidValueError for an
    object that is no single box, and for an element that does not lie on a face or lies over another."""
    found = []
    for number, shape in enumerate(objects):
        placed_here: list[PadPlace] = []
        for element in shape.elements:
            label = f"{shape.name}:{len(placed_here)}"
            require_box(
                model,
                shape,
                f"element {label}: elements can be glued on an object that is one box",
                "name a box geom as the object",
            )
            stack = sensor_preset(element.sensor)
            outward = np.asarray(element.normal, float) / np.linalg.norm(element.normal)
            position = _on_face(shape, label, np.asarray(element.position, float), outward, stack.width)
            size = np.full(2, stack.width)
            placed = PadPlace(
                label, shape.body, (), position, frame(-outward), size, stack, ambient, glued=number
            )
            for other in placed_here:
                _require_distance(placed, other)
            placed_here.append(placed)
        found += placed_here
    return tuple(found)


def _on_face(
    shape: BodyShape, label: str, position: np.ndarray, outward: np.ndarray, width: float
) -> np.ndarray:
    """The element's middle m, on the face that it is glued on."""
    along, at, half = shape.axes.T @ outward, shape.axes.T @ (position - shape.centre), shape.size / 2
    axis = int(np.argmax(np.abs(along)))
    if abs(along[axis]) < _ALONG:
        raise InvalidValueError(
            f"element {label}: its normal {tuple(outward.tolist())} is not that of a face of {shape.name!r}: give the "
            "outward normal of one of its six sides, in the body's frame"
        )
    face = float(np.copysign(half[axis], along[axis]))
    if abs(at[axis] - face) > OFF_FACE:
        raise InvalidValueError(
            f"element {label}: its position lies {1e3 * abs(at[axis] - face):.1f} mm off the face that its normal "
            f"gives: put it on the surface of {shape.name!r}, in the body's frame"
        )
    at[axis] = face
    for other in range(3):
        over = abs(at[other]) + width / 2 - half[other]
        if other != axis and over > OFF_FACE:
            raise InvalidValueError(
                f"element {label}: {1e3 * width:g} mm wide, it stands {1e3 * over:.1f} mm over the edge of "
                f"{shape.name!r}: move it inward"
            )
    return shape.centre + shape.axes @ at


def _require_distance(one: PadPlace, other: PadPlace) -> None:
    if one.axes[:, 0] @ other.axes[:, 0] < _ALONG:
        return
    between = np.abs(one.axes[:, 1:].T @ (one.position - other.position))
    if (between < (one.size + other.size) / 2 - OFF_FACE).all():
        raise InvalidValueError(
            f"elements {other.label} and {one.label} lie over each other: put them {1e3 * one.size[0]:g} mm apart"
        )
