"""Two fingers in the posture in which they oppose each other best, and how well that is.

Found by bounded least squares over the actuators that move the two.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..limits import PAD_SIDE
from .fingers import Finger, moved_pad
from .fingertip import thickness
from .hand import Hand

# What weighs one in a posture: of the opening m, beside each other m, out of parallel rad, off the ranges' middles.
_PRECISE, _ASIDE, _PARALLEL, _CENTRED = 3e-3, 1e-2, 0.2, 10.0
# What weighs one in the cost of a pair: wedges rad, misses m; and what takes one off: approach m.
_WEDGE, _MISS, _APPROACH = 0.5, 1e-2, 3e-2
_FULL, _SMALL = 4e-4, 0.05  # m2 of a face that is as large as our pad; cost of one that is half as large
_STARTS = (0.5, 0.25, 0.75)  # of the ranges, where a search begins
_FAR = 0.04  # m of approach, beyond which more is no better


@dataclass(frozen=True, slots=True)
class Opposition:
    """Two fingers in the posture in which they oppose each other best near an opening. values: the coordinates. axes
    (3, 3): columns from the first finger to the second, across, up, world. wedges: rad, of the faces off that line.
    cost: of how well that is, less is better."""

    fingers: tuple[Finger, Finger]
    values: np.ndarray
    axes: np.ndarray
    wedges: tuple[float, float]
    cost: float


def promising(
    hand: Hand, pairs: Sequence[tuple[Finger, Finger]], opening: float
) -> list[tuple[Finger, Finger]]:
    """The pairs that oppose each other best at a first look, the best first."""
    if len(pairs) == 1:
        return list(pairs)
    return sorted(pairs, key=lambda pair: _opposed(hand, pair, opening, _shares(hand, pair)[:1]).cost)


def oppose(hand: Hand, fingers: tuple[Finger, Finger], opening: float) -> Opposition:
    """The best posture of two fingers about `opening` (m), their pads at the ends of their faces."""
    left, right = fingers
    fingers = _at_the_end(left), _at_the_end(right)
    found = _opposed(hand, fingers, opening, _shares(hand, fingers))
    for _ in range(2):  # let the pads meet, as far as their faces go
        fingers = _facing(hand, found)
        found = _opposed(hand, fingers, opening, [found.values[moved_by(fingers)]])
    return found


def _shares(hand: Hand, fingers: tuple[Finger, Finger]) -> list[np.ndarray]:
    """Postures where a search begins."""
    chosen = moved_by(fingers)
    low, high = hand.mechanism.low[chosen], hand.mechanism.high[chosen]
    return [low + share * (high - low) for share in _STARTS]


def _at_the_end(finger: Finger) -> Finger:
    over = finger.face.extent(finger.along) - PAD_SIDE / 2
    return moved_pad(finger, over * finger.along) if over > 0 else finger


def _opposed(
    hand: Hand, fingers: tuple[Finger, Finger], opening: float, starts: Sequence[np.ndarray]
) -> Opposition:
    mechanism, chosen = hand.mechanism, moved_by(fingers)
    low, high = mechanism.low[chosen], mechanism.high[chosen]

    def places(part: np.ndarray) -> tuple[np.ndarray, ...]:
        values = mechanism.middle.copy()
        values[chosen] = part
        mechanism.pose(values)
        found = []
        for finger in fingers:
            origin, axes = mechanism.place(finger.body)
            normal = axes @ finger.face.normal
            found += [origin + axes @ finger.face.centre + thickness() * normal, normal]
        return tuple(found)

    def residuals(part: np.ndarray) -> np.ndarray:
        a, n, b, m = places(part)
        way = b - a
        return np.concatenate(
            [
                ((way @ n - opening) / _PRECISE, (-(way @ m) - opening) / _PRECISE),
                (way - (way @ n) * n) / _ASIDE,
                (way - (way @ m) * m) / _ASIDE,
                (n + m) / _PARALLEL,
                ((part - low) / (high - low) - 0.5) / _CENTRED,
            ]
        )

    tried = [least(residuals, start, low, high) for start in starts]
    part = min(tried, key=lambda one: one[1])[0]
    values = mechanism.middle.copy()
    values[chosen] = part
    a, n, b, m = places(part)
    u = n - m
    u /= max(float(np.linalg.norm(u)), 1e-9)
    up = _up(hand, fingers, u, (a + b) / 2)
    axes = np.stack([u, np.cross(up, u), up], axis=1)
    way = b - a
    wedges = _angle(n, u), _angle(m, -u)
    offset = float(np.linalg.norm(way - (way @ u) * u))
    small = sum(_FULL / min(f.face.area, _FULL) - 1 for f in fingers)
    approach = sum(min(f.approach, _FAR) for f in fingers)
    missed = abs(float(way @ u) - opening)
    cost = sum(wedges) / _WEDGE + (offset + missed) / _MISS + _SMALL * small - approach / _APPROACH
    return Opposition(fingers, values, axes, wedges, cost)


def _angle(a: np.ndarray, b: np.ndarray) -> float:
    """rad, between two unit vectors."""
    return float(np.arccos(np.clip(a @ b, -1, 1)))


def _up(hand: Hand, fingers: tuple[Finger, Finger], u: np.ndarray, centre: np.ndarray) -> np.ndarray:
    """From the fingertips to the palm, across u, in the posture that is shown."""
    mechanism = hand.mechanism
    up = -sum(mechanism.place(finger.body)[1] @ finger.along for finger in fingers)
    up = up - (up @ u) * u
    if np.linalg.norm(up) < 0.3:
        origin, axes = mechanism.place(hand.palm)
        up = origin + axes @ hand.middle(hand.palm) - centre
        up = up - (up @ u) * u
    return up / max(float(np.linalg.norm(up)), 1e-9)


def _facing(hand: Hand, found: Opposition) -> tuple[Finger, Finger]:
    """The fingers with pads moved on their faces towards each other's."""
    mechanism, fingers = hand.mechanism, list(found.fingers)
    mechanism.pose(found.values)
    for number, share in ((0, 0.5), (1, 1.0), (0, 1.0)):
        spots = []
        for finger in fingers:
            origin, axes = mechanism.place(finger.body)
            spots.append(origin + axes @ finger.face.centre)
        way = spots[1 - number] - spots[number]
        u = found.axes[:, 0]
        shift = share * (way - (way @ u) * u)
        _, axes = mechanism.place(fingers[number].body)
        fingers[number] = moved_pad(fingers[number], axes.T @ shift)
    return fingers[0], fingers[1]


def moved_by(fingers: tuple[Finger, Finger]) -> list[int]:
    """The coordinates that move the two."""
    return sorted({number for finger in fingers for number in finger.moves})


def least(
    residuals: Callable[[np.ndarray], np.ndarray], start: np.ndarray, low: np.ndarray, high: np.ndarray
) -> tuple[np.ndarray, float]:
    """Bounded least squares in units of the ranges; the place, and half the squares there."""
    from scipy.optimize import least_squares  # only another gripper than the shipped one needs it

    span = high - low
    inside = np.clip((start - low) / span, 1e-6, 1 - 1e-6)
    found = least_squares(
        lambda x: residuals(low + x * span), inside, bounds=(0.0, 1.0), xtol=1e-9, max_nfev=40
    )
    return low + found.x * span, float(found.cost)
