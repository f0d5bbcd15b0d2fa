"""Fingertips that are round themselves: balls, capsules, ellipsoids, cylinders that touch with their sides.

Two bodies of principal curvatures touch as one of their sum touches a flat one (Johnson, Contact Mechanics, section
4.1): the gap is x^2 k1/2 + y^2 k2/2, with k1 >= k2 (1/m) of the sum of both bodies' curvatures in the tangent plane,
which need not lie along one another. Sunk in by D into the pad, an elastic foundation as in thermal/contact/area.py,
p = K/d (D - x^2 k1/2 - y^2 k2/2) over the ellipse of half axes sqrt(2 D/k1) and sqrt(2 D/k2), cut off where either body
ends; the sensor's face takes what of it lies on it. Of two fingertips the springs of both are in series, and what lies
on both faces counts, whichever of the two is asked.

A straight fingertip, a capsule or a cylinder's side, that leans on a flat face by more than ALIGNED presses its lower
end. It is as stiff as what it is made of, and its pad follows it: the springs are pressed in by depth - angle s at s
from the lower end, in strips of half width sqrt(2 R (depth - angle s)), cut off where the pad ends: the skin's on a
skinned sensor, and softer ones beside it, of what sinks in deeper than the far end of its face. Their sum is the force,
from which the depth follows.

F: fingertips, N: what a pad may meet.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import math
from collections.abc import Sequence

import mujoco
import numpy as np

from thermograsp.compiled import njit

from ...thermal.contact import Wedge
from ...thermal.numerics import Array, namespace_of
from ..scene import BodyShape, PadPlace

BEND, CURVES, SIDES = 10, 7, 8
"""Of a pad: curvatures 1/m along its y and z, stiffness Pa/m, half the sides m of what bears force, half the face's m
along them, stiffness Pa/m beside a skinned sensor and half the whole pad's sides m. Of what it meets: curvatures 1/m
and half lengths m along two axes of its frame, how much its own springs give way, m3/N, and half the sides m of its
sensor's face, of objects none; and how the two lie to one another, round_contact's `sides`, which of an ellipsoid are
longer or shorter than 1 where it is more or less curved than on its axis."""
ALIGNED = 0.05
"""m per m, about 3 degrees, up to which a straight fingertip counts as level: fingers and what they hold give way, and
so do MuJoCo's soft contacts, whose angles say nothing of less."""
WIDE = 10.0
"""m, half of what no pad reaches the end of."""
_LEAST = 1e-7  # of the larger curvature: what is straighter counts as that
_ALIKE = 1e-9  # of the mean curvature, by which the two differ at most where it is round
_EVENLY = 5 / 6  # of a line, the square of the mean pressure over the mean of its square
_NEARLY = 0.999  # of a line's depth at one end to that at the other, from which on it is the same
_NEWTON_STEPS = 8
_LEANS = 1e-7  # m per m, below which a line lies level
_LEANING_STEPS = 20  # Newton's, or halves where the slope leads out of what is known


def bends(pads: Sequence[PadPlace]) -> np.ndarray:
    """(F, BEND)."""
    rows = np.zeros((len(pads), BEND))
    for row, pad in zip(rows, pads, strict=True):
        sheet = pad.silicone
        face = np.minimum(pad.stack.width, pad.size) / 2
        stiffness, half = sheet.foundation_modulus / sheet.thickness, pad.size / 2
        if pad.skin is not None:  # the sensor's face is under it and takes nearly all
            stiffness, half = pad.skin.stiffness, face
        soft = sheet.foundation_modulus / sheet.thickness
        row[:] = (*pad.curvature, stiffness, *half, *face, soft, *(pad.size / 2))
    return rows


def curves(model: mujoco.MjModel, pads: Sequence[PadPlace], shapes: Sequence[BodyShape]) -> np.ndarray:
    """(N, 3, CURVES): of the objects' geoms, by the axis of their frame that the pad looks along, along the other two
    in their order; and of the pads, along their y and z."""
    geoms = [geom for shape in shapes for geom in shape.geoms]
    rows = np.zeros((len(geoms) + len(pads), 3, CURVES))
    rows[..., 5:] = WIDE
    for n, geom in enumerate(geoms):
        for axis in range(3):
            rows[n, axis, :4] = _geom(model, geom, axis)
    for n, (pad, bend) in enumerate(zip(pads, bends(pads), strict=True), len(geoms)):
        rows[n] = (*pad.curvature, *bend[3:5], 1 / bend[2], *bend[5:7])
    return rows


def _geom(model: mujoco.MjModel, geom: int, axis: int) -> tuple[float, float, float, float]:
    kind, size = mujoco.mjtGeom(int(model.geom_type[geom])), model.geom_size[geom].tolist()
    kinds, others = mujoco.mjtGeom, [i for i in range(3) if i != axis]
    if kind == kinds.mjGEOM_SPHERE:
        return (1 / size[0], 1 / size[0], WIDE, WIDE)
    if kind == kinds.mjGEOM_ELLIPSOID:
        first, second = (size[axis] / size[i] ** 2 for i in others)
        return (first, second, WIDE, WIDE)
    if kind in (kinds.mjGEOM_CYLINDER, kinds.mjGEOM_CAPSULE) and axis < 2:
        return (1 / size[0], 0.0, WIDE, size[1])
    if kind == kinds.mjGEOM_CAPSULE:
        return (1 / size[0], 1 / size[0], WIDE, WIDE)
    if kind == kinds.mjGEOM_CYLINDER:
        return (0.0, 0.0, size[0], size[0])
    if kind == kinds.mjGEOM_BOX:
        return (0.0, 0.0, size[others[0]], size[others[1]])
    return (0.0, 0.0, WIDE, WIDE)


@njit(cache=True, borrows=True, error_model="numpy")
def round_contact(bend, curve, sides, force, y, z):
    """(area m2 and force N on the face were it met in its middle, share of that area that is on it, how many times as
    long as broad it is, how evenly it presses: its mean pressure's square over the mean of the pressure's square; and
    the Wedge that is over the face) at a normal force N > 0 that presses at y and z m from the pad's middle. sides:
    (SIDES,) the other's first axis along the pad's y and z, then its second one, how much its flat face rises towards
    the pad along the pad's y and z, m per m, and where the force presses from the other pad's middle, m along them."""
    first = bend[0] + curve[0] * sides[0] * sides[0] + curve[1] * sides[2] * sides[2]
    both = curve[0] * sides[0] * sides[1] + curve[1] * sides[2] * sides[3]
    second = bend[1] + curve[0] * sides[1] * sides[1] + curve[1] * sides[3] * sides[3]
    middle, spread = (first + second) / 2, math.hypot((first - second) / 2, both)
    most, least = middle + spread, max(middle - spread, _LEAST * (middle + spread))
    # the direction of the larger curvature, and how much of the pad's and the other's first axes lies along it
    if spread > _ALIKE * middle:
        first_share = (1 + (first - second) / 2 / spread) / 2
    elif bend[0] + bend[1] == 0:  # any direction is as good: that of the sides of the one that is flat
        first_share, both = 1.0, 0.0
    else:
        first_share = sides[0] * sides[0] / (sides[0] * sides[0] + sides[1] * sides[1])
        both = sides[0] * sides[1]
    first_share = min(max(first_share, 0.0), 1.0)
    along, aside = math.sqrt(first_share), math.copysign(math.sqrt(1 - first_share), both)
    other = min((along * sides[0] + aside * sides[1]) ** 2, 1.0)
    own_reach = first_share * bend[3] + (1 - first_share) * bend[4]
    own_width = (1 - first_share) * bend[3] + first_share * bend[4]
    other_reach = other * curve[2] + (1 - other) * curve[3]
    other_width = (1 - other) * curve[2] + other * curve[3]
    reach, width = min(own_reach, other_reach), min(own_width, other_width)
    face_reach = min(first_share * bend[5] + (1 - first_share) * bend[6], reach)
    face_width = min((1 - first_share) * bend[5] + first_share * bend[6], width)
    stiffness = bend[2] / (1 + bend[2] * curve[4])
    depth = _depth(force / stiffness, most, least, reach, width)
    across, beyond = along * y + aside * z, along * z - aside * y
    # a round body is no wider than its radius
    bulk = min(other_reach, 1 / max(other * curve[0] + (1 - other) * curve[1], 1 / WIDE))
    bulk_width = min(other_width, 1 / max((1 - other) * curve[0] + other * curve[1], 1 / WIDE))
    left, right = max(-face_reach - across, -bulk), min(face_reach - across, bulk)
    leans = abs(along * sides[5] - aside * sides[4]) - ALIGNED
    if leans > _LEANS and middle - spread < least:
        ends = other * curve[2] + (1 - other) * curve[3], (1 - other) * curve[2] + other * curve[3]
        area, load, lower = leaning(
            bend, force, leans, most, first_share, ends, (reach, width), (face_reach, face_width), depth
        )
        wedge = Wedge(lower, leans, 0.0, most, left, right, 0.0, 2 * face_width)
        if area <= 0:
            return 0.0, 0.0, 0.0, 1.0, 1.0, wedge
        a, b = math.sqrt(2 * lower / most), lower / leans
        share = _kept(across, 0.0, a, face_reach, WIDE)
        longer = min(b, 2 * face_width) / (2 * min(a, face_reach))
        even = _along_line(max(1 - 2 * face_width * leans / lower, 0.0))
        return area, load, share, max(longer, 1 / longer), even, wedge
    a, b = math.sqrt(2 * depth / most), math.sqrt(2 * depth / least)
    far_across, far_beyond = along * sides[6] + aside * sides[7], along * sides[7] - aside * sides[6]
    if curve[4] > 0:  # another fingertip: what is on a face depends on where each pad's own middle is
        face_reach = min(first_share * bend[5] + (1 - first_share) * bend[6], own_reach)
        face_width = min((1 - first_share) * bend[5] + first_share * bend[6], own_width)
        other_reach = min(other * curve[5] + (1 - other) * curve[6], other_reach)
        other_width = min((1 - other) * curve[5] + other * curve[6], other_width)
        bulk, bulk_width = min(other_reach, bulk), min(other_width, bulk_width)
    else:
        other_reach = other_width = WIDE
    share = _kept(across, far_across, a, face_reach, other_reach)
    share *= _kept(beyond, far_beyond, b, face_width, other_width)
    left, right = max(-face_reach - across, -bulk - far_across), min(face_reach - across, bulk - far_across)
    lower, upper = (
        max(-face_width - beyond, -bulk_width - far_beyond),
        min(face_width - beyond, bulk_width - far_beyond),
    )
    wedge = Wedge(depth, 0.0, least, most, left, max(left, right), lower, max(lower, upper))
    face_reach, face_width = min(face_reach, other_reach), min(face_width, other_width)
    x, y = min(face_reach / a, 1.0), min(face_width / b, 1.0)
    area, load = _clipped(x, y)
    longer = min(b, face_width) / min(a, face_reach)
    even = load * load / (area * _squared(x, y))
    return 4 * a * b * area, 4 * stiffness * depth * a * b * load, share, max(longer, 1 / longer), even, wedge


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _depth(load, most, least, reach, width):
    """m at which the pressure over its stiffness is the load m3, over a rectangle of half sides m."""
    # what an ellipse, strips or the whole rectangle without its curvature would need: each is less
    depth = max(math.sqrt(load * math.sqrt(most * least) / math.pi), load / (4 * reach * width))
    depth = max(depth, (0.375 * load * math.sqrt(most / 2) / width) ** (2 / 3))
    depth = max(depth, (0.375 * load * math.sqrt(least / 2) / reach) ** (2 / 3))
    for _ in range(_NEWTON_STEPS):
        a, b = math.sqrt(2 * depth / most), math.sqrt(2 * depth / least)
        area, held = _clipped(min(reach / a, 1.0), min(width / b, 1.0))
        change = (depth * held - load / (4 * a * b)) / area
        depth -= change
        if abs(change) < 1e-15 * depth:
            break
    return depth


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _clipped(x, y):
    """Of a quarter of the unit disc in a rectangle x by y, at most 1: its area, and the integral of 1 - r^2 over it."""
    if x * x + y * y <= 1.0:
        return x * y, x * y * (1 - (x * x + y * y) / 3)
    root = math.sqrt(1 - y * y)
    area = y * root + _disc(x) - _disc(root)
    load = y * root * (1 - y * y / 3 - root * root / 3) + 2 / 3 * (_cap(x) - _cap(root))
    return area, load


@njit(cache=True, error_model="numpy", inline="always")
def _disc(s):
    return (s * math.sqrt(1 - s * s) + math.asin(s)) / 2


@njit(cache=True, error_model="numpy", inline="always")
def _cap(s):
    return (s * (5 - 2 * s * s) * math.sqrt(1 - s * s) + 3 * math.asin(s)) / 8


@njit(cache=True, error_model="numpy", inline="always")
def _along_line(ratio):
    """How evenly a line presses whose depth falls evenly to this share of what it is at its lower end."""
    if ratio > _NEARLY:
        return _EVENLY
    middle = (1 - ratio**2.5) / 2.5
    return _EVENLY * middle * middle * 1.5 * 3.5 / ((1 - ratio**1.5) * (1 - ratio**3.5))


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _squared(x, y):
    """Of such a quarter in a rectangle, the integral of (1 - r^2)^2 over it."""
    if x * x + y * y <= 1.0:
        return x * y * _square_mean(x, y)
    root = math.sqrt(1 - y * y)
    return root * y * _square_mean(root, y) + 8 / 15 * (_cap_squared(x) - _cap_squared(root))


@njit(cache=True, error_model="numpy", inline="always")
def _square_mean(x, y):
    """Of (1 - r^2)^2 over a rectangle from the middle to x and y."""
    first, second = x * x, y * y
    return 1 - 2 / 3 * (first + second) + (first * first + second * second) / 5 + 2 / 9 * first * second


@njit(cache=True, error_model="numpy", inline="always")
def _cap_squared(s):
    """The integral of (1 - s^2)^(5/2) from 0 to s."""
    square = s * s
    return (s * math.sqrt(1 - square) * (33 + square * (8 * square - 26)) + 15 * math.asin(s)) / 48


@njit(cache=True, error_model="numpy", inline="always")
def _kept(at, other_at, reach, half, other_half):
    """Share of an interval of half width reach that is on two faces of these half widths, of what would be were all
    three round one middle. The interval's middle is `at` from the one face's and other_at from the other's."""
    both = min(half - at, reach, other_half - other_at) + min(half + at, reach, other_half + other_at)
    return min(max(both, 0.0) / (2 * min(reach, half, other_half)), 1.0)


@njit(cache=True, borrows=True, error_model="numpy")
def leaning(bend, force, angle, curvature, line_share, ends, firm_half, face_half, depth):
    """(area m2 on the sensor's face, force N on it, depth m at its lower end) of a rod-shaped pad whose line falls by
    angle m per m towards a flat face; 0, 0 and less than 0 where the face does not reach it.

    bend: bends'. curvature: 1/m across the line. line_share: how much the pad's y lies across the line. Half lengths m,
    across the line and along it, of the object: ends; of what bears on the level line: firm_half; of the face:
    face_half. depth: m at which the level line would bear the force."""
    (firm_reach, width), (face_reach, face_width) = firm_half, face_half
    soft_reach = min(line_share * bend[8] + (1 - line_share) * bend[9], ends[0])
    soft_width = max(min((1 - line_share) * bend[8] + line_share * bend[9], ends[1]), width)
    near, far, end = (
        (soft_width - face_width) * angle,
        (soft_width + face_width) * angle,
        2 * soft_width * angle,
    )
    firm, soft, load = bend[2], bend[7], force * angle
    most_soft = far if soft != firm else math.inf
    depth += angle * (soft_width + width)  # no less, whatever the springs beside the face bear
    low, high = 0.0, depth
    for _ in range(_LEANING_STEPS):
        sunk = min(depth, most_soft)
        held, rate = 0.0, 0.0
        # springs begin at one place and end at the other
        for stiffness, reach, below, behind in (
            (soft, soft_reach, sunk, sunk - near),
            (firm, firm_reach, depth - near, depth - far),
            (soft, soft_reach, sunk - far, sunk - end),
        ):
            one, rises = _strips(max(below, 0.0), curvature, reach)
            other, falls = _strips(max(behind, 0.0), curvature, reach)
            held += stiffness * (one - other)
            if stiffness == firm or depth < most_soft:
                rate += stiffness * (rises - falls)
        if held < load:
            low = depth
        else:
            high = depth
        before, depth = depth, depth - (held - load) / rate
        if not low <= depth <= high:
            depth = (low + high) / 2
        if abs(depth - before) < 1e-14 * depth:
            break
    lower, upper = depth - near, max(depth - far, 0.0)
    if lower <= 0:
        return 0.0, 0.0, lower
    most, wide = _strips(lower, curvature, face_reach)
    least, narrow = _strips(upper, curvature, face_reach)
    return (wide - narrow) / angle, firm * (most - least) / angle, lower


@njit(cache=True, error_model="numpy", inline="always")
def _strips(depth, curvature, reach):
    """Of strips whose depth grows from 0 to `depth` m, integrated over the depth: their load over the stiffness, m4,
    and their widths, m2, which is the load's derivative."""
    wide, shallow = math.sqrt(2 / curvature), min(depth, curvature * reach * reach / 2)
    root, beyond = math.sqrt(shallow), depth - shallow
    held, area = 8 / 15 * wide * shallow * shallow * root, 4 / 3 * wide * shallow * root
    return held + beyond * (area + reach * beyond), area + 2 * reach * beyond


def array_round_contact(
    bend: Array, curve: Array, sides: Array, rise: Array, force: Array, y: Array, z: Array
) -> tuple[Array, Array, Array, Array, Array, Wedge]:
    """(area m2, force N, share, length over breadth, evenness, wedge) of round_contact, of the force's shape. bend
    (..., BEND) of the pads, curve (..., CURVES), sides (..., 2, 2) and rise (..., 2) of what they meet; force: N > 0.
    y, z: m."""
    xp = namespace_of(force)
    (c1, c2), (half1, half2) = (curve[..., 0], curve[..., 1]), (curve[..., 2], curve[..., 3])
    y1, z1, y2, z2 = (sides[..., i, j] for i in range(2) for j in range(2))
    first = bend[..., 0] + c1 * y1 * y1 + c2 * y2 * y2
    both = c1 * y1 * z1 + c2 * y2 * z2
    second = bend[..., 1] + c1 * z1 * z1 + c2 * z2 * z2
    middle, half = (first + second) / 2, (first - second) / 2
    square = half * half + both * both
    alike = square <= (_ALIKE * middle) ** 2
    spread = xp.where(alike, 1.0 + 0.0 * square, square) ** 0.5
    most = middle + xp.where(alike, 0.0 * spread, spread)
    least = xp.maximum(middle - xp.where(alike, 0.0 * spread, spread), _LEAST * most)
    of_other = y1 * y1 / (y1 * y1 + z1 * z1)
    first_part = xp.where(alike, of_other, (1 + half / spread) / 2).clip(0.0, 1.0)
    both = xp.where(alike, y1 * z1, both)
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
    depth = _depths(xp, force / bend[..., 2], most, least, reach, width)
    a, b = (2 * depth / most) ** 0.5, (2 * depth / least) ** 0.5
    area, load, squared = _clippings(xp, (face_reach / a).clip(None, 1.0), (face_width / b).clip(None, 1.0))
    even = load * load / (area * squared)
    crosswise, lengthwise = along * y + aside * z, along * z - aside * y
    none = 0.0 * depth
    bulk = xp.minimum(blend(other, half1, half2), 1 / blend(other, c1, c2).clip(1 / WIDE, None)) + none
    bulk_width = xp.minimum(blend(1 - other, half1, half2), 1 / blend(1 - other, c1, c2).clip(1 / WIDE, None))
    bulk_width = bulk_width + none
    left, right = xp.maximum(-face_reach - crosswise, -bulk), xp.minimum(face_reach - crosswise, bulk)
    lower_end = xp.maximum(-face_width - lengthwise, -bulk_width)
    upper_end = xp.minimum(face_width - lengthwise, bulk_width)
    share = _kept_of(xp, crosswise, a, face_reach) * _kept_of(xp, lengthwise, b, face_width)
    longer = xp.minimum(b, face_width) / xp.minimum(a, face_reach)
    area, load = 4 * a * b * area, 4 * bend[..., 2] * depth * a * b * load

    fall = abs(along * rise[..., 1] - aside * rise[..., 0]) - ALIGNED
    leans = (fall > _LEANS) & (middle - xp.where(alike, 0.0 * spread, spread) < least)
    fall = xp.where(leans, fall, 1.0 + 0.0 * fall)
    ends = blend(other, half1, half2), blend(1 - other, half1, half2)
    firm_half, face_half = (reach, width), (face_reach, face_width)
    leant = array_leaning(bend, force, fall, most, first_part, ends, firm_half, face_half, depth)
    reached = leant[0] > 0
    wedge = Wedge(
        xp.where(leans, leant[2], depth),
        xp.where(leans, fall, none),
        xp.where(leans, none, least + none),
        most + none,
        left,
        xp.maximum(left, right),
        xp.where(leans, none, lower_end),
        xp.where(leans, 2 * face_width + none, xp.maximum(lower_end, upper_end)),
    )
    lower = xp.where(reached, leant[2], 1.0 + 0.0 * depth)
    a, b = (2 * lower / most) ** 0.5, lower / fall
    leant_share = xp.where(reached, _kept_of(xp, crosswise, a, face_reach), 0.0 * depth)
    leant_longer = xp.minimum(b, 2 * face_width) / (2 * xp.minimum(a, face_reach))
    ratio = (1 - 2 * face_width * fall / lower).clip(0.0, None)
    nearly = ratio > _NEARLY
    ratio = xp.where(nearly, 0.5 + 0.0 * ratio, ratio)
    leant_even = _EVENLY * (1 - ratio**2.5) ** 2 / 2.5**2 * 1.5 * 3.5 / ((1 - ratio**1.5) * (1 - ratio**3.5))
    leant_even = xp.where(nearly, _EVENLY + 0.0 * ratio, leant_even)
    longer = xp.where(leans, xp.where(reached, leant_longer, 1.0 + 0.0 * depth), longer)
    return (
        xp.where(leans, leant[0], area),
        xp.where(leans, leant[1], load),
        xp.where(leans, leant_share, share),
        xp.maximum(longer, 1 / longer),
        xp.where(leans, xp.where(reached, leant_even, 1.0 + 0.0 * even), even),
        wedge,
    )


def array_on_ellipsoid(radii: Array, curve: Array, lean: Array, normal: Array, across: Array) -> Array:
    """(..., G, 2, 2), the sides of ellipsoids that round pads touch, as pad_contacts.py has them, as a pure function of
    arrays. radii: (G, A) m, 0 of what is none; curve: (..., G, CURVES). lean (..., G, 2): along the pads' y and z of
    their normals where they touch; normal (..., G, 3) and across (..., G, 3, 2): of the pads' axes along the geoms'."""
    xp = namespace_of(normal)
    of_axes = radii[:, :3]
    of_axes = xp.where(of_axes > 0, of_axes, 1.0 + 0.0 * of_axes)
    half = of_axes.prod(-1)[:, None] / of_axes
    upright = (1.0 - (lean * lean).sum(-1)).clip(0.0, None)[..., None] ** 0.5
    there = upright * normal + (across * lean[..., None, :]).sum(-1)
    turned = ((normal + there) / (1 + upright))[..., None]
    across = across - turned * lean[..., None, :]
    square = (half * there * there).sum(-1)
    on = (half[..., None] * there[..., None] * across).sum(-2)

    def tensor(i: int, j: int) -> Array:
        return (half * across[..., i] * across[..., j]).sum(-1) - on[..., i] * on[..., j] / square

    yy, yz, zz, high = tensor(0, 0), tensor(0, 1), tensor(1, 1), square**0.5
    known = (curve[..., :2] > 0).all(-1)
    one, other = (xp.where(known, curve[..., n], 1.0 + 0.0 * curve[..., n]) for n in range(2))
    first, second = (high * zz / (yy * zz - yz * yz) / one) ** 0.5, (high / zz / other) ** 0.5
    rows = xp.stack([first, -first * yz / zz], -1), xp.stack([0.0 * second, second], -1)
    return xp.stack(list(rows), -2)


def _depths(xp, load, most, least, reach, width):
    depth = xp.maximum((load * (most * least) ** 0.5 / math.pi) ** 0.5, load / (4 * reach * width))
    depth = xp.maximum(depth, (0.375 * load * (most / 2) ** 0.5 / width) ** (2 / 3))
    depth = xp.maximum(depth, (0.375 * load * (least / 2) ** 0.5 / reach) ** (2 / 3))
    for _ in range(_NEWTON_STEPS):
        a, b = (2 * depth / most) ** 0.5, (2 * depth / least) ** 0.5
        area, held, _ = _clippings(xp, (reach / a).clip(None, 1.0), (width / b).clip(None, 1.0))
        depth = depth - (depth * held - load / (4 * a * b)) / area
    return depth


def _clippings(xp, x, y):
    inside = x * x + y * y <= 1.0
    root = (1 - y * y).clip(0.0, None) ** 0.5
    asin_x, asin_root = math.pi / 2 - xp.acos(x), xp.acos(y)  # of sqrt(1 - y^2)
    cos_x = (1 - x * x).clip(0.0, None) ** 0.5
    area = y * root + (x * cos_x + asin_x) / 2 - (root * y + asin_root) / 2
    cap_x = (x * (5 - 2 * x * x) * cos_x + 3 * asin_x) / 8
    cap_root = (root * (5 - 2 * root * root) * y + 3 * asin_root) / 8
    load = y * root * (1 - y * y / 3 - root * root / 3) + 2 / 3 * (cap_x - cap_root)
    squared = (
        root * y * _square_means(root, y)
        + 8
        / 15
        * (
            (x * cos_x * (33 + x * x * (8 * x * x - 26)) + 15 * asin_x)
            - (root * y * (33 + root * root * (8 * root * root - 26)) + 15 * asin_root)
        )
        / 48
    )
    return (
        xp.where(inside, x * y, area),
        xp.where(inside, x * y * (1 - (x * x + y * y) / 3), load),
        xp.where(inside, x * y * _square_means(x, y), squared),
    )


def _square_means(x, y):
    """_square_mean of arrays that are not NumPy's, too."""
    first, second = x * x, y * y
    return 1 - 2 / 3 * (first + second) + (first * first + second * second) / 5 + 2 / 9 * first * second


def _kept_of(xp, at, reach, half):
    both = xp.minimum(half, at + reach) - xp.maximum(-half, at - reach)
    return (both.clip(0.0, None) / (2 * xp.minimum(reach, half))).clip(None, 1.0)


def array_leaning(
    bend: Array,
    force: Array,
    angle: Array,
    curvature: Array,
    line_share: Array,
    ends: tuple[Array, Array],
    firm_half: tuple[Array, Array],
    face_half: tuple[Array, Array],
    depth: Array,
) -> tuple[Array, Array, Array]:
    """leaning as a pure function of arrays of one shape, but for bend (..., BEND); angles above 0."""
    xp = namespace_of(force)

    def strips(below: Array, reach: Array) -> tuple[Array, Array]:
        wide, shallow = (2 / curvature) ** 0.5, xp.minimum(below, curvature * reach * reach / 2)
        beyond, area = below - shallow, 4 / 3 * wide * shallow**1.5
        return 8 / 15 * wide * shallow**2.5 + beyond * (area + reach * beyond), area + 2 * reach * beyond

    def blend(share: Array, one: int) -> Array:
        return share * bend[..., one] + (1 - share) * bend[..., one + 1]

    (firm_reach, width), (face_reach, face_width) = firm_half, face_half
    soft_reach = xp.minimum(blend(line_share, 8), ends[0])
    soft_width = xp.maximum(xp.minimum(blend(1 - line_share, 8), ends[1]), width)
    near, far, end = (
        (soft_width - face_width) * angle,
        (soft_width + face_width) * angle,
        2 * soft_width * angle,
    )
    firm, soft, load = bend[..., 2], bend[..., 7], force * angle
    most_soft = xp.where(soft != firm, far, math.inf + far)
    depth = depth + angle * (soft_width + width)
    low, high = 0.0 * depth, depth
    for _ in range(_LEANING_STEPS):
        sunk, held, rate = xp.minimum(depth, most_soft), 0.0 * depth, 0.0 * depth
        for stiffness, reach, below, behind in (
            (soft, soft_reach, sunk, sunk - near),
            (firm, firm_reach, depth - near, depth - far),
            (soft, soft_reach, sunk - far, sunk - end),
        ):
            one, rises = strips(below.clip(0.0, None), reach)
            other, falls = strips(behind.clip(0.0, None), reach)
            held = held + stiffness * (one - other)
            moves = (stiffness == firm) | (depth < most_soft)
            rate = rate + xp.where(moves, stiffness * (rises - falls), 0.0 * depth)
        less = held < load
        low, high = xp.where(less, depth, low), xp.where(less, high, depth)
        depth = depth - (held - load) / xp.where(rate > 0, rate, 1.0 + 0.0 * rate)
        depth = xp.where((depth >= low) & (depth <= high), depth, (low + high) / 2)
    upper, lower = (depth - far).clip(0.0, None), depth - near
    (most, wide), (least, narrow) = strips(lower.clip(0.0, None), face_reach), strips(upper, face_reach)
    return (wide - narrow) / angle, firm * (most - least) / angle, lower
