"""Fingertips and objects between which MuJoCo makes no contact, by its filters or because they fell asleep on each
other: nothing would be felt, without a word."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import warnings
from collections.abc import Sequence
from itertools import combinations, product

import mujoco

from thermograsp.errors import InvalidValueError

from ..bodies import BodyShape
from ..fingertips import PadPlace
from ..names import collides

_NONE = "the model disables its flag {}: enable it"
_STILL = (
    "neither of the two has a joint, and between such bodies MuJoCo has no forces: give one of them a joint"
)
_WELDED = "they are fixed to each other"
_PARENT = (
    "the joints of one are on the other: disable the flag filterparent, or name the two geoms in a <pair>"
)
_EXCLUDED = "the model excludes contacts between their bodies: leave the <exclude> out"
_STATIC = -1  # number of the kinematic tree of bodies that do not move, among them mocap bodies
_MASKED = (
    "contype and conaffinity of their geoms do not meet: let one geom's contype share a bit with the other's"
)


def warn_of_contact_filters(
    model: mujoco.MjModel, pads: Sequence[PadPlace], shapes: Sequence[BodyShape]
) -> None:
    """Warns the caller's caller of an object that no fingertip can touch, and of a fingertip that can touch neither an
    object nor another fingertip, by the model's filters of contacts."""
    untouched = set()
    for shape in shapes:
        if not any(collides(model, geom) for geom in shape.touched):
            continue  # `bodies` tells
        why = [_filter_between(model, pad, shape) for pad in pads]
        if all(why):
            untouched.add(shape.name)
            _warn(f"object {shape.name!r} is never touched by a fingertip", why[0])
    for pad in pads:
        others = [other for other in (*shapes, *pads) if other is not pad]
        why = [_filter_between(model, pad, other) for other in others]
        if all(why) and not untouched.issuperset(shape.name for shape in shapes):
            _warn(f"fingertip {pad.label!r} never touches anything", why[0])


def _warn(what: str, why: str) -> None:
    warnings.warn(f"{what}: {why}", RuntimeWarning, stacklevel=4)


def _filter_between(model: mujoco.MjModel, one: PadPlace, other: PadPlace | BodyShape) -> str:
    """Why no geom of the two can meet, "" where one can."""
    for name in ("constraint", "contact"):
        if model.opt.disableflags & getattr(mujoco.mjtDisableBit, f"mjDSBL_{name.upper()}"):
            return _NONE.format(name)
    if all(model.body_treeid[each.body] < 0 for each in (one, other)):
        return _STILL
    pairs = list(product(one.touched, other.touched))
    listed = {
        frozenset(pair) for pair in zip(model.pair_geom1.tolist(), model.pair_geom2.tolist(), strict=True)
    }
    if any(frozenset(pair) in listed for pair in pairs):
        return ""
    if why := _bodies_apart(model, one.body, other.body):
        return why
    kind, affinity = model.geom_contype, model.geom_conaffinity
    collide = any(kind[a] & affinity[b] or kind[b] & affinity[a] for a, b in pairs)
    return "" if collide else _MASKED


def _bodies_apart(model: mujoco.MjModel, *bodies: int) -> str:
    """Of what MuJoCo filters by bodies."""
    first, second = (int(model.body_weldid[body]) for body in bodies)
    if first == second:
        return _WELDED
    above = [int(model.body_weldid[model.body_parentid[top]]) for top in (first, second)]
    parents = not model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_FILTERPARENT
    if parents and first and second and (first == above[1] or second == above[0]):
        return _PARENT
    low, high = sorted(bodies)
    return _EXCLUDED if (low << 16) + high in model.exclude_signature else ""


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
