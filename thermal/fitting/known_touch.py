"""A recorded touch of a known object, from which a sensor's properties are fitted.

n: samples.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from thermograsp.errors import InvalidValueError, finite, length, non_negative

from ..matter import Material

_LEAST_DIFFERENCE = 1.0  # K
_SHORTEST = 0.5  # s of contact
_BEFORE = 3  # samples, from which the offset is known


@dataclass(frozen=True, slots=True)
class KnownTouch:
    """An element on a thermostat (T mode) touches a fresh object over its whole face, with a conductance that then
    stays.

    name: for messages. t: (n,) s, rising, 0 where the load cell shows the touch, to the end of the contact. voltage:
    (n,) V as reported. material: the object's. difference: K, thermostat less object before the touch. object_size:
    (width, depth, thickness) m. fingertips: 2 where an equal one touches the opposite face at once. touch_error: s,
    standard deviation of t's origin.
    Raises InvalidValueError for values that no such touch has.
    """

    name: str
    t: np.ndarray
    voltage: np.ndarray
    material: Material
    difference: float
    object_size: tuple[float, float, float] = (0.04, 0.04, 0.01)
    fingertips: Literal[1, 2] = 1
    touch_error: float = 0.0

    def __post_init__(self) -> None:
        t, volts = np.asarray(self.t, float), np.asarray(self.voltage, float)
        if t.ndim != 1 or t.shape != volts.shape:
            raise InvalidValueError(f"{self.name}: t {t.shape} and voltage {volts.shape} must be (n,) alike")
        if not (np.isfinite(t).all() and np.isfinite(volts).all() and (np.diff(t) > 0).all()):
            raise InvalidValueError(f"{self.name}: t must rise, and t and voltage must be finite")
        if np.sum(t < 0) < _BEFORE or not len(t) or t[-1] < _SHORTEST:
            raise InvalidValueError(
                f"{self.name}: {np.sum(t < 0)} samples before the touch and {max(t.max(initial=0.0), 0.0):.2f} s "
                f"after it: at least {_BEFORE} and {_SHORTEST:g} s are needed"
            )
        if abs(finite(f"{self.name}: difference (K)", self.difference)) < _LEAST_DIFFERENCE:
            raise InvalidValueError(
                f"{self.name}: thermostat and object differ by {self.difference:.2f} K: heat the thermostat by "
                f"{_LEAST_DIFFERENCE:g} K at least, better by 10"
            )
        for size in self.object_size:
            length(f"{self.name}: object_size (m)", size)
        non_negative(f"{self.name}: touch_error (s)", self.touch_error)
        if self.fingertips not in (1, 2):
            raise InvalidValueError(f"{self.name}: fingertips must be 1 or 2, got {self.fingertips!r}")
