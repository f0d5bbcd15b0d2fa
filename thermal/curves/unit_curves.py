"""Curves per kelvin: what a sensor reads after a touch at constant conductance, as the amplifier passes it on.

Both sides of the contact are linear, so their impedances at complex s say all: those of networks for how heat spreads,
and the sensor's layers exactly where heat flows evenly. What layers of other properties than the networks' do to the
uneven flow is left out: a sensed layer of 25 % more conductivity and 16 % more heat capacity, 3e-5 of the difference.

S: samples of s, H: conductances, n: times.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..matter import Material, SensorStack
from ..numerics import windows
from ..plates import Geometry
from ..stack import HeatedCore
from .fraction import Fraction, fraction
from .front import front
from .sides import Sides

_NODES = 30  # of a window of times, for 10 digits


class UnitCurves:
    """Curves at t (n,) s after a touch, 0 before it, behind a first-order low-pass of `bandwidth` Hz.

    geometry: of a contact with one fingertip; its material is one of many. core: what is behind a heated sensor's
    element, for T mode; None for an ideal thermostat. From the semi-analytic solution they differ by less than 1e-5 of
    the difference in T mode, in O mode by less than 1e-4.
    """

    def __init__(
        self,
        geometry: Geometry,
        t: np.ndarray,
        bandwidth: float = np.inf,
        core: HeatedCore | None = None,
    ) -> None:
        self._geometry, self._core = geometry, core
        self._later = np.asarray(t, float) > 0
        parts = list(windows(t[self._later], _NODES))
        self._s = np.concatenate([s for _, s, _ in parts])
        invert = np.zeros((int(self._later.sum()), len(self._s)), complex)
        for k, (inside, s, weights) in enumerate(parts):
            invert[inside, k * len(s) : (k + 1) * len(s)] = weights
        lag = 0.0 if np.isinf(bandwidth) else 1 / (2 * np.pi * bandwidth)
        # the real part of a complex product, as a product of real numbers
        invert = invert / self._s / (1 + lag * self._s)
        self._invert = np.concatenate((invert.real, -invert.imag), axis=1)
        self._sides = Sides(geometry, self._s)
        self._sampled = front(geometry.stack, None, self._s)
        self._front = self._sampled if core is None else front(geometry.stack, core, self._s)

    def on(self, material: Material) -> TouchedCurves:
        """Those on objects of a material."""
        impedance, read = self._sides.impedance(material)
        nothing = np.zeros(impedance.shape[:2])
        return TouchedCurves(self, fraction(impedance, nothing if read is None else read), read is None)

    def _seen(
        self, fraction: Fraction, even: bool, conductance: np.ndarray, stack: SensorStack | None
    ) -> np.ndarray:
        """See TouchedCurves. even: whether what is read follows the whole heat flow (T mode)."""
        flow, drop = fraction(1 / (conductance * self._geometry.area))
        if even:
            sensor = self._front if stack is None else front(stack, self._core, self._s)
            flow *= (1 - sensor.face_lost) / (1 + (sensor.impedance - self._sampled.impedance) * flow)
            drop = sensor.read * flow + sensor.read_lost
        curves = np.zeros((len(conductance), len(self._later)))
        curves[:, self._later] = np.concatenate((np.real(drop), np.imag(drop)), axis=1) @ self._invert.T
        return curves


@dataclass(frozen=True, slots=True)
class TouchedCurves:
    """Curves on objects of one material; a call gives those of conductances (H,) W/(m2 K): (H, n) K per K between
    sensor and object, the drop over the sensed layer or the fall of a heated sensor's reading. stack: the element with
    layers of other properties, T mode."""

    _curves: UnitCurves
    _fraction: Fraction
    _even: bool

    def __call__(self, conductance: np.ndarray, stack: SensorStack | None = None) -> np.ndarray:
        return self._curves._seen(self._fraction, self._even, conductance, stack)
