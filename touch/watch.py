"""Fingertips that are pressed where they feel nothing, which must be said: beside their pads alone, or on their pads
beside the sensor."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence

import numpy as np

from .readings import TouchReading
from .scene import PadPlace

_PATIENCE = 0.5  # s in one go


class PadWatch:
    """Warns once of each fingertip that is pressed beside its pad before it was ever pressed on it, and of each that is
    pressed on it and whose sensor never felt any heat. dt: s between readings."""

    def __init__(self, pads: Sequence[PadPlace], dt: float) -> None:
        self._pads, self._most = tuple(pads), math.ceil(_PATIENCE / dt)
        self._fingertips = {pad.label for pad in pads}
        # (2, F) of being on the pad, and of heat; fingertips without a sensor feel none
        self._never = np.array([[True] * len(pads), [not pad.bare for pad in pads]])
        self._readings = np.zeros((2, 1, len(pads)), int)  # in each world

    def see(self, reading: TouchReading) -> None:
        """To be called with every reading."""
        if not self._never.any():
            return
        force, beside, drop = (
            each.reshape(-1, len(self._pads))
            for each in (reading.force, reading.beside, reading.temperature_drop)
        )
        on_pad, heat = force > 0, drop != 0
        self._never &= ~np.array([on_pad.any(axis=0), heat.any(axis=0)])
        self._readings = np.where([beside > 0, on_pad & ~heat], self._readings + 1, 0)
        late = self._never & (self._readings >= self._most).any(axis=1)
        for f in np.flatnonzero(late[0]).tolist():
            self._never[0, f] = False
            self._warn_beside(self._pads[f], float(np.nanmax(beside[:, f])))
        for f in np.flatnonzero(late[1]).tolist():
            names = np.reshape(reading.touching, (-1, len(self._pads)))[on_pad[:, f], f]
            if not self._fingertips.issuperset(names.tolist()):  # fingertips are as warm as one another
                self._never[1, f] = False
                self._warn_of_sensor(self._pads[f], float(np.nanmax(force[:, f])))

    def _warn_beside(self, pad: PadPlace, newtons: float) -> None:
        _warn(
            f"fingertip {pad.label!r} is pressed by {newtons:.3g} N beside its pad, where it feels nothing, and was "
            f"never pressed on it. Its pad is at ({_numbers(pad.position)}) m in its body's frame and looks "
            f"along ({_numbers(pad.axes[:, 0])}); if it should look elsewhere, give Fingertip(name, normal=(x, y, z)), "
            "and of a flat one position=(x, y, z) and size=(y, z) too"
        )

    def _warn_of_sensor(self, pad: PadPlace, newtons: float) -> None:
        _warn(
            f"fingertip {pad.label!r} is pressed by {newtons:.3g} N on its pad, and its sensor has felt no heat: what "
            f"it touches leans away from the sensor or lies beside it, {1e3 * pad.stack.width:.3g} mm wide in the "
            f"pad's middle at ({_numbers(pad.position)}) m in its body's frame, or is as warm. To move the sensor, "
            "give Fingertip(name, position=(x, y, z), normal=(x, y, z), size=(y, z))"
        )


def _numbers(vector: np.ndarray) -> str:
    return ", ".join(f"{x:.3g}" for x in np.round(vector, 6) + 0.0)


def _warn(what: str) -> None:
    warnings.warn(what, RuntimeWarning, stacklevel=6)
