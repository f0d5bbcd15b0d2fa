"""An OpenGL context to draw into, with a screen or without one."""

from __future__ import annotations

import os
from typing import Any


def gl_context(width: int, height: int) -> Any:
    """MuJoCo's choice of OpenGL where MUJOCO_GL names one or there is a screen, else EGL.

    mujoco decides when it is imported, and without a screen its default (glfw) fails.
    """
    if os.environ.get("MUJOCO_GL") or has_display():
        import mujoco

        return mujoco.GLContext(width, height)  # pyright: ignore[reportAttributeAccessIssue]
    from mujoco.egl import GLContext

    return GLContext(width, height)


def has_display() -> bool:
    """Whether there is a screen to open a window on."""
    return (
        os.name == "nt"
        or os.uname().sysname == "Darwin"
        or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
    )
