"""What fingertips feel, drawn into a scene of MuJoCo's own viewer or Renderer."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from .scene import PadPlace

FULL_DROP = 10.0
"""K of temperature drop, either way, at which the colour is as cold or as hot as it gets."""
FULL_VOLTAGE = 0.01
"""V at which the bar is as long as the pad is wide, times _LONGEST."""

_COLD, _EVEN, _HOT = np.array([0.1, 0.35, 1.0]), np.array([0.85, 0.85, 0.85]), np.array([1.0, 0.25, 0.1])
_PLATE, _WIDER, _BAR, _LONGEST = 0.0015, 1.2, 0.002, 3.0
# half thickness m of a plate, its sides over the pad's; half thickness m of a bar, its longest over the pad's side


def colour(drop: float) -> np.ndarray:
    """(4,) of a temperature drop, K: blue where the fingertip loses heat, grey at none, red where it gains."""
    share = min(abs(drop) / FULL_DROP, 1.0)
    end = _COLD if drop > 0 else _HOT
    return np.append(_EVEN + share * (end - _EVEN), 1.0)


def draw_fingertips(
    scene: mujoco.MjvScene,
    data: mujoco.MjData,
    pads: Sequence[PadPlace],
    drops: np.ndarray,
    voltages: np.ndarray,
) -> int:
    """Adds a plate round each pad, coloured by its temperature drop (F,) K, and above it a bar as long as its voltage
    (F,) V says. Returns how many geoms were added; a scene that is full takes no more."""
    before = scene.ngeom
    for pad, drop, volts in zip(pads, drops.tolist(), voltages.tolist(), strict=True):
        turn = data.xmat[pad.body].reshape(3, 3)
        axes = turn @ pad.axes
        middle = data.xpos[pad.body] + turn @ pad.position
        tint = colour(drop) if np.isfinite(drop) else np.array([1.0, 1.0, 0.0, 1.0])
        half = np.array([_PLATE, *(_WIDER * pad.size / 2)])
        _box(scene, middle - _PLATE * axes[:, 0], axes, half, tint)
        length = min(abs(volts) / FULL_VOLTAGE, 1.0) * _LONGEST * pad.size[1] if np.isfinite(volts) else 0.0
        if length > 0:
            start = middle - 3 * _PLATE * axes[:, 0] + _WIDER * axes[:, 2] * pad.size[1] / 2
            bar = np.array([_BAR, _BAR, length / 2])
            _box(scene, start + axes[:, 2] * length / 2, axes, bar, tint)
    return scene.ngeom - before


def _box(
    scene: mujoco.MjvScene, at: np.ndarray, axes: np.ndarray, half: np.ndarray, rgba: np.ndarray
) -> None:
    if scene.ngeom >= scene.maxgeom:
        return
    geom = scene.geoms[scene.ngeom]
    mujoco.mjv_initGeom(
        geom, mujoco.mjtGeom.mjGEOM_BOX, half, at, np.ascontiguousarray(axes).ravel(), rgba.astype(np.float32)
    )
    geom.category = mujoco.mjtCatBit.mjCAT_DECOR
    scene.ngeom += 1
