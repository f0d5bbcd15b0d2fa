"""Pads on round geoms: where a direction leaves them, as curved as they are there."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math

import mujoco
import numpy as np

from .faces import frame, rotation

_WITHIN = 0.8  # of a round geom's radius, half the width of its pad

_STRAIGHT, _STRICT = 0.5, math.cos(math.radians(20))  # sine between a direction and a capsule's axis, least

Place = tuple[np.ndarray, np.ndarray, np.ndarray, tuple[float, float]]
"""Of a pad: position (3,) m, axes (3, 3), size (2,) m and curvature 1/m, as PadPlace has them."""
FLAT = (0.0, 0.0)


def bulge(
    model: mujoco.MjModel, geoms: tuple[int, ...], direction: np.ndarray, strict: bool = False
) -> Place | None:
    """The pad where a direction of the body's frame leaves the round geom that reaches furthest that way. It lies on a
    capsule's straight part where the direction leans at most 60 degrees to its end, or 20 if strict."""
    straight = _STRICT if strict else _STRAIGHT
    found = [_round(model, geom, direction, straight) for geom in geoms if is_round(model, geom)]
    return max(found, key=lambda place: round(float(place[0] @ direction), 9), default=None)


def is_round(model: mujoco.MjModel, geom: int) -> bool:
    """Whether a geom bulges out somewhere: a ball, a capsule, an ellipsoid or a cylinder."""
    return mujoco.mjtGeom(int(model.geom_type[geom])) in _ROUND_KINDS


def has_edge(model: mujoco.MjModel, geom: int, normal: np.ndarray) -> bool:
    """Whether a flat pad with a normal in its body's frame has an edge on that geom: on any that is not round, and on
    a cylinder's end."""
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_CYLINDER:
        return abs(float(rotation(model.geom_quat[geom])[:, 2] @ normal)) > _STRAIGHT
    return not is_round(model, geom)


_ROUND_KINDS = (
    mujoco.mjtGeom.mjGEOM_SPHERE,
    mujoco.mjtGeom.mjGEOM_CAPSULE,
    mujoco.mjtGeom.mjGEOM_ELLIPSOID,
    mujoco.mjtGeom.mjGEOM_CYLINDER,
)


def _round(model: mujoco.MjModel, geom: int, direction: np.ndarray, straight: float) -> Place:
    """On a ball the pad is as wide as what looks within 53 degrees of the direction, on a rod as long as that is
    straight."""
    kinds, kind = mujoco.mjtGeom, model.geom_type[geom]
    turn, size = rotation(model.geom_quat[geom]), model.geom_size[geom]
    outward, at = turn.T @ direction, model.geom_pos[geom]
    radius, half = float(size[0]), float(size[1])
    side = float(np.hypot(outward[0], outward[1]))
    rod = kind == kinds.mjGEOM_CYLINDER or (kind == kinds.mjGEOM_CAPSULE and side > straight)
    if rod and side > 1e-6:
        out = np.array([outward[0], outward[1], 0.0]) / side
        # a short capsule is as straight along its length as the ellipsoid of its size
        short = kind == kinds.mjGEOM_CAPSULE and half < _WITHIN * radius
        along = radius / (radius + half) ** 2 if short else 0.0
        axes = np.column_stack((turn @ out, turn @ np.cross([0.0, 0.0, 1.0], out), turn[:, 2]))
        wide = 2 * np.array([_WITHIN * radius, _WITHIN * radius if short else half])
        return at + turn @ (radius * out), axes, wide, (1 / radius, along)
    if kind == kinds.mjGEOM_CAPSULE:
        point = radius * outward + [0.0, 0.0, math.copysign(half, outward[2])]
        return at + turn @ point, frame(direction), np.full(2, 2 * _WITHIN * radius), (1 / radius, 1 / radius)
    axes_of = size if kind == kinds.mjGEOM_ELLIPSOID else np.full(3, radius)
    point = outward / np.sqrt(np.sum((outward / axes_of) ** 2))
    steep = point / axes_of**2
    out = turn @ (steep / np.linalg.norm(steep))
    axes = frame(out)
    along = turn.T @ axes[:, 1:]
    bent = along.T @ (along / axes_of[:, None] ** 2) / np.linalg.norm(steep)
    if kind == kinds.mjGEOM_ELLIPSOID:  # y and z where it is bent the most and the least
        turned = np.linalg.eigh(bent)[1][:, ::-1]
        turned[:, 1] *= np.linalg.det(turned)
        axes = np.column_stack((out, axes[:, 1:] @ turned))
        bent = turned.T @ bent @ turned
    first, second = (float(bent[i, i]) for i in range(2))
    return at + turn @ point, axes, np.full(2, 2 * _WITHIN * float(axes_of.min())), (first, second)
