"""What mechanics asks of a gripper, and the shipped one's answers (assets/gripper.xml)."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Protocol

import mujoco
import numpy as np

from ...assets import asset
from ..limits import MAX_FORCE, MAX_OPENING

if TYPE_CHECKING:
    from ..bodies import ObjectSpec


class GripperModel(Protocol):
    """A gripper over the table. joints: the two whose positions add up to the opening, m. widest: the largest opening,
    m. strongest: the largest closing force, N. A scene with it has a body `wrist` on a joint `lift` with an actuator of
    that name, a servo `grip` of the opening, fingertips `tip_left` and `tip_right` with sites `pad_left` and
    `pad_right`."""

    @property
    def joints(self) -> tuple[str, str]:
        """See above."""
        ...

    @property
    def widest(self) -> float:
        """See above."""
        ...

    @property
    def strongest(self) -> float:
        """See above."""
        ...

    def scene(self) -> mujoco.MjSpec:
        """Gripper and table without objects, a spec of the caller's own."""
        ...

    def wrist_at(self, item: ObjectSpec) -> np.ndarray:
        """(3,) m, where the wrist is when it is down over an object at the origin."""
        ...

    def rest(self, model: mujoco.MjModel, opening: float) -> tuple[np.ndarray, np.ndarray]:
        """Addresses in qpos of the fingers' joints, and their values at that opening (m)."""
        ...


class ShippedGripper:
    """Two fingers that slide along x."""

    joints = ("finger_left", "finger_right")
    widest = MAX_OPENING
    strongest = MAX_FORCE

    def scene(self) -> mujoco.MjSpec:
        """See GripperModel."""
        return _parsed().copy()

    def wrist_at(self, item: ObjectSpec) -> np.ndarray:
        """See GripperModel."""
        return np.array([0.0, 0.0, item.grasp_height])

    def rest(self, model: mujoco.MjModel, opening: float) -> tuple[np.ndarray, np.ndarray]:
        """See GripperModel."""
        return np.array([model.joint(name).qposadr[0] for name in self.joints]), np.full(2, opening / 2)


@cache
def _parsed() -> mujoco.MjSpec:
    """The parsed gripper; compile copies only."""
    return mujoco.MjSpec.from_file(str(asset("gripper.xml")))


SHIPPED_GRIPPER = ShippedGripper()
