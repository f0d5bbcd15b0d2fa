"""Pictures of a grasp in time: animations and strips, with the temperatures they show."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from thermograsp.envs import GraspBatch
from thermograsp.envs.pictures import Renderer, temperatures
from thermograsp.files import atomic_write
from thermograsp.plant import Reading

_GAP = 6  # pixels between the pictures of a strip
_CAMERA = "overview"
_CROP = (0.29, 0.03, 0.71, 0.75)  # left, top, right, bottom of its view: the gripper on its way up


@dataclass(frozen=True, slots=True)
class Still:
    """One picture (height, width, 3) uint8 at `time` s. across: degC from left to right: thermostat, sensor's face,
    object's face, object's mean, object's face, sensor's face, thermostat."""

    time: float
    pixels: np.ndarray
    across: tuple[float, ...]


class Film:
    """Draws one row of a simulated batch, the gripper's part of the view, at given times of its episode.

    plant: a simulated one. times: s, rising. row: which grasp. size: pixels of the whole view. low, high: degC, the
    colours' range.
    Raises MissingDependencyError, naming the packages, where there is no OpenGL.
    """

    def __init__(
        self,
        plant: Any,
        times: Sequence[float],
        row: int = 0,
        *,
        size: tuple[int, int] = (960, 720),
        low: float = 20.0,
        high: float = 40.0,
    ) -> None:
        self._renderer = Renderer(plant.mechanics, width=size[0], height=size[1], low=low, high=high)
        self._names = plant.mechanics.names
        self._row, self._times = row, list(times)
        self.stills: list[Still] = []

    def watch(self, time: float, batch: GraspBatch) -> None:
        """Takes a picture where one is due; see recording.record."""
        taken = len(self.stills)
        if taken == len(self._times) or time < self._times[taken] - batch.dt / 2:
            return
        reading = batch.reading
        assert reading is not None
        celsius = temperatures(reading, self._names, self._row)
        pixels = _cropped(self._renderer.frame(self._row, camera=_CAMERA, temperatures=celsius))
        self.stills.append(Still(time, pixels, across(reading, self._row)))

    def write(self, path: str | os.PathLike[str]) -> None:
        """An animation at the grasp's own speed (.gif, .webp), or all pictures in a row (.png)."""
        pictures = [Image.fromarray(still.pixels) for still in self.stills]
        write_pictures(path, pictures, [still.time for still in self.stills])

    def close(self) -> None:
        """Frees OpenGL's buffers."""
        self._renderer.close()


def write_pictures(
    path: str | os.PathLike[str], pictures: Sequence[Image.Image], times: Sequence[float]
) -> None:
    """Pictures of one size taken at rising times, s: an animation (.gif, .webp) that shows the last one for a second,
    or all in a row (.png)."""
    with atomic_write(path) as temporary:
        if Path(path).suffix.lower() == ".png":
            strip(pictures).save(temporary)
        else:
            ends = [*times[1:], times[-1] + 1.0]
            lasting = [round(1000 * (end - time)) for end, time in zip(ends, times, strict=True)]
            pictures[0].save(temporary, save_all=True, append_images=pictures[1:], duration=lasting, loop=0)


def across(reading: Reading, row: int) -> tuple[float, ...]:
    """degC through both contacts of a simulated row, as in Still."""
    sensor, face = (reading.truth[name][row] for name in ("sensor_surface", "object_surface"))
    thermostat, mean = reading.thermostat[row], reading.truth["object_temperature"][row]
    through = (thermostat[0], sensor[0], face[0], mean, face[1], sensor[1], thermostat[1])
    return tuple(float(value) for value in through)


def _cropped(pixels: np.ndarray) -> np.ndarray:
    height, width = pixels.shape[:2]
    left, top, right, bottom = _CROP
    return pixels[int(top * height) : int(bottom * height), int(left * width) : int(right * width)]


def strip(pictures: Sequence[Image.Image]) -> Image.Image:
    """Pictures of one size side by side."""
    width, height = pictures[0].size
    joined = Image.new("RGB", (len(pictures) * (width + _GAP) - _GAP, height), "white")
    for i, picture in enumerate(pictures):
        joined.paste(picture, (i * (width + _GAP), 0))
    return joined
