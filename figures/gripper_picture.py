"""A gripper drawn: open over an object, and closed on it."""

from __future__ import annotations

import os

import numpy as np
from PIL import Image

from thermograsp.envs import (
    Gripper,
    Mechanics,
    ObjectSpec,
    Renderer,
)
from thermograsp.files import atomic_write

_CLOSING, _LIFTING = 1.4, 0.8  # s
_FORCE, _RATE = 10.0, 0.05  # N, m/s


def draw_gripper(
    path: str | os.PathLike[str], gripper: Gripper, object_width: float, width: int, height: int
) -> None:
    """Writes a PNG of two pictures of `width` x `height` pixels each. object_width: m. Raises MissingDependencyError
    where there is no OpenGL."""
    item = ObjectSpec(size=(object_width, object_width, object_width), mass=0.1)
    mechanics = Mechanics((item,), gripper=gripper)
    with Renderer(mechanics, width=width, height=height) as renderer:
        pictures = [renderer.frame()]
        for seconds, rate in ((_CLOSING, 0.0), (_LIFTING, _RATE)):
            for _ in range(round(seconds / 0.02)):
                mechanics.advance(np.zeros(1), np.full(1, _FORCE), np.full(1, rate))
        pictures.append(renderer.frame())
    with atomic_write(path) as temporary:
        Image.fromarray(np.concatenate(pictures, axis=1)).save(temporary)
