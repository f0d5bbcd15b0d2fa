"""Gas in the wedge beside a curved contact: what it conducts from the sensor's face to the body, straight across.

Where the body and the face part, the gap is (r^2 - s)/(2 R), with r the distance from the body's crown or line and
s the square of the contact's half width: exactly so on springs (round_bodies.py), nearly so on half-spaces. With d
the gap of faces that touch without force, the temperature jump with it, the conductance per area is

    k/(d + (r^2 - s)/(2 R)) = 2 R k/(c + r^2),    c = 2 R d - s

On rectangles in whose corner the crown is, the integral over r is a logarithm and that over the angle a sum of a few
terms; on a strip the whole is an arc tangent. The body ends where r is its radius.

Hertz's gap beside a ball on a face that does not yield opens with a horizontal tangent and is narrower. In units of
2 R d, u the square of the contact's radius and v what r^2 has more than it at the end, the integral over it is
0.7 log(1 + u v^2/((1 + v)(v + 2 u))) more than log(1 + v): a fit to the integral over his gap, within
1.2 % of what the whole face conducts while u is below 3, and within 4 % for any u and v.
"""

from __future__ import annotations

import math

import numpy as np

from thermograsp.compiled import njit

_PLACES, _SHARES = np.polynomial.legendre.leggauss(8)
_NODES, _WEIGHTS = (_PLACES + 1) / 2, _SHARES / 2
_HERTZ = 0.7  # see above


@njit(cache=True, error_model="numpy")
def beside_ball(square, hertz, mean_gap, radius, half, y, z):
    """m, over a square of half width `half` m whose middle is y, z from the crown: times k/1, W/K.

    square: m2, s. hertz: m2, the square of the radius of Hertz's contact, 0 on springs. mean_gap: m, d. radius: m."""
    total = 0.0
    for i in range(2):
        for j in range(2):
            v, w = (y + half if i else half - y), (z + half if j else half - z)
            sign = (1.0 if v > 0 else -1.0) * (1.0 if w > 0 else -1.0)
            angle = math.atan2(abs(w), abs(v))
            corner = _fan(abs(v), angle, square, hertz, mean_gap, radius)
            corner += _fan(abs(w), math.pi / 2 - angle, square, hertz, mean_gap, radius)
            total += sign * corner
    return 2 * radius * max(total, 0.0)


@njit(cache=True, inner=True, error_model="numpy")
def _fan(side, angle, square, hertz, mean_gap, radius):
    """The integral of 1/(c + r^2) over a triangle with the crown in a corner, of that angle, whose far side is `side`
    away, without what is in contact."""
    start = (
        math.acos(side / math.sqrt(square)) if side * side < square else 0.0
    )  # before it all is in contact
    if start >= angle:
        return 0.0
    total, touching = 0.0, 2 * radius * mean_gap
    u = hertz / touching
    for k in range(len(_NODES)):
        across = side / math.cos(start + (angle - start) * _NODES[k])
        v = max(min(across * across, radius * radius) - square, 0.0) / touching
        more = u * v * v / ((1.0 + v) * (v + 2.0 * u)) if u > 0.0 else 0.0
        total += _WEIGHTS[k] * (math.log1p(v) + _HERTZ * math.log1p(more))
    return (angle - start) / 2 * total


@njit(cache=True, error_model="numpy")
def beside_strip(square, mean_gap, radius, half, x):
    """m per m of a cylinder, over a width of 2 half whose middle is x m from its line; see beside_ball."""
    near = math.sqrt(square)
    total = 0.0
    for way in (1.0, -1.0):
        start, end = max(-half - way * x, near), min(half - way * x, radius)
        if end > start:
            total += _strip(2 * radius * mean_gap - square, start, end)
    return 2 * radius * total


@njit(cache=True, inner=True, error_model="numpy")
def _strip(c, start, end):
    """The integral of 1/(c + x^2) from start to end, where that is above 0."""
    root = math.sqrt(abs(c))
    turn = root * (end - start) / (c + start * end)
    if turn < 1e-4:
        return (end - start) / (c + start * end)
    return (math.atan(turn) if c > 0.0 else math.atanh(turn)) / root
