"""Fingers: which links close on which, and where their flat pads are."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from thermograsp.errors import GripperError, InvalidValueError, unknown_name

from ...touch import Face, flat_faces, largest_face
from .hand import Hand
from .mechanism import angle_hint

SMALLEST_FACE = 20e-6  # m2
_ASIDE = 0.02  # m off a finger's way at which a face counts half
_LONGEST = 0.35  # m from the first joint of a digit to its pad; what is longer is an arm
_STEP = 1e-3  # of a coordinate's range, for derivatives

Pad = str | tuple[Sequence[float], Sequence[float]]
"""A geom's name, or a position (m) and a normal in the body's frame."""


@dataclass(frozen=True, slots=True)
class Finger:
    """A link that carries a fingertip. body: its number; name. digit: the first body of its branch on the palm.
    moves: the coordinates that move it. face: where the pad is, in the body's frame. along (3,): from the digit's root
    towards its tip, in the body's frame. approach: m that its middle can go towards the other finger's, about."""

    body: int
    name: str
    digit: int
    moves: tuple[int, ...]
    face: Face
    along: np.ndarray
    approach: float


def closing(hand: Hand, body: int, other: int) -> np.ndarray:
    """(3,) m, world: which way the body's middle goes when it approaches the other one with all actuators, and how
    far over their ranges. Zero where nothing moves it."""
    mechanism = hand.mechanism
    centre, other_centre = hand.middle(body), hand.middle(other)

    def place() -> tuple[np.ndarray, np.ndarray]:
        (p, r), (q, s) = mechanism.place(body), mechanism.place(other)
        return p + r @ centre, q + s @ other_centre

    mechanism.pose(mechanism.middle)
    first, target = place()
    way = (target - first) / max(float(np.linalg.norm(target - first)), 1e-9)
    moved = np.zeros(3)
    for number in hand.moves(body):
        coordinate, values = mechanism.coordinates[number], mechanism.middle.copy()
        step = _STEP * (coordinate.high - coordinate.low)
        values[number] += step
        mechanism.pose(values)
        rate = (place()[0] - first) / step * (coordinate.high - coordinate.low)
        moved += rate * float(rate @ way)
    approach = np.sqrt(max(float(moved @ way), 0.0))
    length = float(np.linalg.norm(moved))
    return moved * approach / length if approach > 1e-6 else np.zeros(3)


def finger_of(
    hand: Hand, body: int, other: int, pad: Pad | None = None, facing: Finger | None = None
) -> Finger | None:
    """The body as a finger that closes on the other one; None where no flat face looks that way. pad: where it is,
    if not to be found. facing: the other one, for a body that does not move and has faces of all kinds. Raises
    UnknownNameError or GripperError for a pad that is none."""
    model, mechanism = hand.model, hand.mechanism
    way = closing(hand, body, other)
    approach = float(np.linalg.norm(way))
    if not approach:
        way = -closing(hand, other, body)
    if not way.any():
        return None
    way = way / np.linalg.norm(way)
    mechanism.pose(mechanism.middle)
    _, axes = mechanism.place(body)
    parts = hand.parts(body)
    if facing is not None and pad is None and not approach:
        face = _opposite(hand, parts, body, facing, way)
    else:
        face = chosen_face(parts, pad, axes.T @ way, model.body(body).name)
    if face is None or face.area < SMALLEST_FACE:
        return None
    along = _along(hand, body, face)
    name = model.body(body).name or f"#{body}"
    return Finger(body, name, hand.digit(body), hand.moves(body), face, along, approach)


def _opposite(
    hand: Hand, parts: list[tuple[str, np.ndarray]], body: int, facing: Finger, way: np.ndarray
) -> Face | None:
    """Of a body that stands still, the largest face that a moving finger comes to meet; way: world, out of it."""
    mechanism = hand.mechanism
    origin, axes = mechanism.place(body)
    spots = []
    for end in (mechanism.low, mechanism.high):
        values = mechanism.middle.copy()
        values[list(facing.moves)] = end[list(facing.moves)]
        mechanism.pose(values)
        origin_facing, axes_facing = mechanism.place(facing.body)
        spots.append(axes.T @ (origin_facing + axes_facing @ facing.face.centre - origin))
    way = axes.T @ way
    start = max(spots, key=lambda spot: float(spot @ way))
    candidates = []
    for face in flat_faces(parts, way):
        ahead = start - face.centre
        aside = float(np.linalg.norm(ahead - (ahead @ way) * way))
        if ahead @ way > 0:
            candidates.append((face.area / (1 + (aside / _ASIDE) ** 2), face))
    return max(candidates, key=lambda one: one[0])[1] if candidates else None


def _along(hand: Hand, body: int, face: Face) -> np.ndarray:
    """From the first joint of the digit to the face, in the body's frame and across the face's normal."""
    mechanism = hand.mechanism
    mechanism.pose(mechanism.middle)
    start = mechanism.data.xpos[hand.root(body)]
    origin, axes = mechanism.place(body)
    way = face.centre - axes.T @ (start - origin)
    way = way - (way @ face.normal) * face.normal
    length = float(np.linalg.norm(way))
    return way / length if length > 1e-6 else np.zeros(3)


def chosen_face(
    parts: list[tuple[str, np.ndarray]], pad: Pad | None, direction: np.ndarray, body: str
) -> Face | None:
    """The face that is named, placed or found."""
    if pad is None:
        return largest_face(flat_faces(parts, direction), direction)
    if isinstance(pad, str):
        named = [(name, shape) for name, shape in parts if name == pad]
        if not named:
            raise unknown_name(f"geom with faces on {body!r}", pad, [name for name, _ in parts])
        face = largest_face(flat_faces(named, direction), direction)
        if face is None:
            raise GripperError(f"geom {pad!r} of {body!r} has no flat face towards the closing direction")
        return face
    position, normal = (np.asarray(part, float) for part in pad)
    length = float(np.linalg.norm(normal)) if normal.shape == (3,) else 0.0
    if position.shape != (3,) or not np.isfinite([*position, *normal]).all() or not length > 0:
        raise GripperError(f"pad {pad!r}: give a geom's name, or a position (m) and a normal, (x, y, z) each")
    return Face(position, normal / length, SMALLEST_FACE, position[None], "given")


def pairs(hand: Hand, pads: Sequence[Pad | None] = (None, None)) -> list[tuple[Finger, Finger]]:
    """Every two links that may close on each other. Raises GripperError where there are none."""
    tips = hand.tips
    if not tips:
        raise GripperError("no finger: nothing moves on the palm; name the closing actuators")
    two = list(combinations(tips, 2))
    two = [(a, b) for a, b in two if hand.digit(a) != hand.digit(b)]
    if not two:  # one jaw that closes on the palm
        two = [(tips[-1], hand.palm)]
    found = []
    for a, b in two:
        first = finger_of(hand, a, b, pads[0])
        second = finger_of(hand, b, a, pads[1], first)
        if first is not None and second is not None:
            found.append((first, second))
    if not found:
        names = [hand.model.body(tip).name for tip in tips]
        raise GripperError(
            f"no two of the links {names} have flat faces that close on each other: name the two fingertips' bodies, "
            f"and where their pads are (pads){angle_hint(hand.mechanism.coordinates)}"
        )
    return found


def of_one_hand(hand: Hand, found: Sequence[tuple[Finger, Finger]]) -> list[tuple[Finger, Finger]]:
    """The pairs whose digits are fingers. Raises GripperError where all are arms, long ones or with a hand each: then
    what closes is the two arms of a robot, or an arm that carries the hand, and no gripper that could be mounted."""
    kept = [
        pair
        for pair in found
        if max(_length(hand, finger) for finger in pair) <= _LONGEST
        and not all(_carries_a_hand(hand, finger.digit) for finger in pair)
    ]
    if not kept:
        names, lengths = zip(*((finger.name, _length(hand, finger)) for finger in found[0]), strict=True)
        raise GripperError(
            f"{names[0]!r} and {names[1]!r} close on each other by way of arms, {max(lengths):.2f} m from their first "
            f"joint on {hand.model.body(hand.palm).name!r}: they are not fingers of one hand. Name the actuators that "
            "close one hand alone (actuators), or give that hand's own file"
        )
    return kept


def _carries_a_hand(hand: Hand, digit: int) -> bool:
    """Whether a digit has two tips that move by themselves."""
    moves = [set(hand.moves(tip)) for tip in hand.tips if hand.digit(tip) == digit]
    return any(one - other and other - one for one, other in combinations(moves, 2))


def _length(hand: Hand, finger: Finger) -> float:
    """m, along the moving links from the first joint of the digit to the pad; 0 on the palm."""
    mechanism, model = hand.mechanism, hand.model
    mechanism.pose(mechanism.middle)
    root, body = hand.root(finger.body), finger.body
    if root == hand.palm:
        return 0.0
    origin, axes = mechanism.place(body)
    length, point = 0.0, origin + axes @ finger.face.centre
    while True:
        joint = mechanism.data.xpos[body].copy()
        length += float(np.linalg.norm(point - joint))
        if body in (root, 0):
            return length
        point, body = joint, int(model.body_parentid[body])


def named_pair(hand: Hand, names: Sequence[str], pads: Sequence[Pad | None]) -> tuple[Finger, Finger]:
    """The two named fingers. Raises UnknownNameError, InvalidValueError, or GripperError where one has no flat face."""
    if not isinstance(names, Sequence) or len(names) != 2 or len(set(names)) < 2:
        raise InvalidValueError(f"fingertips {names!r}: name two that close on each other")
    a, b = (hand.tip_of(name) for name in names)
    fingers: list[Finger] = []
    still_last = [(a, b, pads[0]), (b, a, pads[1])]
    if not hand.moves(a):
        still_last.reverse()
    for body, other, pad in still_last:
        finger = finger_of(hand, body, other, pad, fingers[0] if fingers else None)
        if finger is None:
            raise GripperError(
                f"{hand.model.body(body).name!r} has no flat face of {1e6 * SMALLEST_FACE:g} mm2 towards "
                f"{hand.model.body(other).name!r}: say where its pad is (pads), position and normal in its frame"
            )
        fingers.append(finger)
    first, second = fingers
    return (first, second) if second.body == hand.palm or first.body < second.body else (second, first)


def moved_pad(finger: Finger, shift: np.ndarray) -> Finger:
    """The finger with its pad's middle shifted (3,) m in the face's plane, as far as the face goes."""
    face = finger.face
    shift = shift - (shift @ face.normal) * face.normal
    length = float(np.linalg.norm(shift))
    if length < 1e-9:
        return finger
    way = shift / length
    reach = max(min(length, face.extent(way)), 0.0)
    return replace(finger, face=replace(face, centre=face.centre + reach * way))
