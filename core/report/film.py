"""Pictures of a grasp in time: animations, strips, and the colours' bar."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from thermograsp.envs import GraspBatch
from thermograsp.envs.picture import temperatures
from thermograsp.envs.render import Renderer
from thermograsp.files import atomic_write

_GAP = 6  # pixels between the pictures of a strip


class Film:
    """Draws one row of a simulated batch every so many seconds of its time.

    plant: a simulated one. every: s. row: which grasp. low, high: degC, the colours' range.
    Raises MissingDependencyError, naming the packages, where there is no OpenGL.
    """

    def __init__(
        self,
        plant: Any,
        every: float,
        row: int = 0,
        *,
        camera: str = "closeup",
        size: tuple[int, int] = (480, 360),
        low: float = 20.0,
        high: float = 40.0,
    ) -> None:
        self._renderer = Renderer(plant.mechanics, width=size[0], height=size[1], low=low, high=high)
        self._row, self._camera, self.every = row, camera, every
        self.frames: list[np.ndarray] = []
        self.times: list[float] = []

    def watch(self, time: float, batch: GraspBatch) -> None:
        """Takes a picture where one is due; see recording.record."""
        if time < len(self.times) * self.every - batch.dt / 2:
            return
        celsius = temperatures(batch.reading, self._row)
        self.frames.append(self._renderer.frame(self._row, camera=self._camera, temperatures=celsius))
        self.times.append(time)

    def write(self, path: str | os.PathLike[str]) -> None:
        """An animation at the grasp's own speed (.gif, .webp), or all pictures in a row (.png)."""
        pictures = [Image.fromarray(frame) for frame in self.frames]
        with atomic_write(path) as temporary:
            if Path(path).suffix.lower() == ".png":
                strip(pictures).save(temporary)
            else:
                duration = round(1000 * self.every)
                pictures[0].save(
                    temporary, save_all=True, append_images=pictures[1:], duration=duration, loop=0
                )

    def close(self) -> None:
        """Frees OpenGL's buffers."""
        self._renderer.close()


def strip(pictures: list[Image.Image]) -> Image.Image:
    """Pictures of one size side by side."""
    width, height = pictures[0].size
    joined = Image.new("RGB", (len(pictures) * (width + _GAP) - _GAP, height), "white")
    for i, picture in enumerate(pictures):
        joined.paste(picture, (i * (width + _GAP), 0))
    return joined
