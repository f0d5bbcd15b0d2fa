"""Fingertips that are pressed beside their pads alone. A pad that looks elsewhere feels nothing, which must be said."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence

import numpy as np

from .readings import TouchReading
from .scene import PadPlace

_PATIENCE = 0.5  # s in one go


class PadWatch:
    """Warns once of each fingertip that is pressed beside its pad before it was ever pressed on it. dt: s between
    readings."""

    def __init__(self, pads: Sequence[PadPlace], dt: float) -> None:
        self._pads, self._most = tuple(pads), math.ceil(_PATIENCE / dt)
        self._unfelt, self._readings = (
            np.ones(len(pads), bool),
            np.zeros((1, len(pads)), int),
        )  # in each world

    def see(self, reading: TouchReading) -> None:
        """To be called with every reading."""
        if not self._unfelt.any():
            return
        tips = len(self._pads)
        force, beside = (each.reshape(-1, tips) for each in (reading.force, reading.beside))
        self._unfelt &= ~(force > 0).any(axis=0)
        self._readings = np.where(beside > 0, self._readings + 1, 0)
        for f in np.flatnonzero(self._unfelt & (self._readings >= self._most).any(axis=0)).tolist():
            self._unfelt[f] = False
            self._warn(self._pads[f], float(np.nanmax(beside[:, f])))

    def _warn(self, pad: PadPlace, newtons: float) -> None:
        normal, position = (
            ", ".join(f"{x:.3g}" for x in np.round(each, 6) + 0.0) for each in (pad.axes[:, 0], pad.position)
        )
        warnings.warn(
            f"fingertip {pad.label!r} is pressed by {newtons:.3g} N beside its pad, where it feels nothing, and was "
            f"never pressed on it. Its pad is at ({position}) m in its body's frame and looks along ({normal}); if it "
            "should look elsewhere, give Fingertip(name, normal=(x, y, z)), and of a flat one position=(x, y, z) and "
            "size=(y, z) too",
            RuntimeWarning,
            stacklevel=5,
        )
