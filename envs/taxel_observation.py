"""What an agent feels with taxels: as in every environment, and the pressure over each pad."""

from __future__ import annotations

import gymnasium
import numpy as np

from thermograsp.plant import Reading

from .observation import Observation, Observer
from .taxels import MOST_PRESSURE


class TaxelObserver:
    """Another observer's observation with pressure (2, n, m) Pa added: rows from the fingertip's end up to the wrist,
    columns along the pad's horizontal axis. It saturates at MOST_PRESSURE."""

    def __init__(self, within: Observer, taxels: tuple[int, int]) -> None:
        self._within = within
        box = gymnasium.spaces.Box(0.0, MOST_PRESSURE, (2, *taxels), np.float32)
        self.space = gymnasium.spaces.Dict({**within.space.spaces, "pressure": box})
        self._pressure = np.zeros((len(within.history), *box.shape), np.float32)

    @property
    def history(self) -> np.ndarray:
        """See Observer."""
        return self._within.history

    @history.setter
    def history(self, values: np.ndarray) -> None:
        self._within.history = values

    @property
    def last(self) -> tuple[np.ndarray, ...]:
        """What each key of the space last held."""
        return (*self._within.last, self._pressure)

    @last.setter
    def last(self, values: tuple[np.ndarray, ...]) -> None:
        self._within.last, self._pressure = values[:-1], values[-1]

    def restart(self, rows: np.ndarray) -> None:
        """See Observer."""
        self._within.restart(rows)

    def observe(self, reading: Reading, force_limit: np.ndarray, seen: np.ndarray) -> Observation:
        """See Observer; needs a plant that reads taxels."""
        observation = self._within.observe(reading, force_limit, seen)
        assert reading.pressure is not None
        self._pressure[seen] = np.minimum(reading.pressure[seen], MOST_PRESSURE)
        return {**observation, "pressure": self._pressure.copy()}
