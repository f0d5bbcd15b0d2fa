"""How far a mesh gives way to a rigid face.

A soft mesh gives way further than its roughness. What lies less than h below its highest point touches then, A in all,
and bears (8/3) E* h sqrt(A/pi), or pi/2 E* h per length of a line: Hertz's laws, in which h is a^2/(2 R) and A is not
told by the radius. Its gap is Hertz's, too. As under a ball (thermal/contact/footprint.py) a crown's contact stays on
the face, up to the face's size.
"""

from __future__ import annotations

import math

from thermograsp.compiled import njit

from ..contact import disc_on_face
from .crown import AROUND, CURVED, LINE, hertz_contact
from .springs import LEAST_RISE

_SPOT = 8 / 3  # times Hertz's modulus, the radius and the height of what touches: the force on a spot
_STEPS, _CLOSE = 40, 1e-3  # at most, to a height that is known to that share


@njit(cache=True, error_model="numpy")
def softly(soft, round, flat, stiffly, load):
    """(m and m2 of _given_way, how flat what touches counts, its breadth over its length, N on the face) of a body that
    may give way. soft: of _given_way, but for the force and whether it is a line. round, flat: as roughness and springs
    have them. stiffly, load: N that a rigid face bears, and one of that flatness."""
    shape, depth, law, counts = soft[6], soft[3], soft[7], min(flat, 1.0)
    if shape[0] == 0.0:
        sunk, whole = _given_way(soft, round <= LINE, load)
        return sunk, whole, counts, round, load
    _, rounder = hertz_contact(shape, load, soft[5], law.modulus)
    sunk, whole = _given_way(soft, rounder <= LINE, stiffly)
    if sunk > depth and flat > CURVED:
        # a crown is the less flat the further it has given way
        less = (depth + law.roughness) / (sunk + law.roughness)
        softer = stiffly + less * (load - stiffly)
        sunk, whole = _given_way(soft, rounder <= LINE, softer)
        if sunk > depth:
            return sunk, whole, counts * less, rounder, softer
    return sunk, whole, counts, rounder, load


@njit(cache=True, error_model="numpy")
def _given_way(soft, line, load):
    """(m by which a body is flattened, less its roughness; m2 of the pad that a spot touches then); the depth and 0 m2
    where springs and roughness are more than that. soft: (n,) heights m, cover m2 and slopes m; the depth m, m2 of the
    face that touches then, m that this is long; of crown_at; the law. line: whether it is one. load: N."""
    heights, cover, slopes, depth, area, long, shape, law = soft
    rough, modulus = law.roughness, law.modulus
    low = depth + rough
    if line:
        return max(load / (math.pi / 2 * modulus * long) - rough, depth), 0.0
    curved, level, whole = math.sqrt(shape[0] * shape[1]), low, 0.0
    high = 2 * load / (_SPOT * modulus * math.sqrt(area / math.pi))
    if curved > 0.0:
        whole = math.pi * (0.75 * load / (curved * modulus)) ** (2 / 3)
        level = _as_sphere(whole * curved / (2 * math.pi), curved)
        if whole < math.pi * AROUND**2:
            return (level - rough, whole) if level > low else (depth, 0.0)
    if high <= low:
        return depth, 0.0
    level = min(max(level, low), high)
    for _ in range(_STEPS):
        whole = _touched_at(heights, cover, slopes, level - rough)
        bears = _SPOT * modulus * math.sqrt(whole / math.pi) * _as_paraboloid(level, curved)
        if bears < load:
            low = level
        elif level == low:
            return depth, 0.0
        else:
            high = level
        further = level * (load / bears) ** (2 / 3)  # exactly so under a paraboloid
        if not low < further < high:
            further = (low + high) / 2
        close = abs(further - level) <= _CLOSE * level
        level = further
        if close:
            break
    return (level - rough, whole) if level - rough > depth else (depth, 0.0)


@njit(cache=True, inner=True, error_model="numpy")
def _as_paraboloid(height, curved):
    """m, of a paraboloid of that curvature 1/m, as wide as a sphere is at that height m: Hertz's laws are of one."""
    return height * max(1.0 - curved * height / 2, 0.5)


@njit(cache=True, inner=True, error_model="numpy")
def _as_sphere(height, curved):
    """The reverse, no higher than the sphere's middle."""
    return (1.0 - math.sqrt(max(1.0 - 2 * curved * height, 0.0))) / curved


@njit(cache=True, error_model="numpy")
def _touched_at(heights, cover, slopes, depth):
    """m2 of all springs at that depth m."""
    area = 0.0
    for i in range(len(heights)):
        area += cover[i] * min(max((depth - heights[i]) / max(slopes[i], LEAST_RISE) + 0.5, 0.0), 1.0)
    return area


@njit(cache=True, error_model="numpy")
def touch_at(heights, cover, slopes, depth, touching):
    """m2 of the face at that depth m. Fills touching (C,) m2."""
    for i in range(len(touching)):
        part = min(max((depth - heights[i]) / max(slopes[i], LEAST_RISE) + 0.5, 0.0), 1.0)
        touching[i] = cover[i] * part
    return touching.sum()


@njit(cache=True, error_model="numpy")
def on_rigid(shape, of_line, area, whole, sunk, law):
    """(m2 of the face, the part of the force on it) under a crown that has given way, as if it were over the face's
    middle if the contact goes beyond the face. whole, sunk: as _given_way has them. of_line: m, of a line, 0 of a spot.
    area: m2 of the face that touches."""
    half = law.half_face
    if of_line > 0.0:
        wide, held = math.sqrt(2 * (sunk + law.roughness) / shape[0]), 1.0
        if shape[2] + wide <= half:
            return min(2 * wide * of_line, area), 1.0
        if wide > half:
            share = half / wide
            wide, held = half, (3 - share * share) * share / 2
        return 2 * wide * of_line, held
    if shape[2] + math.sqrt(whole / math.pi) <= half:
        return min(whole, area), 1.0
    part, held = disc_on_face(whole / math.pi, half, 0.0, 0.0)
    return whole * part, held


@njit(cache=True, error_model="numpy")
def hertz_gaps(heights, sunk, given, rough):
    """(C,) m: heights by which the gap beside a flattened crown is Hertz's. given: how much of it is due to the body,
    not to roughness and springs; where nothing is, the gap is the shape's own."""
    gaps, level = heights.copy(), sunk + rough
    for i in range(len(gaps)):
        square = (heights[i] - sunk) / level
        if square > 0.0:
            x = math.sqrt(square)
            hertz = 2 / math.pi * (x + (square - 1.0) * math.atan(x))
            gaps[i] -= given * level * (square - hertz)
    return gaps
