"""Fingers of a mechanism: which bodies close on which, and their flat pads.

A link is a group of bodies that no driven joint parts, named by its first body; a digit is a branch of moving links on
the palm. Joints that nothing drives stand still.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import mujoco
import numpy as np

from thermograsp.errors import GripperError, InvalidValueError, unknown_name

from .faces import Face, flat_faces, largest_face, triangles
from .gripper_mechanism import Mechanism

SMALLEST_FACE = 20e-6  # m2
_ASIDE = 0.02  # m off a finger's way at which a face counts half
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


class Hand:
    """Links of a mechanism. palm: number of the body that they all sit on."""

    def __init__(self, mechanism: Mechanism) -> None:
        self.mechanism, self.model = mechanism, mechanism.model
        model = self.model
        driven = {int(model.dof_bodyid[dof]) for dof in np.flatnonzero(mechanism.moved)}
        self._weld = np.zeros(model.nbody, int)
        for body in range(1, model.nbody):
            self._weld[body] = body if body in driven else self._weld[model.body_parentid[body]]
        self.moving = sorted(driven)
        self._parts: dict[int, list[tuple[str, np.ndarray]]] = {}
        self._moves: dict[int, tuple[int, ...]] = {}
        self.palm = self._palm()
        self.tips = [
            link
            for link in self.moving
            if self.below(self.palm, link)
            and not any(other != link and self.below(link, other) for other in self.moving)
        ]

        # A wrist stays where it is.
        wrist = list(mechanism.moves(self.palm))
        mechanism.middle[wrist] = mechanism.first[wrist]
        self._wrist = frozenset(wrist)

    def below(self, ancestor: int, body: int) -> bool:
        """Whether the body is the ancestor or hangs on it."""
        while body != ancestor and body:
            body = self.model.body_parentid[body]
        return body == ancestor

    def link(self, first: int) -> list[int]:
        """The bodies of a link, in the case of the palm only those that hang together with it."""
        inside = [int(b) for b in np.flatnonzero(self._weld == self._weld[first])]
        if self._weld[first] == 0:
            trunk = self._trunk(first)
            inside = [b for b in inside if b == first or (trunk and self.below(trunk, b))]
        return inside

    def digit(self, body: int) -> int:
        """The first body of the branch on the palm that the body is on, the palm for what is none."""
        last = body
        while body and body != self.palm:
            last, body = body, self.model.body_parentid[body]
        return last if body == self.palm else self.palm

    def _trunk(self, body: int) -> int:
        """The body directly on the world that carries this one, 0 for the world."""
        last = body
        while body:
            last, body = body, self.model.body_parentid[body]
        return last

    def _palm(self) -> int:
        """The first body with two moving branches; where there is one only, the parent of its last moving link."""
        children: dict[int, list[int]] = {}
        for body in range(1, self.model.nbody):
            if any(self.below(body, link) for link in self.moving):
                children.setdefault(int(self.model.body_parentid[body]), []).append(body)
        at = 0
        while len(children.get(at, ())) == 1:
            at = children[at][0]
        if at in children:
            return at
        return int(self.model.body_parentid[self._weld[at]])

    def joints(self) -> list[int]:
        """The driven joints of the fingers."""
        model, driven = self.model, np.flatnonzero(self.mechanism.moved)
        found = {int(model.dof_jntid[dof]) for dof in driven}
        on_palm = (j for j in found if model.jnt_bodyid[j] != self.palm)
        return sorted(j for j in on_palm if self.below(self.palm, int(model.jnt_bodyid[j])))

    def parts(self, first: int) -> list[tuple[str, np.ndarray]]:
        """Geoms of a link with their triangles (n, 3, 3) m in its first body's frame."""
        if first not in self._parts:
            self._parts[first] = parts_of(self.model, self.link(first), first)
        return self._parts[first]

    def moves(self, body: int) -> tuple[int, ...]:
        """Which coordinates move the body on the palm."""
        if body not in self._moves:
            self._moves[body] = tuple(n for n in self.mechanism.moves(body) if n not in self._wrist)
        return self._moves[body]

    def middle(self, first: int) -> np.ndarray:
        """(3,) m, of a link's geoms, in its first body's frame."""
        corners = [shape.reshape(-1, 3) for _, shape in self.parts(first)]
        if not corners:
            return np.zeros(3)
        every = np.concatenate(corners)
        return (every.min(axis=0) + every.max(axis=0)) / 2

    def tip_of(self, name: str) -> int:
        """The last link of the digit that a body's name tells, or a part of one: of its first body's, or else of any's.
        Raises UnknownNameError, or InvalidValueError for what names several."""
        model = self.model
        bodies = {model.body(b).name: b for b in range(1, model.nbody) if model.body(b).name}
        if name in bodies:
            body = bodies[name]
            if self._weld[body] in self.moving:
                below = [tip for tip in self.tips if self.below(int(self._weld[body]), tip)]
                return below[0] if len(below) == 1 else int(self._weld[body])
            return body
        part = name.lower()
        roots = {tip for tip in self.tips if part in model.body(self.digit(tip)).name.lower()}
        anywhere = {
            tip
            for tip in self.tips
            for found, b in bodies.items()
            if part in found.lower() and self._on(b, tip)
        }
        tips = roots or anywhere
        if len(tips) > 1:
            names = [model.body(tip).name for tip in sorted(tips)]
            raise InvalidValueError(
                f"{name!r} names several digits, with the tips {names}: give one body's name"
            )
        if not tips:
            raise unknown_name("finger or body", name, bodies)
        return tips.pop()

    def others(self, body: int) -> list[int]:
        """The tips of other digits than the body's; the palm for a lone jaw, and for a body of the palm every tip."""
        found = [tip for tip in self.tips if tip != body and self.digit(tip) != self.digit(body)]
        return found or [self.palm]

    def _on(self, body: int, tip: int) -> bool:
        """Whether the body belongs to the tip's digit."""
        return self.below(body, tip) and self.digit(body) == self.digit(tip) and body != self.palm

    def closing(self, body: int, other: int) -> np.ndarray:
        """(3,) m, world: which way the body's middle goes when it approaches the other one with all actuators, and how
        far over their ranges. Zero where nothing moves it."""
        mechanism = self.mechanism
        here, there = self.middle(body), self.middle(other)

        def place() -> tuple[np.ndarray, np.ndarray]:
            (p, r), (q, s) = mechanism.place(body), mechanism.place(other)
            return p + r @ here, q + s @ there

        mechanism.pose(mechanism.middle)
        first, target = place()
        way = (target - first) / max(float(np.linalg.norm(target - first)), 1e-9)
        moved = np.zeros(3)
        for number in self.moves(body):
            coordinate, values = mechanism.coordinates[number], mechanism.middle.copy()
            step = _STEP * (coordinate.high - coordinate.low)
            values[number] += step
            mechanism.pose(values)
            rate = (place()[0] - first) / step * (coordinate.high - coordinate.low)
            moved += rate * float(rate @ way)
        approach = np.sqrt(max(float(moved @ way), 0.0))
        length = float(np.linalg.norm(moved))
        return moved * approach / length if approach > 1e-6 else np.zeros(3)

    def finger(
        self, body: int, other: int, pad: Pad | None = None, facing: Finger | None = None
    ) -> Finger | None:
        """The body as a finger that closes on the other one; None where no flat face looks that way. pad: where it is,
        if not to be found. facing: the other one, for a body that does not move and has faces of all kinds. Raises
        UnknownNameError or GripperError for a pad that is none."""
        model, mechanism = self.model, self.mechanism
        way = self.closing(body, other)
        approach = float(np.linalg.norm(way))
        if not approach:
            way = -self.closing(other, body)
        if not way.any():
            return None
        way = way / np.linalg.norm(way)
        mechanism.pose(mechanism.middle)
        _, axes = mechanism.place(body)
        parts = self.parts(body)
        if facing is not None and pad is None and not approach:
            face = self._opposite(parts, body, facing, way)
        else:
            face = chosen_face(parts, pad, axes.T @ way, model.body(body).name)
        if face is None or face.area < SMALLEST_FACE:
            return None
        along = self._along(body, face)
        name = model.body(body).name or f"#{body}"
        return Finger(body, name, self.digit(body), self.moves(body), face, along, approach)

    def _opposite(
        self, parts: list[tuple[str, np.ndarray]], body: int, facing: Finger, way: np.ndarray
    ) -> Face | None:
        """Of a body that stands still, the largest face that a moving finger comes to meet; way: world, out of it."""
        mechanism = self.mechanism
        origin, axes = mechanism.place(body)
        spots = []
        for end in (mechanism.low, mechanism.high):
            values = mechanism.middle.copy()
            values[list(facing.moves)] = end[list(facing.moves)]
            mechanism.pose(values)
            there, turned = mechanism.place(facing.body)
            spots.append(axes.T @ (there + turned @ facing.face.centre - origin))
        way = axes.T @ way
        start = max(spots, key=lambda spot: float(spot @ way))
        met = []
        for face in flat_faces(parts, way):
            ahead = start - face.centre
            aside = float(np.linalg.norm(ahead - (ahead @ way) * way))
            if ahead @ way > 0:
                met.append((face.area / (1 + (aside / _ASIDE) ** 2), face))
        return max(met, key=lambda one: one[0])[1] if met else None

    def _along(self, body: int, face: Face) -> np.ndarray:
        """From the first joint of the digit to the face, in the body's frame and across the face's normal."""
        mechanism = self.mechanism
        mechanism.pose(mechanism.middle)
        root = self.digit(body)
        chain = [link for link in self.moving if self.below(root, link) and self.below(link, body)]
        start = mechanism.data.xpos[chain[0] if chain and root != self.palm else self.palm]
        origin, axes = mechanism.place(body)
        way = face.centre - axes.T @ (start - origin)
        way = way - (way @ face.normal) * face.normal
        length = float(np.linalg.norm(way))
        return way / length if length > 1e-6 else np.zeros(3)


def parts_of(model: mujoco.MjModel, bodies: Sequence[int], first: int) -> list[tuple[str, np.ndarray]]:
    """Geoms of bodies with their triangles (n, 3, 3) m in the first body's frame, joints at rest."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    origin, axes = data.xpos[first], data.xmat[first].reshape(3, 3)
    found = []
    for body in bodies:
        there, turned = data.xpos[body], data.xmat[body].reshape(3, 3)
        for geom in range(model.body_geomadr[body], model.body_geomadr[body] + model.body_geomnum[body]):
            shape = triangles(model, geom)
            if len(shape):
                name = model.geom(geom).name or f"#{geom}"
                found.append((name, (shape @ turned.T + there - origin) @ axes))
    return found


def chosen_face(
    parts: list[tuple[str, np.ndarray]], pad: Pad | None, direction: np.ndarray, body: str
) -> Face | None:
    """The face that is named, placed or found."""
    if pad is None:
        return largest_face(flat_faces(parts, direction), direction)
    if isinstance(pad, str):
        own = [(name, shape) for name, shape in parts if name == pad]
        if not own:
            raise unknown_name(f"geom with faces on {body!r}", pad, [name for name, _ in parts])
        face = largest_face(flat_faces(own, direction), direction)
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
        first = hand.finger(a, b, pads[0])
        second = hand.finger(b, a, pads[1], first)
        if first is not None and second is not None:
            found.append((first, second))
    if not found:
        names = [hand.model.body(tip).name for tip in tips]
        raise GripperError(
            f"no two of the links {names} have flat faces that close on each other: name the two fingertips' bodies, "
            "and where their pads are (pads)"
        )
    return found


def named_pair(hand: Hand, names: Sequence[str], pads: Sequence[Pad | None]) -> tuple[Finger, Finger]:
    """The two named fingers. Raises UnknownNameError, InvalidValueError, or GripperError where one has no flat face."""
    if len(names) != 2 or len(set(names)) < 2:
        raise InvalidValueError(f"fingertips {tuple(names)}: name two that close on each other")
    a, b = (hand.tip_of(name) for name in names)
    fingers: list[Finger] = []
    still_last = [(a, b, pads[0]), (b, a, pads[1])]
    if not hand.moves(a):
        still_last.reverse()
    for body, other, pad in still_last:
        finger = hand.finger(body, other, pad, fingers[0] if fingers else None)
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
