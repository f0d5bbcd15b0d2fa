"""Balls and cylinders anywhere on a pad: an elastic (Winkler) foundation, whose springs may be others on the face.

With K the foundation's stiffness, Pa per m, R the body's radius and a the half width of what an endless pad would
touch, the pressure at a distance r from the body's crown is K (a^2 - r^2)/(2 R) where that is positive (Johnson,
Contact Mechanics, section 4.3). The pad and the sensor's face are rectangles, so that areas and forces are integrals
over what a rectangle and a disc, or a strip, have in common: sums over the rectangle's corners, each the integral over
a quarter. The force gives a^2, by Newton's steps on an increasing, convex function: after the first, from above.
"""

from __future__ import annotations

import math

from thermograsp.compiled import njit

_STEPS = 60
_CLOSE = 1e-9  # of the load: Newton's next step from there is exact to rounding


@njit(cache=True, error_model="numpy")
def ball_on_pad(load, ratio, pad, face, y, z):
    """(area m2 on the pad, area m2 on the face, the face's load m4, a^2 m2) under a ball.

    load: m4, the force over K/(2 R) of the pad's springs; ratio: the stiffness of the face's over theirs. pad, face: m,
    half of the squares' sides. y, z: m, where the crown is from their middle."""
    y, z = abs(y), abs(z)
    room = face - max(y, z)
    square = math.sqrt(2 * load / (math.pi * ratio))
    if room <= 0.0 or square > room * room:  # beyond the face
        room, square = pad - max(y, z), math.sqrt(2 * load / math.pi)
        if ratio != 1.0 or room <= 0.0 or square > room * room:
            square = _ball_square(load, ratio, pad, face, y, z)
    on_face = _corners(square, face, y, z)
    on_pad = _corners(square, pad, y, z)
    return on_pad[0], on_face[0], ratio * on_face[1], square


@njit(cache=True, error_model="numpy")
def cylinder_on_pad(load, ratio, pad, face, along_pad, along_face, x):
    """The same under a cylinder. along_pad, along_face: m of it that lie over the pad and over the face. x: m, where
    its line of contact is from their middle, across it. pad, face: m, half of what they are wide that way."""
    x = abs(x)
    if along_pad <= 0.0:
        return 0.0, 0.0, 0.0, 0.0
    narrow = (0.75 * load / along_pad) ** (1 / 3)
    more = (ratio - 1.0) * along_face
    square = narrow * narrow
    if more != 0.0 or narrow > pad - x:
        square = _strip_square(load, more, pad, face, along_pad, x)
    a, b = _strip(square, pad, x), _strip(square, face, x)
    return along_pad * a[0], along_face * b[0], ratio * along_face * b[1], square


@njit(cache=True, inner=True, error_model="numpy")
def disc_on_face(square, half, y, z):
    """(share of the area, share of the force) of a disc whose radius has that square m2 > 0 that lie on a square of
    half width `half` m, its middle y and z m away."""
    area, load = _corners(square, half, abs(y), abs(z))
    return area / (math.pi * square), load / (math.pi / 2 * square * square)


@njit(cache=True, inner=True, error_model="numpy")
def _strip_square(load, more, pad, face, along_pad, x):
    """m2, a^2."""
    first = 2 * (along_pad * pad + more * face)
    second = along_pad * (2 / 3 * pad**3 + 2 * pad * x * x) + more * (2 / 3 * face**3 + 2 * face * x * x)
    square = (load + second) / first
    for _ in range(_STEPS):
        a, b = _strip(square, pad, x), _strip(square, face, x)
        wrong = along_pad * a[1] + more * b[1] - load
        rate = along_pad * a[0] + more * b[0]
        if rate <= 0.0:
            break
        square -= wrong / rate
        if wrong <= _CLOSE * load:
            break
    return square


@njit(cache=True, inner=True, error_model="numpy")
def _ball_square(load, ratio, pad, face, y, z):
    """m2, a^2."""
    area, moment = 4 * pad * pad, 4 * pad * pad * (2 / 3 * pad * pad + y * y + z * z)
    area += (ratio - 1.0) * 4 * face * face
    moment += (ratio - 1.0) * 4 * face * face * (2 / 3 * face * face + y * y + z * z)
    most = (load + moment) / area  # as if all were touched: never less than it is
    square = min(math.sqrt(2 * load / math.pi), most)
    for _ in range(_STEPS):
        touched, pressed = _corners(square, pad, y, z)
        if ratio != 1.0:
            on_face = _corners(square, face, y, z)
            touched, pressed = touched + (ratio - 1.0) * on_face[0], pressed + (ratio - 1.0) * on_face[1]
        wrong = pressed - load
        square = min(square - wrong / touched, most) if touched > 0.0 else most
        if abs(wrong) <= _CLOSE * load:
            break
    return square


@njit(cache=True, inner=True, error_model="numpy", forceinline=True)
def _strip(square, half, x):
    """(m, m3): over a width of 2 half whose middle is x from the line of contact, what is touched, and the integral of
    a^2 - r^2 over it."""
    a = math.sqrt(max(square, 0.0))
    low, high = min(max(x - half, -a), a), min(max(x + half, -a), a)
    # rounding may leave less than nothing of what is hardly touched
    return high - low, max(square * (high - low) - (high**3 - low**3) / 3, 0.0)


@njit(cache=True, inner=True, error_model="numpy", forceinline=True)
def _corners(square, half, y, z):
    """(m2, m4): of the disc and a square of half width `half` whose middle is y, z from its centre, the area in common
    and the integral of a^2 - r^2 over it."""
    if square <= 0.0:
        return 0.0, 0.0
    reach = math.sqrt(square)
    if half - max(y, z) >= reach:
        return math.pi * square, math.pi / 2 * square * square
    area, load = 0.0, 0.0
    for i in range(2):
        for j in range(2):
            v, w = (y + half if i else half - y), (z + half if j else half - z)
            sign = (1.0 if v > 0 else -1.0) * (1.0 if w > 0 else -1.0)
            quarter = _quarter(square, reach, min(abs(v), reach), min(abs(w), reach))
            area, load = area + sign * quarter[0], load + sign * quarter[1]
    return max(area, 0.0), max(load, 0.0)


@njit(cache=True, inner=True, error_model="numpy")
def _quarter(square, reach, v, w):
    """The same for a rectangle of sides v and w, m, at most `reach`, the disc's radius, that has a corner in the
    disc's centre."""
    if v * v + w * w <= square:
        return v * w, v * w * (square - (v * v + w * w) / 3)
    start = math.sqrt((reach - w) * (reach + w))
    area = start * w
    load = start * w * (square - (start * start + w * w) / 3)
    for end, sign in ((v, 1.0), (start, -1.0)):
        height = math.sqrt(max((reach - end) * (reach + end), 0.0))
        angle = math.atan2(end, height)
        area += sign * 0.5 * (end * height + square * angle)
        load += sign * (end * height * (5 * square - 2 * end * end) + 3 * square * square * angle) / 12
    return area, load
