"""A robot's description: an MJCF file or an MjSpec, compiled, or an error that says what is wrong with it."""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import os
import re
from pathlib import Path

import mujoco

from thermograsp.errors import GripperError

_LACKING = re.compile(r"Error opening file '([^']*)'")

Source = str | os.PathLike[str] | mujoco.MjSpec


def compiled(source: Source) -> tuple[str, mujoco.MjModel]:
    """A gripper's name and model. Raises GripperError for what is missing, is no MJCF, or does not compile, with
    MuJoCo's reason."""
    if isinstance(source, mujoco.MjSpec):
        name, spec = source.modelname or "MjSpec", source  # a copy would lose what refers to nothing
    elif not isinstance(source, str | os.PathLike):
        raise GripperError(
            f"gripper {source!r}: give an MJCF file, a mujoco.MjSpec, or what load_gripper returned"
        )
    else:
        path = Path(source)
        name, spec = path.name, _parsed(path)
    try:
        model = spec.compile()
    except ValueError as error:
        lacking = _LACKING.search(str(error))
        if lacking:
            raise GripperError(
                f"{name} refers to a file that is not there, {lacking[1]}: put it where the file looks for it, its own "
                "folder or the meshdir or assetdir of its <compiler>"
            ) from None
        raise GripperError(
            f"{name} does not compile ({_line(error)}); a fragment that another file includes must be completed "
            "first, e.g. as an MjSpec"
        ) from None
    return name, model


def _parsed(path: Path) -> mujoco.MjSpec:
    if not path.exists():
        raise GripperError(f"no file {path}: give an MJCF file (.xml) or a mujoco.MjSpec")
    if not path.is_file():
        raise GripperError(f"{path} is a folder: give the MJCF file (.xml) in it")
    start = path.read_bytes()[:4096].lstrip(b"\xef\xbb\xbf \t\r\n")
    if not start.startswith(b"<"):
        raise GripperError(f"{path} is not XML; it begins with {start[:20]!r}: give an MJCF file")
    try:
        return mujoco.MjSpec.from_file(str(path))
    except ValueError as error:
        lacking = _LACKING.search(str(error))
        if lacking:
            raise GripperError(
                f"{path} includes a file that is not there, {lacking[1]}: put it into the same folder"
            ) from None
        raise GripperError(f"{path} is no MJCF that MuJoCo reads ({_line(error)})") from None


def _line(error: Exception) -> str:
    return " ".join(str(error).split())
