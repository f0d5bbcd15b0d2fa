"""The way in which a fingertip's own joint closes it. Its pad looks there where the other fingertips are beside it, as
on a hand with parallel fingers."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import mujoco
import numpy as np

_AHEAD = math.cos(
    math.radians(45)
)  # of a joint's way and what is ahead; further off it is beside the fingertip
_TELLS = 0.35  # cosine from which on what a fingertip moves to or from tells the way that closes
_LEVER = 1e-3  # m, the least distance of a fingertip from its hinge's axis
_LARGER = 3.0  # times as far as the other way does a finger bend inwards, from where its model begins


def closing(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    body: int,
    middle: np.ndarray,
    others: Iterable[int],
    ahead: np.ndarray,
    objects: Sequence[np.ndarray],
) -> np.ndarray | None:
    """(3,) unit vector in the world: where the nearest joint of a fingertip's body takes its middle (3,) m, or None
    where it has no joint of its own or the other fingertips, whose bodies are `others` and whose middle is at `ahead`
    (3,) m, lie along its way already. Of the joint's two ways it is the one towards these, if they are on one side of
    it; of a hinge the one in which its range is larger, as fingers begin stretched; or the one towards the nearest of
    `objects`, places (3,) m."""
    joint = _own_joint(model, body, others)
    way = None if joint is None else _way(model, data, joint, middle)
    if joint is None or way is None:
        return None
    towards = _cosine(way, ahead - middle)
    if abs(towards) > _AHEAD:
        return None
    if abs(towards) > _TELLS:
        return math.copysign(1.0, towards) * way
    if side := _larger_range(model, joint):
        return side * way
    for place in sorted(objects, key=lambda place: float(np.linalg.norm(place - middle))):
        towards = _cosine(way, place - middle)
        if abs(towards) > _TELLS:
            return math.copysign(1.0, towards) * way
    return None


def _cosine(way: np.ndarray, away: np.ndarray) -> float:
    return float(way @ away) / max(float(np.linalg.norm(away)), 1e-12)


def _own_joint(model: mujoco.MjModel, body: int, others: Iterable[int]) -> int | None:
    """The nearest joint that moves a body and none of the others. None where there is none, or several at one place."""
    shared = {0}
    for other in others:
        while other not in shared:
            shared.add(other)
            other = int(model.body_parentid[other])
    while body not in shared:
        if model.body_jntnum[body]:
            return int(model.body_jntadr[body]) if model.body_jntnum[body] == 1 else None
        body = int(model.body_parentid[body])
    return None


def _way(model: mujoco.MjModel, data: mujoco.MjData, joint: int, middle: np.ndarray) -> np.ndarray | None:
    kinds, kind, axis = mujoco.mjtJoint, model.jnt_type[joint], data.xaxis[joint]
    if kind == kinds.mjJNT_SLIDE:
        return axis.copy()
    if kind == kinds.mjJNT_HINGE:
        way = np.cross(axis, middle - data.xanchor[joint])
        lever = float(np.linalg.norm(way))
        return way / lever if lever > _LEVER else None
    return None


def _larger_range(model: mujoco.MjModel, joint: int) -> float:
    """1 or -1, the sign of a hinge's way that is much larger than the other; 0 where neither is."""
    if model.jnt_type[joint] != mujoco.mjtJoint.mjJNT_HINGE or not model.jnt_limited[joint]:
        return 0.0
    back, forth = np.abs(model.jnt_range[joint] - model.qpos0[model.jnt_qposadr[joint]])
    if max(back, forth) < _LARGER * min(back, forth):
        return 0.0
    return 1.0 if forth > back else -1.0
