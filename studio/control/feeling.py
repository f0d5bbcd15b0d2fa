"""What the fingertips' voltage tells of the object, while it comes in."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from concurrent.futures import Executor
from typing import Any, Literal

import numpy as np

from thermograsp.studio.control.choices import Choices
from thermograsp.thermal import (
    SEED_MATERIALS,
    Identification,
    Identifier,
    Material,
    TouchSetup,
)

SPREAD = 3.0  # K, standard deviation that identification is told of the object's temperature
PERIOD = 0.2  # s between looks; each takes some 10 ms
_SHOWN = 6  # materials
_MOST_PENDING = 3000  # control steps that wait for the library
_VOLTAGES = ("voltage_left_V", "voltage_right_V")


class Feeling:
    """Identifies one touch among the ten seed materials and those that may lie there. Feed it samples with `add`; what
    `look` says is of all of them. Its library of curves takes seconds where it is not on disk yet and is made by
    `workers`; samples wait for it. Samples beyond the setup's horizon after the touch are not used, nor kept."""

    def __init__(
        self, setup: TouchSetup, materials: Mapping[str, Material], named: tuple[str, ...], workers: Executor
    ) -> None:
        chosen = dict.fromkeys((*SEED_MATERIALS, *named))
        candidates = [materials[name] for name in chosen if name in materials]
        self._making = workers.submit(Identifier, setup, candidates)
        self._horizon, self._fingertips = setup.horizon, setup.fingertips
        self._fresh = True
        self.reset()

    def reset(self) -> None:
        """Another touch begins."""
        self._pending: deque[tuple[np.ndarray, np.ndarray]] = deque(maxlen=_MOST_PENDING)
        self._looked = 0.0
        self._identification: Identification | None = None
        self._fresh = True

    def add(self, columns: Mapping[str, np.ndarray], row: int) -> None:
        """The columns (B, S) of a control step. Samples without a voltage, of lost frames, are left out."""
        voltage = np.stack([columns[name][row] for name in _VOLTAGES[: self._fingertips]], axis=1)
        known = np.isfinite(voltage).all(axis=1)
        if known.any():
            self._pending.append((columns["time_s"][row][known], voltage[known]))

    def look(self) -> dict[str, Any] | None:
        """What is to be told, where it is time to look again and something new came. Raises ThermograspError where the
        library cannot be made."""
        if not self._pending or self._pending[-1][0][-1] < self._looked + PERIOD or not self._making.done():
            return None
        identifier = self._making.result()
        if self._fresh:
            identifier.reset()
            self._fresh = False
        t, voltage = (np.concatenate(parts) for parts in zip(*self._pending, strict=True))
        self._pending.clear()
        self._looked = float(t[-1])
        if self._identification is not None and self._over(self._looked):
            return None
        self._identification = identifier.update(t, voltage)
        return posterior(self._identification)

    def close(self) -> None:
        """What has not begun need not be made."""
        self._making.cancel()

    def _over(self, now: float) -> bool:
        assert self._identification is not None
        touches = self._identification.touch
        return all(np.isfinite(touches)) and now > max(touches) + self._horizon


def known_touch(choices: Choices, fingertips: Literal[1, 2]) -> TouchSetup:
    """What may be known of the touch of a real object: the mode and about the temperatures; its size is taken as 40 mm
    between two fingertips, 10 mm behind one."""
    size = (0.04, 0.04, 0.04 if fingertips == 2 else 0.01)
    return TouchSetup(
        mode=choices.mode,
        fingertips=fingertips,
        object_size=size,
        object_temperature=(choices.object_temperature, SPREAD),
        sensor_temperature=(choices.thermostat, 0.1),
    )


def posterior(identification: Identification) -> dict[str, Any]:
    """The posterior for the page: verdict and message, the likeliest materials with their probabilities, and the
    effusivity in W s^0.5/(m2 K) with its 90 % interval."""
    order = np.argsort(-identification.probability, kind="stable")[:_SHOWN]
    low, high = identification.effusivity.interval()
    return {
        "verdict": str(identification.verdict),
        "message": identification.message,
        "likely": [
            [identification.materials[k], round(float(identification.probability[k]), 4)] for k in order
        ],
        "effusivity": [round(float(value), 1) for value in (low, identification.effusivity.median, high)],
    }
