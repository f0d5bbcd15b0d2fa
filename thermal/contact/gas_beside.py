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

Between two round bodies at any angle, or beside a rod that leans, the gap is d less the depth that `Wedge` tells.
Across the contact the integral is an arc tangent; along it Gauss's rule takes a few places of what touches and of what
does not, closer together where the one ends and the other begins: within .5 % of the whole.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

from ..numerics import Array, namespace_of


def _gauss(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Places between 0 and 1, and their weights."""
    places, shares = np.polynomial.legendre.leggauss(count)
    return (places + 1) / 2, shares / 2


_NODES, _WEIGHTS = _gauss(8)
_HERTZ = 0.7  # see above
_WEDGE_NODES, _WEDGE_WEIGHTS = _gauss(4)
_SLIGHT = 1e-4  # rad: a smaller arc is its tangent
_SHORT = 1e-9  # m, that what does not reach the other counts to touch


class Wedge(NamedTuple):
    """Two surfaces that touch, by how deep springs between them are pressed in at x and y m from where they touch:
    depth - slope y - bend y^2/2 - curvature x^2/2, less than 0 where they are apart. depth: m, above 0 where there is
    no slope; slope: m/m; bend and curvature: 1/m, above 0 but for the bend where there is a slope. left, right, lower,
    upper: m along x and y where the sensor's face begins and ends, or what is in front of it does. Numbers, or arrays
    of one shape."""

    depth: Array
    slope: Array
    bend: Array
    curvature: Array
    left: Array
    right: Array
    lower: Array
    upper: Array


@njit(cache=True, error_model="numpy")
def wedge_gas(wedge, gap):
    """m, what gas conducts over its conductivity, W/K over W/(m K), beside what touches. gap: m, of faces that touch
    without force, above 0."""
    total = 0.0
    if wedge.slope > 0.0:
        end = max(wedge.depth / wedge.slope, _SHORT)
    else:
        end = math.sqrt(2 * wedge.depth / wedge.bend)
    for way in (1.0, -1.0):
        near, far = (wedge.lower, wedge.upper) if way > 0 else (-wedge.upper, -wedge.lower)
        near = max(near, 0.0)
        turn = math.asin(min(near / end, 1.0))
        turns = math.asin(min(max(far, near) / end, 1.0)) - turn
        root = math.sqrt(max(near - end, 0.0))
        roots = math.sqrt(max(far - end, root * root)) - root
        for k in range(len(_WEDGE_NODES)):
            if turns > 0.0:  # beside what touches
                at = turn + _WEDGE_NODES[k] * turns
                here = _across_wedge(wedge, gap, way * end * math.sin(at))
                total += _WEDGE_WEIGHTS[k] * turns * end * math.cos(at) * here
            if roots > 0.0:  # beyond its end
                at = root + _WEDGE_NODES[k] * roots
                total += _WEDGE_WEIGHTS[k] * roots * 2 * at * _across_wedge(wedge, gap, way * (end + at * at))
    return total


@njit(cache=True, inner=True, error_model="numpy")
def _across_wedge(wedge, gap, y):
    """m per m of y."""
    deep, half = wedge.depth - wedge.slope * y - wedge.bend * y * y / 2, wedge.curvature / 2
    start, open_ = math.sqrt(max(deep, 0.0) / half), gap - deep
    root, total = math.sqrt(abs(open_ * half)), 0.0
    for near, far in ((wedge.left, wedge.right), (-wedge.right, -wedge.left)):
        near = max(near, start)
        if far <= near:
            continue
        turn = root * (far - near) / (open_ + half * far * near)
        if turn < _SLIGHT:
            total += (far - near) / (open_ + half * far * near)
        else:
            total += (math.atan(turn) if open_ > 0.0 else math.atanh(turn)) / root
    return total


def array_wedge_gas(wedge: Wedge, gaps: Sequence[Array]) -> list[Array]:
    """wedge_gas of arrays of one shape, in whatever library, at each of the gaps."""
    xp = namespace_of(wedge.depth)
    one = 1.0 + 0.0 * wedge.depth
    leans = wedge.slope > 0
    end = xp.where(
        leans,
        (wedge.depth / xp.where(leans, wedge.slope, one)).clip(_SHORT, None),
        (2 * xp.where(leans, one, wedge.depth) / xp.where(leans, one, wedge.bend)) ** 0.5,
    )
    places, weights = list[Array](), list[Array]()
    for way in (1.0, -1.0):
        near, far = (wedge.lower, wedge.upper) if way > 0 else (-wedge.upper, -wedge.lower)
        near = near.clip(0.0, None)
        far = xp.maximum(far, near)
        turn = xp.asin((near / end).clip(None, 1.0))
        turns = xp.asin((far / end).clip(None, 1.0)) - turn
        root = (near - end).clip(0.0, None) ** 0.5
        roots = xp.maximum((far - end).clip(0.0, None) ** 0.5, root) - root
        for node, weight in zip(_WEDGE_NODES.tolist(), _WEDGE_WEIGHTS.tolist(), strict=True):
            at, beyond = turn + node * turns, root + node * roots
            places += [way * end * xp.sin(at), way * (end + beyond * beyond)]
            weights += [weight * turns * end * xp.cos(at), weight * roots * 2 * beyond]
    # places along a last axis from here on
    y, weight, half = xp.stack(places, -1), xp.stack(weights, -1), wedge.curvature[..., None] / 2
    deep = wedge.depth[..., None] - wedge.slope[..., None] * y - wedge.bend[..., None] * y * y / 2
    start, one = (deep.clip(0.0, None) / half) ** 0.5, 1.0 + 0.0 * y
    ways = [
        (xp.maximum(near[..., None], start), far[..., None] + 0.0 * y)
        for near, far in ((wedge.left, wedge.right), (-wedge.right, -wedge.left))
    ]

    def beside(gap: Array) -> Array:
        space = gap[..., None] - deep
        square, found = abs(space * half), 0.0 * y
        for near, far in ways:
            there = far > near
            even = xp.where(there, far - near, 0.0 * y) / xp.where(there, space + half * far * near, one)
            turn = even * square**0.5
            slight = turn < _SLIGHT
            root = xp.where(slight, one, square) ** 0.5
            inside = xp.where(slight | (space > 0), 0.0 * y, turn)
            arc = xp.where(space > 0, xp.atan(turn), xp.atanh(inside))
            found = found + xp.where(slight, even, arc / root)
        return (weight * found).sum(-1)

    return [beside(gap) for gap in gaps]


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
