"""The temperature drop of a sensor on a thermostat that touches a known object, as a function of the sensor's layers.

The semi-analytic rung (semi_analytic.py) once more, arranged for fitting. At a complex s its contact problem is
(E + P + 1/h) f = u: impedances of element and object in the patterns of the patch, u the uniform one. The element's
part that is uniform over the cross-section, e u u', follows its layers at once; what remains, E', hardly matters to the
drop and is kept (a sensed layer of 25 % more conductivity and 16 % more heat capacity: within 3e-5 of the difference).
With x = u' (E' + P + 1/h)^-1 u the heat flow is x / (1 + e x) (Sherman & Morrison), and x is, for every h, a continued
fraction of the coefficients of Lanczos' recursion from u. So a curve costs a few hundred complex numbers once the
recursion is done.

S: samples of s, C: patterns, M: terms of the fraction, n: times of the grid.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from ..matter import Layer, SensorStack
from ..numerics import windows
from ..plates import Far, Geometry, lateral_sum, stack_impedance, stack_profile
from .known_touch import KnownTouch

_TERMS = 12  # of the fraction; the drop changes by less than 1e-6 of the difference beyond 8
_FIRST = 0.03  # s^0.5, first point of the grid, which is even in the root of time
_SPACING = 0.01  # s^0.5
_ENDS = ((1, 0.0), "not-a-knot")  # a curve rises from 0 slower than the root of time


@dataclass(frozen=True, slots=True)
class Fraction:
    """x(h) = 1 / (a0 + 1/h - b1 / (a1 + 1/h - ...)). a: (M, S), b: (M, S), b[0] = 1, m2 K/W and its square."""

    a: np.ndarray
    b: np.ndarray

    def __call__(self, conductance: float) -> np.ndarray:
        """(S,) W/(m2 K) for a conductance in W/(m2 K)."""
        below = np.zeros_like(self.a[0])
        for a, b in zip(self.a[::-1], self.b[::-1], strict=True):
            below = b / (a + 1 / conductance - below)
        return below


def fraction(matrices: np.ndarray, start: np.ndarray) -> Fraction:
    """The continued fraction of symmetric complex matrices (S, C, C) and a unit vector (C,): Lanczos' recursion in the
    bilinear product."""
    vector = np.broadcast_to(start.astype(complex), matrices.shape[:2])
    before, root = np.zeros_like(vector), np.zeros(len(matrices), complex)
    a, b = [], [np.ones(len(matrices), complex)]
    for _ in range(min(_TERMS, matrices.shape[1])):
        residual = np.einsum("scd,sd->sc", matrices, vector) - root[:, None] * before
        a.append(np.einsum("sc,sc->s", vector, residual))
        residual = residual - a[-1][:, None] * vector
        square = np.einsum("sc,sc->s", residual, residual)
        ended = np.abs(square) <= 1e-20 * np.abs(a[-1]) ** 2  # no pattern is left that u leads to
        square = np.where(ended, 0.0, square)
        root = np.sqrt(square)
        before, vector = vector, np.where(ended[:, None], 0.0, residual / np.where(ended, 1.0, root)[:, None])
        b.append(square)
    return Fraction(np.array(a), np.array(b[:-1]))


class SensorResponse:
    """Curves of touches with any sensor that differs from `stack` in its layers' properties; E' is that of `stack`.
    bandwidth: Hz of the amplifier's first-order low-pass. horizon: s after the touch. behind: the layers of a heated
    sensor's core in place of an ideal thermostat, nearest first, which makes curves the fall of its reading."""

    def __init__(
        self,
        touches: Sequence[KnownTouch],
        stack: SensorStack,
        bandwidth: float,
        horizon: float,
        behind: tuple[Layer, ...] = (),
    ) -> None:
        self._behind = behind
        self._far: Far = "adiabatic" if behind else "isothermal"
        self._roots = np.arange(_FIRST, np.sqrt(horizon) + 2 * _SPACING, _SPACING)
        parts = list(windows(self._roots**2))
        self._s = np.concatenate([s for _, s, _ in parts])
        self._invert = np.zeros((len(self._roots), len(self._s)), complex)
        for k, (inside, s, weights) in enumerate(parts):
            self._invert[inside, k * len(s) : (k + 1) * len(s)] = weights
        lag = 0.0 if np.isinf(bandwidth) else 1 / (2 * np.pi * bandwidth)
        self._passed = 1 / (1 + lag * self._s) / self._s
        self._keys = [(t.material, t.object_size, t.fingertips) for t in touches]
        element: np.ndarray | None = None
        self._fractions: dict[object, Fraction] = {}
        for key, touch in zip(self._keys, touches, strict=True):
            if key in self._fractions:
                continue
            geometry = Geometry(stack, touch.material, "T", stack.face_area, "square", _half(touch))
            if element is None:
                element = self._uneven(geometry)
            self._fractions[key] = fraction(element + self._plate(geometry), geometry.patch.uniform)

    def curve(self, touch: int, stack: SensorStack, conductance: float) -> CubicSpline:
        """K of drop per K of difference over the root of the time after the touch, s^0.5, of a touch of the list."""
        layers = stack.layers[::-1]
        temperatures, _ = stack_profile((*layers, *self._behind), self._far, self._s[:, None], np.zeros(1))
        sensed = len(layers) - 1 - stack.sensed
        beyond = 0.0 if self._behind else temperatures[sensed + 1]
        across = (temperatures[sensed] - beyond)[:, 0]
        passed = self._fractions[self._keys[touch]](conductance)
        transform = across * passed / (1 + temperatures[0][:, 0] * passed) * self._passed
        values = np.concatenate(([0.0], (self._invert @ transform).real))
        return CubicSpline(np.concatenate(([0.0], self._roots)), values, bc_type=_ENDS)  # pyright: ignore[reportArgumentType]

    def _uneven(self, geometry: Geometry) -> np.ndarray:
        """E' (S, C, C)."""
        layers = geometry.stack.layers[::-1]

        def uneven(s: np.ndarray, kappa2: np.ndarray) -> np.ndarray:
            return np.where(kappa2 == 0, 0.0, stack_impedance(layers, "isothermal", s, kappa2))

        return lateral_sum(geometry.element_section, geometry.patch, geometry.patch)(uneven, self._s)

    def _plate(self, geometry: Geometry) -> np.ndarray:
        """P (S, C, C)."""
        plate = (geometry.plate,)
        over = lateral_sum(geometry.object_section, geometry.patch, geometry.patch)
        return over(lambda s, kappa2: stack_impedance(plate, "adiabatic", s, kappa2), self._s)


def _half(touch: KnownTouch) -> tuple[float, float, float]:
    """Two equal fingertips drive no heat through the middle plane: each has a plate of half the thickness."""
    width, depth, thickness = touch.object_size
    return width, depth, thickness / touch.fingertips
