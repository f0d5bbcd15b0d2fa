"""MuJoCo without OpenGL: its import fails where MUJOCO_GL names a library that is not there; simulation needs none."""

from __future__ import annotations

import importlib
import os

from thermograsp.cli.shared.output import Output

_CHOICE = "MUJOCO_GL"


def load_mujoco(output: Output) -> None:
    """Imports mujoco; where the library that MUJOCO_GL names cannot be loaded, says so and goes on without pictures."""
    try:
        importlib.import_module("mujoco")
    except Exception as error:  # whatever PyOpenGL raises for a library that is missing or lacks another one
        choice = os.environ.get(_CHOICE)
        if not choice:
            raise
        output.warn(
            f"no pictures: {_CHOICE}={choice} cannot be loaded ({error}); unset it or install that library"
        )
        os.environ[_CHOICE] = "disabled"
        importlib.import_module("mujoco")
