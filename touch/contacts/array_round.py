"""round_pads.py's contact of a round pad as a pure function of arrays: NumPy, PyTorch, JAX."""

from __future__ import annotations

import math

from ...thermal.numerics import Array, namespace_of
from .round_pads import LEAST, NEWTON_STEPS


def array_round_contact(
    bend: Array, curve: Array, sides: Array, force: Array, y: Array, z: Array
) -> tuple[Array, Array, Array, Array]:
    """(area m2, force N, share, length over breadth) of round_contact, of the force's shape. bend (..., BEND) of the
    pads, curve (..., CURVES) and sides (..., 2, 2) of what they meet; force: N > 0. y, z: m."""
    xp = namespace_of(force)
    (c1, c2), (half1, half2) = (curve[..., 0], curve[..., 1]), (curve[..., 2], curve[..., 3])
    y1, z1, y2, z2 = (sides[..., i, j] for i in range(2) for j in range(2))
    first = bend[..., 0] + c1 * y1 * y1 + c2 * y2 * y2
    both = c1 * y1 * z1 + c2 * y2 * z2
    second = bend[..., 1] + c1 * z1 * z1 + c2 * z2 * z2
    middle, half = (first + second) / 2, (first - second) / 2
    square = half * half + both * both
    alike = square == 0
    spread = xp.where(alike, 1.0 + 0.0 * square, square) ** 0.5
    most = middle + xp.where(alike, 0.0 * spread, spread)
    least = xp.maximum(middle - xp.where(alike, 0.0 * spread, spread), LEAST * most)
    first_part = xp.where(alike, 1.0 + 0.0 * spread, (1 + half / spread) / 2).clip(0.0, 1.0)
    along, aside = (
        first_part**0.5,
        xp.where(both < 0, -1.0 + 0.0 * first_part, 1.0 + 0.0 * first_part) * (1 - first_part) ** 0.5,
    )
    other = ((along * y1 + aside * z1) ** 2).clip(None, 1.0)

    def blend(share: Array, one: Array, rest: Array) -> Array:
        return share * one + (1 - share) * rest

    reach = xp.minimum(blend(first_part, bend[..., 3], bend[..., 4]), blend(other, half1, half2))
    width = xp.minimum(blend(1 - first_part, bend[..., 3], bend[..., 4]), blend(1 - other, half1, half2))
    face_reach = xp.minimum(blend(first_part, bend[..., 5], bend[..., 6]), reach)
    face_width = xp.minimum(blend(1 - first_part, bend[..., 5], bend[..., 6]), width)
    depth = _depth(xp, force / bend[..., 2], most, least, reach, width)
    a, b = (2 * depth / most) ** 0.5, (2 * depth / least) ** 0.5
    area, load = _clipped(xp, (face_reach / a).clip(None, 1.0), (face_width / b).clip(None, 1.0))
    share = _kept(xp, along * y + aside * z, a, face_reach) * _kept(xp, along * z - aside * y, b, face_width)
    longer = xp.minimum(b, face_width) / xp.minimum(a, face_reach)
    longer = xp.maximum(longer, 1 / longer)
    return 4 * a * b * area, 4 * bend[..., 2] * depth * a * b * load, share, longer


def _depth(xp, load, most, least, reach, width):
    depth = xp.maximum((load * (most * least) ** 0.5 / math.pi) ** 0.5, load / (4 * reach * width))
    depth = xp.maximum(depth, (0.375 * load * (most / 2) ** 0.5 / width) ** (2 / 3))
    depth = xp.maximum(depth, (0.375 * load * (least / 2) ** 0.5 / reach) ** (2 / 3))
    for _ in range(NEWTON_STEPS):
        a, b = (2 * depth / most) ** 0.5, (2 * depth / least) ** 0.5
        area, held = _clipped(xp, (reach / a).clip(None, 1.0), (width / b).clip(None, 1.0))
        depth = depth - (depth * held - load / (4 * a * b)) / area
    return depth


def _clipped(xp, x, y):
    inside = x * x + y * y <= 1.0
    root = (1 - y * y).clip(0.0, None) ** 0.5
    asin_x, asin_root = math.pi / 2 - xp.acos(x), xp.acos(y)  # of sqrt(1 - y^2)
    cos_x = (1 - x * x).clip(0.0, None) ** 0.5
    area = y * root + (x * cos_x + asin_x) / 2 - (root * y + asin_root) / 2
    cap_x = (x * (5 - 2 * x * x) * cos_x + 3 * asin_x) / 8
    cap_root = (root * (5 - 2 * root * root) * y + 3 * asin_root) / 8
    load = y * root * (1 - y * y / 3 - root * root / 3) + 2 / 3 * (cap_x - cap_root)
    return xp.where(inside, x * y, area), xp.where(inside, x * y * (1 - (x * x + y * y) / 3), load)


def _kept(xp, at, reach, half):
    both = xp.minimum(half, at + reach) - xp.maximum(-half, at - reach)
    return (both.clip(0.0, None) / (2 * xp.minimum(reach, half))).clip(None, 1.0)
