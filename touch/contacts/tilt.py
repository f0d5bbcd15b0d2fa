"""Rods that lie at an angle to a flat pad: only one end of them touches.

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


@njit(cache=True, borrows=True, error_model="numpy")
def tilted(tilt, force, slope, middle):
    """(share of the line, force N on it) of a rod under a force N > 0. slope: tangent of the angle between the rod and
    the pad, above 0 where its axis leads away from it; middle: m, the pad's middle along the pad from that of the line
    that is nearest to it."""
    angle = abs(slope) - tilt[TURN] * force
    if not (angle > _LEVEL and tilt[RADIUS] > 0):
        return 1.0, force
    cosine = 1 / math.sqrt(1 + slope * slope)
    along, half = middle if slope > 0 else -middle, tilt[HALF] * cosine
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
    if width == 0.0:
        share = 0.0
    return share, max(pressed, min(force, _LEAST * share))


def array_tilted(tilt: Array, force: Array, slope: Array, middle: Array) -> tuple[Array, Array]:
    """tilted as a pure function of arrays: NumPy, PyTorch, JAX. tilt: (..., TILT); the others of one shape. Forces that
    are not above 0 count as none."""
    xp = namespace_of(force)
    one = 1.0 + 0.0 * force
    angle = abs(slope) - tilt[..., TURN] * force
    cosine = 1 / (1 + slope * slope) ** 0.5
    along = xp.where(slope > 0, middle, -middle)
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
    share = xp.where(width > 0, share, 0.0 * one)
    pressed = xp.where(skinned_face, on_skin, pressed)
    rest = xp.minimum(load, _LEAST * share)
    return xp.where(is_tilted, share, one), xp.where(is_tilted, xp.maximum(pressed, rest), force)
