"""How two fingers close: the postures from wide open to shut, with the fingertips' faces opposed where that can be.

u: the closing axis, from the left fingertip to the right one. Where fingers have one freedom only, there is nothing to
choose, and the fingertips are mounted so that they are parallel at one opening.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from thermograsp.errors import GripperError

from ..limits import MAX_OPENING
from .fingers import Finger
from .fingertip import thickness
from .hand import Hand
from .mechanism import angle_hint
from .opposition import Opposition, least, moved_by

PARALLEL_AT = 0.04  # m, the opening at which the fingertips are parallel
MOST_WEDGE = np.deg2rad(50)  # between a fingertip and the face that it is mounted on
_GRID = 0.004  # m, between postures
_REACHED = 3e-4  # m, of an opening that counts as reached
_EXACT, _CLOSE, _ALIGNED = 1e-4, 5e-3, 0.1  # m, m, rad: by which the terms of a posture are weighed, and
_EVEN, _STEADY = 5e-3, 2e-2  # m, how far the middle goes along u, and otherwise
_LOOSE = 0.2  # weight of staying near the last posture, per range
_LEAST_TRAVEL = 0.01  # m


@dataclass(frozen=True, slots=True)
class Tip:
    """A fingertip's place on a body: origin (3,) m on the finger's face and axes (3, 3), columns x out of the pad, y,
    z towards the wrist, in the body's frame."""

    body: int
    origin: np.ndarray
    axes: np.ndarray

    @property
    def front(self) -> np.ndarray:
        """(3,) m, the middle of the pad's face."""
        return self.origin + thickness() * self.axes[:, 0]


@dataclass(frozen=True, slots=True)
class Closing:
    """Postures by opening. tips: left and right. axes (3, 3): columns u, across, up, in the world of the gripper's own
    file; centre (3,) m: between the fingertips at opening `parallel`, m. openings (n,) m, rising. qpos (n, nq).
    controls (n, k): the coordinates. centres (n, 3) m: between the fingertips, from `centre` along `axes`. tilt (n,)
    rad: the larger of the two fingertips' from facing along u. wedges: rad, of the fingertips on their faces."""

    fingers: tuple[Finger, Finger]
    tips: tuple[Tip, Tip]
    axes: np.ndarray
    centre: np.ndarray
    parallel: float
    openings: np.ndarray
    qpos: np.ndarray = field(repr=False)
    controls: np.ndarray = field(repr=False)
    centres: np.ndarray = field(repr=False)
    tilt: np.ndarray = field(repr=False)
    wedges: tuple[float, float]


def close(hand: Hand, start: Opposition) -> Closing:
    """The way of two fingers from as wide as they open, 85 mm at most, to as narrow. Raises GripperError for fingers
    that do not oppose or hardly move."""
    mechanism = hand.mechanism
    names = " and ".join(repr(finger.name) for finger in start.fingers)
    if max(start.wedges) > MOST_WEDGE:
        raise GripperError(
            f"the faces of {names} do not oppose each other: they are {np.degrees(max(start.wedges)):.0f} degrees off "
            f"at best; name other fingertips, or their pads{_hint(hand, start.fingers)}"
        )
    mechanism.pose(start.values)
    tips = []
    for finger, sign in zip(start.fingers, (1, -1), strict=True):
        _, body = mechanism.place(finger.body)
        x, z = sign * start.axes[:, 0], start.axes[:, 2]
        tips.append(Tip(finger.body, finger.face.centre, body.T @ np.stack([x, np.cross(z, x), z], axis=1)))
    walk = _Walk(hand, (tips[0], tips[1]), start.axes, moved_by(start.fingers))
    first = walk.measure(start.values)
    wider = walk.go(
        start.values, first, np.arange(first + _GRID, MAX_OPENING + _GRID, _GRID).clip(max=MAX_OPENING)
    )
    narrower = walk.go(start.values, first, np.arange(first - _GRID, -_GRID, -_GRID).clip(min=0.0))
    postures = [*reversed(narrower), start.values, *wider]
    openings = np.array([walk.measure(values) for values in postures])
    keep = np.concatenate([[True], np.diff(openings) > 1e-5])
    postures, openings = [p for p, k in zip(postures, keep, strict=True) if k], openings[keep]
    if len(openings) < 3 or openings[-1] - openings[0] < _LEAST_TRAVEL:
        raise GripperError(
            f"{names} move by {1e3 * np.ptp(openings):.1f} mm between {1e3 * openings[0]:.1f} and "
            f"{1e3 * openings[-1]:.1f} mm: name the closing actuators or other fingertips{_hint(hand, start.fingers)}"
        )
    postures = _along(hand, start.fingers, postures)
    walked = [walk.middle_and_tilt(values) for values in postures]
    base = walk.middle_and_tilt(start.values)[0]
    return Closing(
        start.fingers,
        (tips[0], tips[1]),
        start.axes,
        base,
        first,
        openings,
        np.array([mechanism.pose(values) for values in postures]),
        np.array(postures),
        np.array([(centre - base) @ start.axes for centre, _ in walked]),
        np.array([tilt for _, tilt in walked]),
        start.wedges,
    )


def _hint(hand: Hand, fingers: tuple[Finger, Finger]) -> str:
    """What else may be wrong where fingers hardly move, or not towards each other."""
    return angle_hint([hand.mechanism.coordinates[number] for number in moved_by(fingers)])


def _along(hand: Hand, fingers: tuple[Finger, Finger], postures: list[np.ndarray]) -> list[np.ndarray]:
    """The postures with the other digits doing what the nearer of the two fingers does, each actuator the same share of
    its range, counted from the tips."""
    mechanism = hand.mechanism
    mechanism.show(mechanism.reference)
    places = mechanism.data.xpos.copy()
    taken = {number for finger in fingers for number in finger.moves}
    table = np.array(postures)
    span = mechanism.high - mechanism.low
    for tip in hand.tips:
        free = [number for number in hand.moves(tip) if number not in taken]
        if hand.digit(tip) in [finger.digit for finger in fingers] or not free:
            continue
        here = places[hand.root(tip)]
        leader = min(
            (finger for finger in fingers if finger.moves),
            key=lambda finger, here=here: float(np.linalg.norm(places[hand.root(finger.body)] - here)),
        )
        for follower, leading in zip(
            _from_the_tip(hand, free), _from_the_tip(hand, leader.moves), strict=False
        ):
            share = (table[:, leading] - mechanism.low[leading]) / span[leading]
            if _mirrored(mechanism.low[follower], mechanism.high[follower]) != _mirrored(
                mechanism.low[leading], mechanism.high[leading]
            ):
                share = 1 - share
            table[:, follower] = mechanism.low[follower] + share * span[follower]
    return list(table)


def _from_the_tip(hand: Hand, numbers: Sequence[int]) -> list[int]:
    """Coordinates by the depth of the joints that they move, the furthest first."""

    def depth(number: int) -> int:
        moved = np.flatnonzero(hand.mechanism.coordinates[number].slope)
        return max(int(hand.model.dof_bodyid[dof]) for dof in moved)

    return sorted(numbers, key=depth, reverse=True)


def _mirrored(low: float, high: float) -> bool:
    """Whether a range goes the negative way."""
    return abs(low) > abs(high)


class _Walk:
    """Two fingertips along their way. chosen: the coordinates that move them."""

    def __init__(self, hand: Hand, tips: tuple[Tip, Tip], axes: np.ndarray, chosen: list[int]) -> None:
        self.mechanism, self.tips, self.axes, self.chosen = hand.mechanism, tips, axes, chosen

    def spots(self) -> tuple[np.ndarray, ...]:
        found = []
        for tip in self.tips:
            origin, axes = self.mechanism.place(tip.body)
            found += [origin + axes @ tip.front, axes @ tip.axes[:, 0]]
        return tuple(found)

    def measure(self, values: np.ndarray) -> float:
        """m, the opening of a posture."""
        self.mechanism.pose(values)
        a, _, b, _ = self.spots()
        return float((b - a) @ self.axes[:, 0])

    def middle_and_tilt(self, values: np.ndarray) -> tuple[np.ndarray, float]:
        """The middle between the fingertips (3,) m, and the larger tilt in rad."""
        self.mechanism.pose(values)
        a, n, b, m = self.spots()
        u = self.axes[:, 0]
        return (a + b) / 2, float(np.arccos(np.clip(min(n @ u, -(m @ u)), -1, 1)))

    def go(self, start: np.ndarray, first: float, openings: np.ndarray) -> list[np.ndarray]:
        """Postures of these openings, one after the other, as far as they are reached, and the last one short of it."""
        middle, found, last, at = self.middle_and_tilt(start)[0], [], start, first
        for opening in openings:
            values = self._posture(opening, last, middle)
            reached = self.measure(values)
            if abs(reached - at) < _REACHED / 3:
                break
            found.append(values)
            last, at = values, reached
            if abs(reached - opening) > _REACHED:
                break
        return found

    def _posture(self, opening: float, last: np.ndarray, middle: np.ndarray) -> np.ndarray:
        mechanism, chosen = self.mechanism, self.chosen
        low, high = mechanism.low[chosen], mechanism.high[chosen]
        u = self.axes[:, 0]

        def residuals(part: np.ndarray) -> np.ndarray:
            values = last.copy()
            values[chosen] = part
            mechanism.pose(values)
            a, n, b, m = self.spots()
            way = b - a
            return np.concatenate(
                [
                    ((way @ u - opening) / _EXACT, ((a + b) / 2 - middle) @ u / _EVEN),
                    ((a + b) / 2 - middle) @ self.axes[:, 1:] / _STEADY,
                    way @ self.axes[:, 1:] / _CLOSE,
                    (n - u) / _ALIGNED,
                    (m + u) / _ALIGNED,
                    _LOOSE * (part - last[chosen]) / (high - low),
                ]
            )

        values = last.copy()
        values[chosen] = least(residuals, last[chosen], low, high)[0]
        return values
