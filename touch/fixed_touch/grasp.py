"""Fingertips that grasp objects in the middles of opposite faces."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Sequence

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError

from ...thermal import Material, SignalChain
from ...thermal.numerics import Array
from ..heat import JoinedHeat
from ..scene import BodyShape, PadPlace
from .made import fixed_touch
from .step import FixedTouch

MOST_NETWORKS = 4096
"""Of combinations of materials and ways to grasp objects that grasp_touch makes tables of."""
_SAME = 1e-9  # of a box's sides, by which they may differ and count as equal


def grasp_touch(
    model: mujoco.MjModel,
    pads: Sequence[PadPlace],
    shapes: Sequence[BodyShape],
    materials: Sequence[Sequence[Material]],
    *,
    dt: float,
    substeps: int,
    tolerance: float,
    ambient: float,
    air: float,
    chain: SignalChain,
    samples: int,
    like: Array,
) -> tuple[FixedTouch, int]:
    """Fingertips that touch every object in the middles of two opposite faces of its box, those that look alike in the
    model's first pose on the same one; and in how many ways. There are three, across the box's sides, or one where
    all objects are cubes. An object that has its own shape is touched where that is nearest to those middles.
    materials: of each object. A world's number is that of its material times the ways, plus the way. One sample each
    dt s of so many substeps. Raises InvalidValueError beside thermostats of finite power, heated sensors and glued
    elements, and for more combinations than MOST_NETWORKS."""
    cubes = all(shape.solid is None and np.ptp(shape.size) <= _SAME * shape.size.max() for shape in shapes)
    ways = 1 if cubes else 3
    combinations = math.prod(len(choices) * ways for choices in materials)
    if combinations > MOST_NETWORKS:
        raise InvalidValueError(
            f"objects: their materials and the sides that they may be grasped across combine in {combinations} ways, "
            f"more than {MOST_NETWORKS}: name fewer objects, or fewer materials of each"
        )
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    looks = np.array([data.xmat[pad.body].reshape(3, 3) @ pad.axes[:, 0] for pad in pads])
    side = np.where(looks @ looks[0] < 0, -1.0, 1.0)
    poses = np.zeros((ways, len(pads), len(shapes), 6))
    for o, shape in enumerate(shapes):
        inward = side[:, None] * shape.axes.T[:ways, None]
        poses[:, :, o, :3] = shape.centre - inward * shape.size[:ways, None, None] / 2
        poses[:, :, o, 3:] = inward
    first = [shape.of(choices[0]) for shape, choices in zip(shapes, materials, strict=True)]
    heat = JoinedHeat(pads, (), first, worlds=1, dt=dt, tolerance=tolerance, film=air, ambient=ambient)
    most = max(map(len, materials))
    kinds = [
        tuple(
            shape.of(choices[min(v, len(choices) - 1)])
            for shape, choices in zip(shapes, materials, strict=True)
        )
        for v in range(most)
        for _ in range(ways)
    ]
    fixed = fixed_touch(
        model,
        pads,
        shapes,
        kinds,
        [[one for one in choices for _ in range(ways)] for choices in materials],
        heat.fixed_networks(0, materials, poses),
        substeps=substeps,
        ambient=ambient,
        chain=chain,
        places=None,
        worlds=(np.zeros((1, len(shapes)), int), np.full((1, len(shapes)), ambient)),
        now=None,
        samples=samples,
        like=like,
    )
    return fixed, ways
