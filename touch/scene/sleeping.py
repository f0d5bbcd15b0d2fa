"""Fingertips and objects that may fall asleep on each other: MuJoCo then has no contact of the two any more."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations, product

import mujoco

from thermograsp.errors import InvalidValueError

from .bodies import BodyShape
from .fingertips import PadPlace

_STATIC = -1  # number of the kinematic tree of bodies that do not move, among them mocap bodies


def refuse_sleep(model: mujoco.MjModel, pads: Sequence[PadPlace], shapes: Sequence[BodyShape]) -> None:
    """Raises InvalidValueError for a fingertip and what it may touch where nothing keeps both of them awake. What is
    asleep on a fingertip that is awake, such as one of a hand with actuators, is woken by the touch."""
    if not model.opt.enableflags & getattr(mujoco.mjtEnableBit, "mjENBL_SLEEP", 0):  # new in MuJoCo 3.4
        return
    pairs = *product(pads, shapes), *combinations(pads, 2)
    for pad, other in pairs:
        trees = [int(model.body_treeid[one.body]) for one in (pad, other)]
        moving = [tree for tree in trees if tree != _STATIC]
        if moving and all(_may_sleep(model, tree) for tree in moving):
            what = f"object {other.name!r}" if isinstance(other, BodyShape) else f"fingertip {other.label!r}"
            names = " or ".join(repr(model.body(int(model.tree_bodyadr[tree])).name) for tree in moving)
            raise InvalidValueError(
                f"fingertip {pad.label!r} and {what} may fall asleep on each other, as the model enables sleep, and "
                f'MuJoCo then drops their contacts: write sleep="never" at body {names}, or disable the flag sleep'
            )


def _may_sleep(model: mujoco.MjModel, tree: int) -> bool:
    policies = mujoco.mjtSleepPolicy
    return int(model.tree_sleep_policy[tree]) not in (
        int(policies.mjSLEEP_AUTO_NEVER),
        int(policies.mjSLEEP_NEVER),
    )
