"""OpenGL to draw into, with a screen or without one."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import os
from typing import Any

from thermograsp.errors import MissingDependencyError

_HELP = (
    "on Debian or Ubuntu: apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri libopengl0 (software rendering, no "
    "screen needed); MUJOCO_GL=egl, osmesa or glfw chooses the library"
)


def offscreen(model: Any, width: int, height: int) -> tuple[Any, Any]:
    """A context of OpenGL, made current, and buffers in it to draw frames of a mujoco.MjModel into; free both. Raises
    MissingDependencyError where there is no OpenGL, and says what to install."""
    context = None
    try:
        import mujoco

        context = _context(width, height)
        context.make_current()
        buffers = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, buffers)
    except Exception as error:  # whatever the platform's OpenGL raises
        if context is not None:
            context.free()
        raise MissingDependencyError(f"no OpenGL to render with ({error}); {_HELP}") from error
    return context, buffers


def _context(width: int, height: int) -> Any:
    """MuJoCo's choice of OpenGL where MUJOCO_GL names one or there is a screen, else EGL.

    mujoco decides when it is imported, and without a screen its default (glfw) fails.
    """
    if os.environ.get("MUJOCO_GL") or has_display():
        import mujoco

        return mujoco.GLContext(width, height)
    from mujoco.egl import GLContext

    return GLContext(width, height)


def has_display() -> bool:
    """Whether there is a screen to open a window on."""
    return (
        os.name == "nt"
        or os.uname().sysname == "Darwin"
        or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
    )
