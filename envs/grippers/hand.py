"""Palm, links and digits of a mechanism.

A link is a group of bodies that no driven joint parts, named by its first body; a digit is a branch of moving links on
the palm. Joints that nothing drives stand still.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError, unknown_name

from ...touch import triangles
from .mechanism import Mechanism


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

    def root(self, body: int) -> int:
        """The first moving link of the digit that the body is on, the palm for what is none."""
        digit = self.digit(body)
        if digit == self.palm:
            return self.palm
        return next((n for n in self.moving if self.below(digit, n) and self.below(n, body)), self.palm)

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


def parts_of(model: mujoco.MjModel, bodies: Sequence[int], first: int) -> list[tuple[str, np.ndarray]]:
    """Geoms of bodies with their triangles (n, 3, 3) m in the first body's frame, joints at rest."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    origin, axes = data.xpos[first], data.xmat[first].reshape(3, 3)
    found = []
    for body in bodies:
        position, rotated = data.xpos[body], data.xmat[body].reshape(3, 3)
        for geom in range(model.body_geomadr[body], model.body_geomadr[body] + model.body_geomnum[body]):
            shape = triangles(model, geom)
            if len(shape):
                name = model.geom(geom).name or f"#{geom}"
                found.append((name, (shape @ rotated.T + position - origin) @ axes))
    return found
