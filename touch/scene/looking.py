"""Where pads look: at the other fingertips of their hand; where these are beside them, as on a hand with parallel
fingers, the way in which the finger's own joint closes it; or at the objects."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

_AHEAD = math.cos(math.radians(25))  # between a joint's way and what is ahead; further off it is beside
_CLOSES = math.cos(math.radians(45))  # between a jaw's way and the one that it closes on
_TELLS = 0.35  # cosine from which on what a fingertip moves to or from tells the way that closes
_LEVER = 3e-3  # m, the least distance of a fingertip from its hinge's axis
_LARGER = 3.0  # times as far as the other way does a finger bend inwards, from where its model begins


@dataclass(frozen=True, slots=True)
class Hands:
    """A model's fingertips as it begins. bodies: that carry them. middles: (F, 3) m in the world."""

    model: mujoco.MjModel
    data: mujoco.MjData
    bodies: tuple[int, ...]
    middles: np.ndarray

    def ways(self, tip: int, objects: Sequence[np.ndarray]) -> list[np.ndarray]:
        """The directions (3,) in the world in which a fingertip's pad may lie, the likeliest first. objects: places
        (3,) m that it may touch, the likeliest first."""
        found, middle = [place - self.middles[tip] for place in objects], self.middles[tip]
        beside = self._of_hand(tip)
        if not beside:
            return found
        ahead = self.middles[beside].mean(axis=0) - middle
        closing = self._closing(tip, beside, ahead, objects)
        if closing is None:
            return [ahead, *found]
        looks_there = _cosine(closing, ahead) > _AHEAD
        return [ahead, closing, *found] if looks_there else [closing, ahead, *found]

    def _of_hand(self, tip: int) -> list[int]:
        """The other fingertips in the smallest part of the mechanism that has any, which is its hand."""
        others, body = [other for other in range(len(self.bodies)) if other != tip], self.bodies[tip]
        while body:
            found = [other for other in others if _below(self.model, self.bodies[other], body)]
            if found:
                return found
            body = int(self.model.body_parentid[body])
        return others

    def _closing(
        self, tip: int, beside: list[int], ahead: np.ndarray, objects: Sequence[np.ndarray]
    ) -> np.ndarray | None:
        """Where a fingertip's own joint takes it, None where it has none. Of the joint's two ways the one towards the
        others of its hand, if they are on one side of it; of a hinge the one in which its range is larger, as fingers
        begin stretched; or the one towards the nearest object."""
        for other in beside:
            if (opens := self._opening(other, tip)) is not None:
                return opens
        joint = self._own_joint(tip)
        way = self._way(tip, joint)
        if joint is None or way is None:
            return None
        away = [place - self.middles[tip] for place in objects]
        away.sort(key=lambda each: float(np.linalg.norm(each)))
        tells = [_cosine(way, each) for each in (ahead, *away)]
        tells[1:1] = [_larger_range(self.model, joint)]
        towards = next((each for each in tells if abs(each) > _TELLS), None)
        return None if towards is None else math.copysign(1.0, towards) * way

    def _opening(self, jaw: int, tip: int) -> np.ndarray | None:
        """Where a fingertip that is carried by another, and moves to and from it, goes as it leaves it."""
        if not _below(self.model, self.bodies[jaw], self.bodies[tip]):
            return None
        way = self._way(jaw, self._own_joint(jaw))
        towards = 0.0 if way is None else _cosine(way, self.middles[jaw] - self.middles[tip])
        return None if way is None or abs(towards) < _CLOSES else math.copysign(1.0, towards) * way

    def _own_joint(self, tip: int) -> int | None:
        """The nearest joint that moves a fingertip's middle and none of the others but those that it carries."""
        model, body = self.model, self.bodies[tip]
        shared = {0}
        for other in self.bodies:
            if not _below(model, other, body):
                shared.update(_above(model, other))
        if body in (each for n, each in enumerate(self.bodies) if n != tip):
            return None
        while body not in shared:
            first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
            moving = [joint for joint in range(first, first + count) if self._way(tip, joint) is not None]
            if moving:
                return moving[0] if len(moving) == 1 else self._widest(moving)
            body = int(model.body_parentid[body])
        return None

    def _widest(self, joints: list[int]) -> int | None:
        """Of several at one place the hinge that turns twice as far as any other: fingers bend further than they
        spread."""
        spans = [np.ptp(self.model.jnt_range[joint]) * self.model.jnt_limited[joint] for joint in joints]
        first, second = sorted(zip(spans, joints, strict=True), reverse=True)[:2]
        hinges = all(self.model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE for joint in joints)
        return first[1] if hinges and first[0] >= 2 * second[0] > 0 else None

    def _way(self, tip: int, joint: int | None) -> np.ndarray | None:
        """(3,) unit vector along which a joint takes a fingertip."""
        if joint is None:
            return None
        kinds, kind, axis = mujoco.mjtJoint, self.model.jnt_type[joint], self.data.xaxis[joint]
        if kind == kinds.mjJNT_SLIDE:
            return axis.copy()
        if kind == kinds.mjJNT_HINGE:
            way = np.cross(axis, self.middles[tip] - self.data.xanchor[joint])
            lever = float(np.linalg.norm(way))
            return way / lever if lever > _LEVER else None
        return None


def _above(model: mujoco.MjModel, body: int) -> Iterable[int]:
    """A body and those that carry it, the world not among them."""
    while body:
        yield body
        body = int(model.body_parentid[body])


def _below(model: mujoco.MjModel, body: int, top: int) -> bool:
    """Whether a body is carried by another, or is it."""
    return top in _above(model, body)


def _cosine(way: np.ndarray, away: np.ndarray) -> float:
    return float(way @ away) / max(float(np.linalg.norm(away)), 1e-12)


def _larger_range(model: mujoco.MjModel, joint: int) -> float:
    """1 or -1, the sign of a hinge's way that is much larger than the other; 0 where neither is."""
    if model.jnt_type[joint] != mujoco.mjtJoint.mjJNT_HINGE or not model.jnt_limited[joint]:
        return 0.0
    back, forth = np.abs(model.jnt_range[joint] - model.qpos0[model.jnt_qposadr[joint]])
    if max(back, forth) < _LARGER * min(back, forth):
        return 0.0
    return 1.0 if forth > back else -1.0
