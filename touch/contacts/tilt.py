"""Rods at an angle to a flat pad, and fingertips that are rods at an angle to a flat face: one end touches first.

Over a rod's line of contact the gap between it and the pad grows from the end that touches. Three things give way,
and `angle` is what they leave of the angle. The sensor's face lies on the pad's springs, as it does under flat
bodies, and turns with the rod as far as the force's moment at the face's edge turns it: F w/2 over k w^4/12. The
silicone beside the face takes the end that sinks in: with R the rod's radius and k the springs, 4/3 k sqrt(2 R)
depth^1.5 for each metre of the line (Johnson, Contact Mechanics, section 4.3), whose integral over the length l that
is in contact is

    F = 4/3 k sqrt(2 R) angle^1.5 l^2.5/2.5

Where that reaches the face, the rest of the force is on the face: under a skin on a part of it by the same formula with
the skin's springs, on a bare face on its edge alone. Beside a bare line gas conducts as

    atan(w/2/sqrt(2 R (d + gap)))/sqrt(d + gap)

as in a wedge (thermal/contact/gas_beside.py), d the gap of faces that touch without force; along the rod the arc
tangent is taken as the mean of both ends'.

What is left of the line is its `share`: the contact conducts as that part of a line with the same force would.

A fingertip that is a rod itself is as stiff as what it is made of, and its pad follows it: the pad's springs are
pressed in by depth - angle s at s from the lower end, in strips of half width sqrt(2 R (depth - angle s)), cut off
where the pad ends: the skin's on a skinned sensor, and softer ones beside it, of what sinks in deeper than the far end
of its face. Their sum is the force, from which the depth follows.

F: fingertips, N: what a pad may meet.
"""

from __future__ import annotations

import math

from thermograsp.compiled import njit

from ...thermal import Pad, Surface
from ...thermal.contact import FIRST_FORCE, cylinder_footprint, face_joint, skinned
from ...thermal.numerics import Array, namespace_of
from ..scene import BodyShape, PadPlace

TURN, SOFT, FIRM, GAP, RADIUS, HALF, HALF_PAD, HALF_FACE, TILT = range(9)
"""Of a rod under a pad: rad/N that turn the face, N/m^2.5 of the silicone and of the skin on the face (0 without one),
m of the gap (0 under a skin), the rod's radius m, half its length and half the pad's and the face's sides m."""
_LEAST = math.exp(FIRST_FORCE)  # N, of a face that the rod does not press: what gas conducts alone
_LEVEL = 1e-7  # rad, below which there is no angle
_STEPS = 4  # Newton's, of an increasing convex function, from above
_LEANING_STEPS = 14  # likewise, from farther above


def tilt_row(
    pad: PadPlace, silicone: Pad, shape: BodyShape, radius: float, length: float
) -> tuple[float, ...]:
    """(TILT,) of a cylinder under a flat pad."""
    springs, line = silicone.foundation_modulus / silicone.thickness, 4 / 3 * math.sqrt(2 * radius) / 2.5
    sheet = skinned(silicone, pad.skin)
    soft = line * sheet.foundation_modulus / sheet.thickness
    turn = silicone.face / 2 / (springs * silicone.face**4 / 12)
    sizes = radius, length / 2, silicone.width / 2, silicone.face / 2
    if pad.skin is not None:
        return (turn, soft, line * pad.skin.stiffness, 0.0, *sizes)
    law = cylinder_footprint(sheet, face_joint(None, Surface.of(shape.material)), radius, length)
    return (turn, soft, 0.0, float(law["mean_gap"]), *sizes)


@njit(cache=True, borrows=True, error_model="numpy")
def tilted(tilt, force, slope, middle):
    """(share of the line, force N on it) of a rod under a force N > 0. slope: tangent of the angle between the rod and
    the pad, above 0 where its axis leads away from it; middle: m, the pad's middle from the rod's along the pad."""
    angle = abs(slope) - tilt[TURN] * force
    if not angle > _LEVEL:
        return 1.0, force
    cosine = 1 / math.sqrt(1 + slope * slope)
    # the line that is nearest to the pad is not under the rod's axis
    along = (middle if slope > 0 else -middle) - tilt[RADIUS] * abs(slope) * cosine
    half = tilt[HALF] * cosine
    start, end = max(-along - half, -tilt[HALF_PAD]), min(half - along, tilt[HALF_PAD])
    first, last = max(start, -tilt[HALF_FACE]), min(end, tilt[HALF_FACE])
    width = last - first
    if not width > 0:
        return 1.0, force  # it is not over the face
    steep, reach = angle * math.sqrt(angle), first - start
    soft = tilt[SOFT] * steep
    deep = (force / soft) ** 0.4  # m of the silicone alone
    gap = angle * max(reach - deep, 0.0)
    pressed = max(force - soft * reach**2.5, 0.0)
    if tilt[FIRM] > 0:
        firm = tilt[FIRM] * steep
        long = (pressed / firm) ** 0.4
        for _ in range(_STEPS):
            held = firm * long**2.5 + soft * ((reach + long) ** 2.5 - long**2.5)
            rate = 2.5 * (firm * long**1.5 + soft * ((reach + long) ** 1.5 - long**1.5))
            long = max(long - (held - force) / rate, 0.0) if pressed > 0 else 0.0
        share, pressed = min(long / width, 1.0), min(firm * long**2.5, pressed)
    else:
        near, far = math.sqrt(1 + gap / tilt[GAP]), math.sqrt(1 + (gap + angle * width) / tilt[GAP])
        wide = tilt[HALF_FACE] / math.sqrt(2 * tilt[RADIUS] * tilt[GAP])
        # the integral of 1/sqrt(1 + gap/d) over the line
        share = min((math.atan(wide / near) + math.atan(wide / far)) / math.atan(wide) / (near + far), 1.0)
    return share, max(pressed, min(force, _LEAST * share))


def array_tilted(tilt: Array, force: Array, slope: Array, middle: Array) -> tuple[Array, Array]:
    """tilted as a pure function of arrays: NumPy, PyTorch, JAX. tilt: (..., TILT); the others of one shape. Forces that
    are not above 0 count as none."""
    xp = namespace_of(force)
    one = 1.0 + 0.0 * force
    angle = abs(slope) - tilt[..., TURN] * force
    cosine = 1 / (1 + slope * slope) ** 0.5
    along = xp.where(slope > 0, middle, -middle) - tilt[..., RADIUS] * abs(slope) * cosine
    half, pad, face = tilt[..., HALF] * cosine, tilt[..., HALF_PAD], tilt[..., HALF_FACE]
    start, end = xp.maximum(-along - half, -pad), xp.minimum(half - along, pad)
    first, last = xp.maximum(start, -face), xp.minimum(end, face)
    width = last - first
    is_tilted = (angle > _LEVEL) & (width > 0) & (force > 0)
    angle = xp.where(is_tilted, angle, one)
    width, load = xp.where(is_tilted, width, one), xp.where(is_tilted, force, one)
    reach = xp.where(is_tilted, first - start, one)
    steep = angle * angle**0.5
    soft = xp.where(is_tilted, tilt[..., SOFT], one) * steep
    gap = angle * (reach - (load / soft) ** 0.4).clip(0.0, None)
    pressed = (load - soft * reach**2.5).clip(0.0, None)
    skinned_face = tilt[..., FIRM] > 0
    firm, gas_gap = xp.where(skinned_face, tilt[..., FIRM], one), tilt[..., GAP]
    radius, gas_gap = xp.where(gas_gap > 0, tilt[..., RADIUS], one), xp.where(gas_gap > 0, gas_gap, one)
    near, far = (1 + gap / gas_gap) ** 0.5, (1 + (gap + angle * width) / gas_gap) ** 0.5
    wide = xp.where(face > 0, face, one) / (2 * radius * gas_gap) ** 0.5
    bare = (xp.arctan(wide / near) + xp.arctan(wide / far)) / xp.arctan(wide) / (near + far)
    # a power of 0 has no gradient
    firm, reached = firm * steep, pressed > 0
    long = (xp.where(reached, pressed, one) / firm) ** 0.4
    for _ in range(_STEPS):
        held = firm * long**2.5 + soft * ((reach + long) ** 2.5 - long**2.5)
        rate = 2.5 * (firm * long**1.5 + soft * ((reach + long) ** 1.5 - long**1.5))
        long = xp.where(reached, (long - (held - load) / rate).clip(1e-12, None), one)
    on_skin = xp.where(reached, xp.minimum(firm * long**2.5, pressed), 0.0 * one)
    under = xp.where(reached, long / width, 0.0 * one)
    share = xp.where(skinned_face, under, bare).clip(None, 1.0)
    pressed = xp.where(skinned_face, on_skin, pressed)
    rest = xp.minimum(load, _LEAST * share)
    return xp.where(is_tilted, share, one), xp.where(is_tilted, xp.maximum(pressed, rest), force)


@njit(cache=True, borrows=True, error_model="numpy")
def leaning(bend, force, angle, curvature, line_share, width, face_reach, face_width, depth):
    """(area m2 on the sensor's face, force N on it, depth m at its lower end) of a rod-shaped pad whose line falls by
    angle m per m towards a flat face; all 0 where the face does not reach it. bend: round_pads.py's. curvature: 1/m
    across the line. line_share: how much the pad's y lies across the line. width, face_reach and face_width: half
    lengths m of what touches along the line, and of the face across and along it. depth: m at which the level line
    would bear the force."""
    soft_reach = line_share * bend[8] + (1 - line_share) * bend[9]
    soft_width = max((1 - line_share) * bend[8] + line_share * bend[9], width)
    firm_reach = line_share * bend[3] + (1 - line_share) * bend[4]
    near, far, end = (
        (soft_width - face_width) * angle,
        (soft_width + face_width) * angle,
        2 * soft_width * angle,
    )
    firm, soft, load = bend[2], bend[7], force * angle
    most_soft = far if soft < firm else math.inf
    depth += angle * (soft_width + width)  # no less, whatever the springs beside the face bear
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
        change = (held - load) / rate
        depth = max(depth - change, depth / 4)
        if abs(change) < 1e-14 * depth:
            break
    lower, upper = depth - near, max(depth - far, 0.0)
    if lower <= 0:
        return 0.0, 0.0, 0.0
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


def array_leaning(
    bend: Array,
    force: Array,
    angle: Array,
    curvature: Array,
    line_share: Array,
    width: Array,
    face_reach: Array,
    face_width: Array,
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

    soft_reach, firm_reach = blend(line_share, 8), blend(line_share, 3)
    soft_width = xp.maximum(blend(1 - line_share, 8), width)
    near, far, end = (
        (soft_width - face_width) * angle,
        (soft_width + face_width) * angle,
        2 * soft_width * angle,
    )
    firm, soft, load = bend[..., 2], bend[..., 7], force * angle
    most_soft = xp.where(soft < firm, far, math.inf + far)
    depth = depth + angle * (soft_width + width)
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
        depth = xp.maximum(depth - (held - load) / rate, depth / 4)
    lower, upper = (depth - near).clip(0.0, None), (depth - far).clip(0.0, None)
    (most, wide), (least, narrow) = strips(lower, face_reach), strips(upper, face_reach)
    return (wide - narrow) / angle, firm * (most - least) / angle, lower
