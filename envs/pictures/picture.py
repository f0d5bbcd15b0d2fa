"""Pictures of a grasp environment: fingertips and object coloured by what they feel."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from thermograsp.errors import InvalidValueError
from thermograsp.plant import Reading

from ..limits import TIPS
from ..mechanics import element_geom
from .render import Renderer, Window


class GraspPicture:
    """Draws environments of a simulated plant. mode: "rgb_array" or "human". Raises MissingDependencyError where there
    is no GL library or, for "human", no display."""

    def __init__(self, plant: Any, mode: str, camera: str, width: int, height: int) -> None:
        if not hasattr(plant, "mechanics"):
            raise InvalidValueError("this plant is not simulated: there is nothing to draw")
        self._plant, self._camera = plant, camera
        self._window = Window(plant.mechanics) if mode == "human" else None
        self._renderer = Renderer(plant.mechanics, width=width, height=height) if mode != "human" else None

    def draw(self, reading: Reading | None, row: int = 0) -> np.ndarray | None:
        """(height, width, 3) uint8 of the environment `row`, or None where a window shows the first."""
        celsius = temperatures(reading, self._plant.mechanics.names, row)
        if self._window is not None:
            self._window.show(temperatures=celsius)
            return None
        assert self._renderer is not None
        return self._renderer.frame(row, camera=self._camera, temperatures=celsius)

    def close(self) -> None:
        """Frees window and buffers."""
        for part in (self._window, self._renderer):
            if part is not None:
                part.close()


def temperatures(reading: Reading | None, objects: Sequence[str], row: int = 0) -> dict[str, float]:
    """°C by part of the scene: the two fingertips' faces, in O mode the elements' too, and the objects' means. objects:
    their names in the scene, in the order of the readings."""
    if reading is None or "object_temperature" not in reading.truth:
        return {}
    # With several objects the first name is the mean of the one that the left fingertip touches.
    several = "object_temperatures" in reading.truth
    means = np.atleast_1d(reading.truth["object_temperatures" if several else "object_temperature"][row])
    celsius = {name: float(mean) for name, mean in zip(objects, means, strict=True)}
    for tip, name in enumerate(TIPS):
        celsius[f"sensor_{name}"] = float(reading.truth["sensor_surface"][row, tip])
        if reading.truth["mode"] == "O":
            celsius[element_geom(name, objects[0])] = float(reading.truth["object_surface"][row, tip])
    return celsius
