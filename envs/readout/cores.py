"""The cores of a batch's heated fingertips: what stands in a thermostat's place where a sensor has a heater of its own.

B: environments, F = 2 fingertips, N: samples of a control step.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...thermal.stack import HeatedStack, heated_core
from .states import arrays_of, copied, fingertip_rows


class HeatedCores:
    """Of `num_envs` environments, in a room of `room` °C. starts: °C of the left and the right one at first, where a
    controller keeps its reading. dt: s, the control step.

    Their heaters follow the sensor's law; one that contact has cut stays off until a reset. They are stepped beside the
    heat as thermostats are: within a control step a heater's place stays as warm as it was at its start."""

    ideal = False

    def __init__(
        self, num_envs: int, sensor: HeatedStack, starts: tuple[float, float], room: float, dt: float
    ) -> None:
        self.setpoints = np.tile(starts, (num_envs, 1))
        self._divider, self._room = sensor.divider, room
        self._core = heated_core(sensor, dt)
        self._state = copied(self._core.settled(self.setpoints.ravel(), room))
        self._warm = self.setpoints.copy()

    def reset(self, rows: Sequence[int]) -> None:
        """The rows' have been as warm as at the start for long."""
        both = fingertip_rows(rows).ravel()
        settled = self._core.settled(self.setpoints.ravel(), self._room)
        for kept, new in zip(arrays_of(self._state), arrays_of(settled), strict=True):
            kept[both] = new[both]
        self._warm[list(rows)] = self.setpoints[list(rows)]

    def step(self, drawn: np.ndarray, first: np.ndarray, drop: np.ndarray, force: np.ndarray) -> np.ndarray:
        """Temperatures (B, F) °C of the heaters' places after a control step in which heat `drawn` (B, F) W left them.
        first: (B, F) °C, what they started from. drop: (B, F) K over the sensed layer at the step's end. force: (B, F)
        N."""
        off = first - self.setpoints
        self._warm = self._state.temperature.reshape(-1, 2) + off
        state = self._core.step(self._state, drawn.ravel(), drop.ravel(), force.ravel(), self._room)
        self._state = copied(state)
        return self._state.temperature.reshape(-1, 2) + off

    def voltage(self, drop: np.ndarray) -> np.ndarray:
        """(B, N, F) V of the dividers over the last step, from the drop (B, N, F) K over the sensed layer."""
        if self._core.readout is not None:
            return np.broadcast_to(self._divider.voltage(self.measured)[:, None], drop.shape)
        return self._divider.voltage(self._warm[:, None] - drop)

    @property
    def measured(self) -> np.ndarray:
        """(B, F) °C at the readouts; not to be written to."""
        return self._state.reading.reshape(-1, 2).copy()

    def tell(self, info: np.ndarray) -> None:
        """Does nothing: no device puts these heaters off."""

    def state(self, rows: Sequence[int]) -> tuple[np.ndarray, ...]:
        """A copy of what the rows remember."""
        return (self._warm[list(rows)], *(array[fingertip_rows(rows)] for array in arrays_of(self._state)))

    def set_state(self, rows: Sequence[int], state: tuple[np.ndarray, ...]) -> None:
        """Puts the rows into a state taken by `state`."""
        self._warm[list(rows)], *arrays = state
        for kept, new in zip(arrays_of(self._state), arrays, strict=True):
            kept[fingertip_rows(rows)] = new
