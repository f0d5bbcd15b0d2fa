"""Observations with maps: those of every environment, and the pressure over each pad or the temperature over each
sensor's face."""

from __future__ import annotations

from collections.abc import Mapping

import gymnasium
import numpy as np

from thermograsp.plant import Reading

from ..footprint import MOST_PRESSURE
from .observation import Observation, Observer

FACE_TEMPERATURE = (-50.0, 150.0)  # °C
_MAPS = {
    "taxels": ("pressure", (0.0, MOST_PRESSURE)),
    "face_temperature": ("face_temperature", FACE_TEMPERATURE),
}


class MapObserver:
    """Another observer's observation with a map (2, n, m) added: rows from the fingertip's end up to the wrist, columns
    along the pad's horizontal axis. name: its key, and the reading's field. bounds: at which it saturates."""

    def __init__(
        self, within: Observer | MapObserver, name: str, shape: tuple[int, int], bounds: tuple[float, float]
    ) -> None:
        self._within, self._name, self._bounds = within, name, bounds
        box = gymnasium.spaces.Box(*bounds, (2, *shape), np.float32)
        self.space = gymnasium.spaces.Dict({**within.space.spaces, name: box})
        self._map = np.zeros((len(within.arrays[0]), *box.shape), np.float32)

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """See Observer."""
        return *self._within.arrays, self._map

    def restart(self, rows: np.ndarray) -> None:
        """See Observer."""
        self._within.restart(rows)

    def observe(self, reading: Reading, force_limit: np.ndarray, observed: np.ndarray) -> Observation:
        """See Observer; needs a plant that reads the map."""
        observation = self._within.observe(reading, force_limit, observed)
        self._map[observed] = np.clip(getattr(reading, self._name)[observed], *self._bounds)
        return {**observation, self._name: self._map.copy()}


def with_maps(within: Observer, shapes: Mapping[str, tuple[int, int]]) -> Observer | MapObserver:
    """The observer with the maps that these keywords of an environment ask for."""
    observer: Observer | MapObserver = within
    for keyword, shape in shapes.items():
        name, bounds = _MAPS[keyword]
        observer = MapObserver(observer, name, shape, bounds)
    return observer
