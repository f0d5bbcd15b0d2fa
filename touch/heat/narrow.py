"""Contacts narrower than the sensor's face: what heat has still to spread there.

The networks of fields.py know patches of the sensor's whole face. Under a contact of p by q that is narrower the two
bodies have more impedance, Z(p, q) - Z(width, width) of even flows, which builds up as heat spreads. It is taken from
the heat kernels of the element (thermal/kernels/element.py) and of a half-space and put on the networks' rates:
Z = sum b_k^2 / (s + rate_k). Its states, c_k' = -rate_k c_k + b_k q with q W through the contact, put the difference
sum b_k c_k between its faces. They hold no heat, they tell where it is. As the same b_k send and receive, they are
passive whatever the widths do.

J: widths of a table, K: rates, S: moments.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.special import erf

from thermograsp.compiled import njit

from ...thermal import Material, SensorStack
from ...thermal.kernels import (
    OF_GRASP,
    TIMES,
    TO_MOMENTS,
    Resolution,
    before,
    element_samples,
    residues,
)
from ..scene import PadPlace

STEPS = 9
"""Widths of a table: the sensor's, and each the last one's over the root of 2; narrower ones count as the last."""
_FINEST = 3e4
"""W/(m2 K) of the contact beside which errors of the impedance are weighed."""


def narrow_of(pad: PadPlace, target: Material | PadPlace, level: Resolution) -> np.ndarray:
    """(2, J, K) K/J, the b_k^2 of squares and of strips as long as the face, by their width. target: an object's
    material or another fingertip. Bare thermostats have no impedance; glued elements are met with their whole faces."""
    if pad.glued is not None or (isinstance(target, PadPlace) and target.glued is not None):
        return np.zeros((2, STEPS, level.rates))
    other = target if isinstance(target, Material) else None if target.bare else target.stack
    return _table(None if pad.bare else pad.stack, other, pad.stack.width, level)


@lru_cache(maxsize=4096)
def _table(
    stack: SensorStack | None, target: Material | SensorStack | None, width: float, level: Resolution
) -> np.ndarray:
    table, sides = np.zeros((2, STEPS, level.rates)), [each for each in (stack, target) if each is not None]
    if not sides:
        return table
    whole = np.sum([_impedance(side, width, width) for side in sides], axis=0)
    for strip in range(2):
        for step in range(1, STEPS):
            p = width * 2.0 ** (-step / 2)
            q = width if strip else p
            series = np.sum([_impedance(side, p, q) for side in sides], axis=0)
            weight = 1 / (series + 1 / (_FINEST * p * q))
            table[strip, step] = residues((series - whole)[:, None, None], level.decay, weight)[:, 0, 0]
    return table


def _impedance(side: Material | SensorStack, p: float, q: float) -> np.ndarray:
    """(S,) K/W at GRASP: mean temperature of p by q m in the middle of an element's face, or on a half-space, per even
    flow through it."""
    if isinstance(side, SensorStack):
        ends = [
            ((side.width - min(each, side.width)) / 2, (side.width + min(each, side.width)) / 2)
            for each in (p, q)
        ]
        return element_samples(side, (ends[0], ends[1])).value[OF_GRASP, 0, 0]
    capacity = side.volumetric_heat_capacity
    diffusivity = side.conductivity / capacity
    reached = np.sqrt(np.pi * diffusivity * TIMES)
    kernel = _shared(p, diffusivity) * _shared(q, diffusivity) / reached
    return (TO_MOMENTS[OF_GRASP] @ kernel + before(diffusivity)) / (capacity * p * q)


def _shared(length: float, diffusivity: float) -> np.ndarray:
    """Share of the heat on a line of that length m that is still on it at TIMES (Carslaw & Jaeger, section 10.3)."""
    u = length / (2 * np.sqrt(diffusivity * TIMES))
    return erf(u) + np.expm1(-(u**2)) / (u * np.sqrt(np.pi))


@njit(cache=True, error_model="numpy")
def spread(table, width, area, length, root):
    """Fills root (K,) with the b_k of a contact of that area m2 and length m under a sensor of that width m. table: of
    narrow_of. Returns whether there are any: not where the contact is as wide as the face or its area is not told."""
    if not area > 0.0:
        return False
    first = min(area / length, width)
    second = area / first
    short, long = min(first, second), min(max(first, second), width)
    if not short < width * (1 - 1e-9):
        return False
    steps = table.shape[1]
    narrow = min(2 * np.log2(width / short), steps - 1.0)
    at = min(int(narrow), steps - 2)
    # in between, evenly by the inverse of the area, to which the impedance is proportional at first
    of_squares = 2.0 ** (narrow - at) - 1
    of_strips = (2.0 ** ((narrow - at) / 2) - 1) / (2.0**0.5 - 1)
    square = min((width / long - 1) / (2.0 ** (narrow / 2) - 1), 1.0)
    for k in range(table.shape[2]):
        one = table[0, at, k] + of_squares * (table[0, at + 1, k] - table[0, at, k])
        other = table[1, at, k] + of_strips * (table[1, at + 1, k] - table[1, at, k])
        root[k] = np.sqrt(square * one + (1 - square) * other)
    return True
