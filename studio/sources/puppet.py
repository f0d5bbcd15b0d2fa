"""The gripper's picture where nothing is simulated: moved as a recording or a real gripper tells."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from typing import Any

import mujoco

from thermograsp.envs import ObjectSpec, build_scene
from thermograsp.studio.sources.shapes import poses_of, shapes_of

_OBJECT = "object"
_SIDE = 0.04  # m, of a cube that is not shown


class Puppet:
    """A gripper over a table. width: m, of the cube between its fingers; None for none, as what lies there is not
    known."""

    def __init__(self, width: float | None) -> None:
        self._width = width
        side = width or _SIDE
        self._model = build_scene((ObjectSpec(name=_OBJECT, size=(side, side, side)),))
        self._data = mujoco.MjData(self._model)

    def shapes(self) -> list[dict[str, Any]]:
        """See shapes.py."""
        shapes = shapes_of(self._model, (_OBJECT,))
        return [shape for shape in shapes if self._width is not None or shape["part"] != _OBJECT]

    def poses(self, opening: float, height: float, lift: float) -> list[list[float]]:
        """The bodies' poses, with the fingers `opening` m apart, the arm at `height` m and the cube `lift` m up."""
        mujoco.mj_resetData(self._model, self._data)
        for finger in ("finger_left", "finger_right"):
            self._data.joint(finger).qpos[0] = opening / 2
        self._data.joint("lift").qpos[0] = height
        self._data.joint(f"{_OBJECT}_free").qpos[2] += lift
        return poses_of(self._model, self._data)
