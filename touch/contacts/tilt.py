"""Rods and flat faces at an angle to a flat pad: only one end of them touches.

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

A flat face at an angle beyond ALIGNED does the same, with springs pressed in by depth - angle s at s from its lower
end, or the pad's, whichever is over the other: silicone that is as broad as what they share takes k b angle s^2/2 over
the length s, and the rest is the face's. A skin is in contact up to a length; beside the edge on a bare face gas
conducts as the mean of 1/(gap + angle s), and what conducts as a whole face's gas is a strip at that edge. Along a
corner the angle is that of the steepest fall, and the strip shrinks along both sides in proportion to its logarithm.

F: fingertips, N: what a pad may meet.
"""

from __future__ import annotations

import math

from thermograsp.compiled import njit

from ...thermal import Pad, Surface
from ...thermal.contact import (
    FIRST_FORCE,
    NARROW,
    ArrayLaws,
    array_patch_ends,
    array_patch_offset,
    cylinder_footprint,
    face_joint,
    patch_ends,
    patch_offset,
    skinned,
)
from ...thermal.numerics import Array, namespace_of
from ..scene import BodyShape, PadPlace

TURN, SOFT, FIRM, GAP, RADIUS, HALF, HALF_PAD, HALF_FACE, TILT = range(9)
"""Of a rod under a pad: rad/N that turn the face, N/m^2.5 of the silicone and of the skin on the face (0 without one),
m of the gap (0 under a skin), the rod's radius m, half its length and half the pad's and the face's sides m. Of a flat
face: Pa/m in place of N/m^2.5, no radius, and of a cylinder's end that in place of half the length."""
_LEAST = math.exp(FIRST_FORCE)  # N, of a face that the rod does not press: what gas conducts alone
ALIGNED = 0.05
"""rad, about 3 degrees, up to which flat faces count as aligned beyond what the force turns the face by: fingers and
what they hold give way, and so do MuJoCo's soft contacts, whose angles say nothing of less."""
_LEVEL = 1e-7  # rad, below which there is no angle
_THIN = 1e-12  # m, of a line that is not over the face
_STEPS = 4  # Newton's, of an increasing convex function, from above


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


def edge_row(pad: PadPlace, silicone: Pad, shape: BodyShape, radius: float) -> tuple[float, ...]:
    """(TILT,) of a flat face under a flat pad. radius: m of a cylinder's end, 0 of others."""
    springs, halves = (
        silicone.foundation_modulus / silicone.thickness,
        (silicone.width / 2, silicone.face / 2),
    )
    turn = silicone.face / 2 / (springs * silicone.face**4 / 12)
    if pad.skin is not None:
        return (turn, springs, pad.skin.stiffness, 0.0, 0.0, radius, *halves)
    law = cylinder_footprint(skinned(silicone, None), face_joint(None, Surface.of(shape.material)), 1.0, 1.0)
    return (turn, springs, 0.0, float(law["mean_gap"]), 0.0, radius, *halves)


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
    width = max(last - first, 0.0)  # none where it is not over the face
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
        share, pressed = min(long / max(width, _THIN), 1.0), min(firm * long**2.5, pressed)
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
    width = (last - first).clip(0.0, None)
    is_tilted = (angle > _LEVEL) & (force > 0) & (tilt[..., RADIUS] > 0)
    angle = xp.where(is_tilted, angle, one)
    width, load = xp.where(is_tilted, width, 0.0 * one), xp.where(is_tilted, force, one)
    reach = xp.where(is_tilted, first - start, one)
    steep = angle * angle**0.5
    soft = xp.where(is_tilted, tilt[..., SOFT], one) * steep
    gap = angle * (reach - (load / soft) ** 0.4).clip(0.0, None)
    pressed = (load - soft * reach**2.5).clip(0.0, None)
    skinned_face = tilt[..., FIRM] > 0
    firm, gas_gap = xp.where(skinned_face, tilt[..., FIRM], one), tilt[..., GAP]
    radius = xp.where(is_tilted & (gas_gap > 0), tilt[..., RADIUS], one)
    gas_gap = xp.where(gas_gap > 0, gas_gap, one)
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
    under = xp.where(reached, long / width.clip(_THIN, None), 0.0 * one)
    share = xp.where(skinned_face, under, bare).clip(None, 1.0)
    pressed = xp.where(skinned_face, on_skin, pressed)
    rest = xp.minimum(load, _LEAST * share)
    return xp.where(is_tilted, share, one), xp.where(is_tilted, xp.maximum(pressed, rest), force)


@njit(cache=True, borrows=True, error_model="numpy")
def fall(tilt, pad_first, pad_second, first, second):
    """The four, as edged takes them: of a cylinder's end, which has no axes, along the steepest fall and across it."""
    slope = math.hypot(first, second)
    if not (tilt[HALF] > 0 and slope > 0):
        return pad_first, pad_second, first, second
    one, other = first / slope, second / slope
    return pad_first * one + pad_second * other, pad_second * one - pad_first * other, slope, 0.0


@njit(cache=True, borrows=True, error_model="numpy")
def edged(tilt, law, force, together, share, pad_first, pad_second, first, second):
    """(part of a flat contact's area, force N on it, share of the pad's length beside the face that touches) at a
    normal force N > 0, of which the level face has `share` N. together: N on all geoms of the object, by which the pad
    turns. first, second: m per m by which the gap grows along the law's two axes; pad_first and pad_second: m, the
    pad's middle from the object's along them."""
    slope = math.hypot(first, second)
    angle = slope - ALIGNED - tilt[TURN] * together
    if not (angle > _LEVEL and law.size[0] > 0 and tilt[SOFT] > 0):
        return 1.0, share, 1.0
    reach, width, along, on_face, on_pad = 0.0, 0.0, 0.0, 1.0, 1.0
    for side in range(2):
        rise, pad, size = (
            (first, pad_first, law.size[0] / 2) if side == 0 else (second, pad_second, law.size[1] / 2)
        )
        middle = -pad if rise > 0 else pad  # of the object from the pad's, where the gap grows
        start, end = max(middle - size, -law.half_pad), min(middle + size, law.half_pad)
        begin, stop = max(start, -law.half_face), min(end, law.half_face)
        part = abs(rise) / slope
        reach, width, along = (
            reach + part * (begin - start),
            width + part * (stop - begin),
            along + part * (end - start),
        )
        on_face, on_pad = on_face * max(stop - begin, 0.0), on_pad * max(end - start, 0.0)
    if not on_pad > 0.0:
        return 1.0, share, 1.0
    soft = tilt[SOFT] * angle * on_pad / along
    borne, touched = soft * reach * reach / 2, min(math.sqrt(2 * force / soft) / along, 1.0)
    if not on_face > 0.0:
        return 1.0, share, touched
    if tilt[FIRM] > 0:
        firm = tilt[FIRM] * angle * on_face / width
        left, beside = max(force - borne, 0.0), soft * reach
        long = (math.sqrt(beside * beside + 2 * firm * left) - beside) / firm
        if long > width:
            long = (left + firm * width * width / 2) / (firm * width + beside)
        within = min(long, width)
        return within / width, min(firm * within * (long - within / 2), share), touched
    gap = tilt[GAP] + angle * max(reach - math.sqrt(2 * force / soft), 0.0)
    part = min(tilt[GAP] / (angle * width) * math.log1p(angle * width / gap), 1.0)
    return part, max(share * max(1 - borne / force, 0.0), min(share, _LEAST * part)), touched


@njit(cache=True, borrows=True, error_model="numpy")
def edge_patch(law, pad_first, pad_second, first, second, part, shares):
    """flat_patch of a part of the area, at the end where the gap is least: m, the second side; fills shares (4,)."""
    width, slope, length = 2 * law.half_face, first * first + second * second, 0.0
    for side in range(2):
        rise, pad, size = (first, pad_first, law.size[0]) if side == 0 else (second, pad_second, law.size[1])
        low, high = max(-law.half_face, -pad - size / 2), min(law.half_face, size / 2 - pad)
        length = (high - low) * part ** (rise * rise / slope)
        middle = low + length / 2 if rise > 0 else high - length / 2
        shares[side] = patch_offset(middle, length, width)
        shares[2 + side] = patch_ends(pad + middle, pad, length, size, width)
    return length


def array_fall(tilt: Array, laws: ArrayLaws, place: Array, rises: Array) -> tuple[Array, Array]:
    """fall as a pure function of arrays: (..., 2) each. place: (..., 3) m."""
    xp = namespace_of(rises)
    pad = (laws.select * place[..., None, :]).sum(-1)
    square = (rises * rises).sum(-1)
    slope = xp.where(square > 0, square, 1.0 + 0.0 * square) ** 0.5
    one, other = rises[..., 0] / slope, rises[..., 1] / slope
    turned = xp.stack((pad[..., 0] * one + pad[..., 1] * other, pad[..., 1] * one - pad[..., 0] * other), -1)
    down = xp.stack((slope, 0.0 * slope), -1)
    is_round = ((tilt[..., HALF] > 0) & (tilt[..., RADIUS] == 0) & (square > 0))[..., None]
    return xp.where(is_round, turned, pad), xp.where(is_round, down, rises)


def array_edged(
    tilt: Array, laws: ArrayLaws, force: Array, together: Array, share: Array, pad: Array, rises: Array
) -> tuple[Array, Array, Array]:
    """edged as a pure function of arrays: NumPy, PyTorch, JAX. tilt: (..., TILT); pad and rises (..., 2); force and
    share of one shape. Forces that are not above 0 count as none."""
    xp = namespace_of(force)
    one = 1.0 + 0.0 * force
    square = (rises * rises).sum(-1)
    slope = xp.where(square > 0, square, one) ** 0.5
    angle = xp.where(square > 0, slope, 0.0 * one) - ALIGNED - tilt[..., TURN] * together
    size = laws.size / 2
    middle, half_pad, half_face = (
        xp.where(rises > 0, -pad, pad),
        laws.half_pad[..., None],
        laws.half_face[..., None],
    )
    start, end = xp.maximum(middle - size, -half_pad), xp.minimum(middle + size, half_pad)
    begin, stop = xp.maximum(start, -half_face), xp.minimum(end, half_face)
    parts, face, both = (
        abs(rises) / slope[..., None],
        (stop - begin).clip(0.0, None),
        (end - start).clip(0.0, None),
    )
    on_face, on_pad = face[..., 0] * face[..., 1], both[..., 0] * both[..., 1]
    is_tilted = (angle > _LEVEL) & (laws.follows > 0) & (tilt[..., SOFT] > 0) & (on_pad > 0) & (force > 0)
    is_over = is_tilted & (on_face > 0)

    def safe(values: Array) -> Array:
        return xp.where(is_tilted, values, one)

    reach, width = safe((parts * (begin - start)).sum(-1)), (parts * face).sum(-1)
    width, on_face = xp.where(is_over, width, one), xp.where(is_over, on_face, one)
    angle, load = safe(angle), safe(force)
    along = safe((parts * both).sum(-1))
    soft = safe(tilt[..., SOFT]) * angle * safe(on_pad) / along
    borne = soft * reach * reach / 2
    skinned_face = tilt[..., FIRM] > 0
    firm = xp.where(skinned_face, tilt[..., FIRM], one) * angle * on_face / width
    left, beside = (load - borne).clip(0.0, None), soft * reach
    reached = left > 0
    root = (beside * beside + 2 * firm * xp.where(reached, left, one)) ** 0.5
    long = xp.where(reached, (root - beside) / firm, 0.0 * one)
    long = xp.where(long > width, (left + firm * width * width / 2) / (firm * width + beside), long)
    within = xp.minimum(long, width)
    least = xp.where(tilt[..., GAP] > 0, tilt[..., GAP], one)
    gap = least + angle * (reach - (2 * load / soft) ** 0.5).clip(0.0, None)
    bare = (least / (angle * width) * xp.log1p(angle * width / gap)).clip(None, 1.0)
    part = xp.where(skinned_face, within / width, bare)
    on_skin = xp.minimum(firm * within * (long - within / 2), share)
    on_bare = xp.maximum(share * (1 - borne / load).clip(0.0, None), xp.minimum(share, _LEAST * part))
    pressed = xp.where(skinned_face, on_skin, on_bare)
    touched = ((2 * load / soft) ** 0.5 / along).clip(None, 1.0)
    return xp.where(is_over, part, one), xp.where(is_over, pressed, share), xp.where(is_tilted, touched, one)


def array_edge_patch(
    laws: ArrayLaws, pad: Array, rises: Array, part: Array, length: Array, shares: Array
) -> tuple[Array, Array]:
    """edge_patch as a pure function of arrays: (m, shares (..., 4)); length m and shares are flat_patch's, of what is
    not narrower than the level contact."""
    xp = namespace_of(part)
    narrow = (part < NARROW) & (part > 0)
    square = (rises * rises).sum(-1)
    share = rises * rises / xp.where(square > 0, square, 1.0 + square)[..., None]
    size, half = laws.size, laws.half_face[..., None]
    low, high = xp.maximum(-half, -pad - size / 2), xp.minimum(half, size / 2 - pad)
    sides = (high - low) * xp.where(narrow, part, 1.0 + 0.0 * part)[..., None] ** share
    middle = xp.where(rises > 0, low + sides / 2, high - sides / 2)
    ends = array_patch_ends(pad + middle, pad, sides, size, 2 * half + 0.0 * sides)
    found = xp.concatenate((array_patch_offset(middle, sides, 2 * half + 0.0 * sides), ends), -1)
    return xp.where(narrow, sides[..., 1], length), xp.where(narrow[..., None], found, shares)
