"""What a scene may get wrong: fingertips that are pressed where they feel nothing, beside their pads alone or on their
pads beside the sensor, and fingertips that meet through what they pinch."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence

import numpy as np

from .heat import JoinedHeat
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


class PinchWatch:
    """Warns once of two fingertips that touch one another through an object that they press from both sides, where
    contacts give way by more than it is thick. names: of the objects. dt: s between readings."""

    def __init__(self, pads: Sequence[PadPlace], names: Sequence[str], dt: float) -> None:
        self._labels, self._names = [pad.label for pad in pads], tuple(names)
        self._each = max(round(_PATIENCE / dt), 1)
        self._left: int = self._each
        self._before: set[tuple[int, int, int]] = set()

    def see(self, heat: JoinedHeat) -> None:
        """To be called with every reading. What is there twice, as long apart as the watch's patience, is told."""
        self._left -= 1
        if self._left != 0 or len(self._labels) < 2:
            return
        self._left, found = self._each, heat.meeting_through()
        again = sorted(found & self._before)
        self._before = found
        if again:
            self._left = -1  # once is enough
            one, other, o = again[0]
            _warn(
                f"fingertips {self._labels[one]!r} and {self._labels[other]!r} touch one another through "
                f"{self._names[o]!r}, which they pinch: MuJoCo's contacts give way by more than it is thick, so that "
                "they bear a part of each other's force and exchange heat. Exclude contacts between their bodies "
                '(<contact><exclude body1="..." body2="..."/></contact>), or make contacts stiffer (solref)'
            )


def _numbers(vector: np.ndarray) -> str:
    return ", ".join(f"{x:.3g}" for x in np.round(vector, 6) + 0.0)


def _warn(what: str) -> None:
    warnings.warn(what, RuntimeWarning, stacklevel=6)
