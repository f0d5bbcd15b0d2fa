"""What a narrow contact does to the object under the pad around the sensor's face, beside what it does under the face.

Networks know even flows into the whole face and into whole rings of the pad around it (places.py). A rod touches a
strip of both. Where such a strip is under the face the object is warmer than under an even flow, and so it is under
each ring, by the ring's own flow and by the face's. Both are told as shares of what the face's own flow does there: the
ratios of the rises of mean temperature on a half-space once heat has spread, on which an even flow of q W/m2 warms what
is r away by q dA/(2 pi k r) (Carslaw & Jaeger, section 10.4).
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise

import numpy as np

_POINTS = 10  # of Gauss and Legendre along each side
Rectangle = tuple[float, float]
"""m, the sides of one in the middle."""


@lru_cache(maxsize=64)
def ring_shares(width: float, sides: tuple[float, ...], steps: int) -> np.ndarray:
    """(R, steps, 2) of each ring around a face of that width m, up to these outer sides m, and of strips as broad as
    that and each the last one's over the root of 2: by the ring's own flow, and by the face's under the ring, or the
    ring's under the face."""
    shares = np.empty((len(sides), steps, 2))
    whole = (width, width)
    for r, (inner, outer) in enumerate(pairwise((width, *sides))):
        for i in range(1, steps):
            broad = width * 2.0 ** (-i / 2)
            face = _mean(broad, width) - _mean(*whole)
            strip, square = ((broad, inner), (broad, outer)), ((inner, inner), (outer, outer))
            shares[r, i, 0] = (_own(*strip) - _own(*square)) / face
            shares[r, i, 1] = (_beside((broad, width), *strip) - _beside(whole, *square)) / face
    shares[:, 0] = shares[:, 1]
    shares.setflags(write=False)
    return shares


def _own(inner: Rectangle, outer: Rectangle) -> float:
    """1/m, the mean of 1/r between all places of what the outer rectangle has more than the inner one."""
    within, whole = inner[0] * inner[1], outer[0] * outer[1]
    rest = whole - within
    between = _beside(inner, inner, outer) * within * rest
    return (_mean(*outer) * whole**2 - _mean(*inner) * within**2 - 2 * between) / rest**2


def _mean(a: float, b: float) -> float:
    """1/m, the mean of 1/r between all places of a rectangle of sides a and b m."""
    rest = (a**3 + b**3 - np.hypot(a, b) ** 3) / (3 * a**2 * b**2)
    return 2 * float(np.arcsinh(a / b) / a + np.arcsinh(b / a) / b + rest)


def _beside(face: Rectangle, inner: Rectangle, outer: Rectangle) -> float:
    """1/m, the mean of 1/r between a rectangle and what the outer one has more than the inner one around it."""
    x, y = (_points(-side / 2, side / 2) for side in face)
    across, along = (_points(low / 2, high / 2) for low, high in zip(inner, outer, strict=True))
    total, area = 0.0, 0.0
    parts = [(_points(-outer[0] / 2, outer[0] / 2), along)]
    if outer[0] > inner[0]:
        parts.append((across, _points(-inner[1] / 2, inner[1] / 2)))
    for u, v in parts:
        away = np.hypot(
            x[0][:, None, None, None] - u[0][None, None, :, None],
            y[0][None, :, None, None] - v[0][None, None, None, :],
        )
        total += float(np.einsum("i,j,k,l,ijkl", x[1], y[1], u[1], v[1], 1 / away))
        area += float(u[1].sum() * v[1].sum())
    return total / (area * face[0] * face[1])


def _points(low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    """Places from low to high, and what each counts for."""
    at, weight = np.polynomial.legendre.leggauss(_POINTS)
    return (low + high) / 2 + (high - low) / 2 * at, (high - low) / 2 * weight
