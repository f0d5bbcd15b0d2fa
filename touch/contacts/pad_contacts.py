"""Where pads are in the world, whether what presses is on them, and what they feel of it: conductance, the contact's
area and where it lies, by what they meet.

F: fingertips, N: what a pad may meet.
"""

from __future__ import annotations

import math

from thermograsp.compiled import njit

from ...thermal.contact import (
    CYLINDER,
    beside_face,
    beside_round,
    conductance,
    contact,
    curved_contact,
    curved_touch,
    flat_patch,
)
from ...thermal.padded import RINGS
from ..pointers import asked
from .columns import (
    AREA,
    ASIDE,
    BESIDE,
    CLOSED,
    CONDUCTANCE,
    CURVED,
    FORCE,
    LENGTH,
    NORMAL,
    PAUSED,
    PLACE,
    PULSES,
)
from .round_pads import SIDES, round_contact
from .sensors import FORCE_AT, PLACE_AT
from .tilt import RADIUS, tilted
from .views import between_sides, next_sides, viewed

DEPTH = 0.004  # m off the pad's plane, up to which a contact is on it, beside half of what both have sunk in
RIM = 0.0005  # m beyond the pad's sides
LOOKING = 0.6  # least cosine between the pad's normal and the contact's

AXES, HALF, WIDTH, AROUND, PAD = 3, 12, 14, 15, 15 + RINGS
"""Where a pad's axes, half sides m, its sensor's width m and half the outer sides m of its rings, 0 where it has no
heat, stand behind its position m in the frame of its body; and how many numbers these are."""
KNOWN, PLACED = 12, 13
"""Of a pad in the world: its middle m, normal, y and z, and behind them whether these are of this substep; and how many
numbers these are."""
SPOT = 3 + SIDES + 4 + RINGS
"""Numbers of a contact under way: a place, how the other lies, by how much it lies at ends, and areas of rings."""


@njit(cache=True, error_model="numpy", inline="always")
def begin(pushed, frames):
    """Forces, moments and frames of a substep start anew."""
    for f in range(len(frames)):
        frames[f, KNOWN] = 0.0
        for g in range(pushed.shape[1]):
            pushed[f, g, 0] = 0.0
            pushed[f, g, 1] = 0.0
            pushed[f, g, 2] = 0.0


@njit(cache=True, inner=True, borrows=True, error_model="numpy", forceinline=True)
def place_pad(pads, parts, xpos, xmat, frames, f):
    """Fills frames[f] with where pad f is in the world, unless it is known in this substep."""
    if frames[f, KNOWN] > 0.0:
        return
    frames[f, KNOWN] = 1.0
    body = parts[len(parts) - len(pads) + f, 2]
    for k in range(3):
        x, y, z = xmat[body, 3 * k], xmat[body, 3 * k + 1], xmat[body, 3 * k + 2]
        frames[f, k] = xpos[body, k] + (x * pads[f, 0] + y * pads[f, 1] + z * pads[f, 2])
        for i in range(3):
            at = AXES + i
            frames[f, 3 + 3 * i + k] = x * pads[f, at] + y * pads[f, at + 3] + z * pads[f, at + 6]


@njit(cache=True, error_model="numpy", inline="always")
def press(data, at, pads, bend, frames, f, part, part_count, pushed, beside):
    """A net force on a pad or beside it; of another fingertip only where it is on that one's pad too."""
    tips = len(pads)
    on, y, z, force = _bears(data, at, pads[f], bend[f], frames[f], 1.0)
    if part >= part_count - tips:
        other = part - (part_count - tips)
        on_other, _, _, back = _bears(data, at, pads[other], bend[other], frames[other], -1.0)
        on = on and on_other
        if not on and back > 0:
            beside[other] += back
    if force > 0:
        if on:
            pushed[f, part, 0] += force
            pushed[f, part, 1] += force * y
            pushed[f, part, 2] += force * z
        else:
            beside[f] += force


@njit(cache=True, error_model="numpy", inline="always")
def _bears(data, at, pad, bend, frame, sign):
    """Whether a net force is on a pad, where (m, along its y and z), and its part along the pad's normal there, N: that
    of a ball of the pad's curvatures."""
    place, vector = data[at + PLACE_AT : at + PLACE_AT + 3], data[at + FORCE_AT : at + FORCE_AT + 3]
    x, y, z, force = _from_pad(frame, place, vector, sign)
    leans_y, leans_z = bend[0] * y, bend[1] * z
    upright = math.sqrt(max(1.0 - leans_y * leans_y - leans_z * leans_z, 0.0))
    force *= upright
    for k in range(3):
        force += sign * vector[k] * (leans_y * frame[6 + k] + leans_z * frame[9 + k])
    return force > 0 and upright >= LOOKING and _within(pad, x, y, z, 0.0), y, z, force


@njit(cache=True, error_model="numpy", inline="always")
def lies(pad, frame, place, vector, sign, sunk):
    """Whether a contact is on a pad and looks at it, and where (m, along its y and z). sunk: m below both faces."""
    x, y, z, cosine = _from_pad(frame, place, vector, sign)
    return cosine >= LOOKING and _within(pad, x, y, z, sunk), y, z


@njit(cache=True, error_model="numpy", inline="always")
def _from_pad(frame, place, vector, sign):
    """Where a place is from a pad's middle, m along its normal, y and z, and the vector's part along the normal."""
    x, y, z, along = 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        away = place[k] - frame[k]
        along += sign * frame[3 + k] * vector[k]
        x += away * frame[3 + k]
        y += away * frame[6 + k]
        z += away * frame[9 + k]
    return x, y, z, along


@njit(cache=True, error_model="numpy", inline="always")
def _within(pad, x, y, z, sunk):
    return abs(x) <= DEPTH + sunk and abs(y) <= pad[HALF] + RIM and abs(z) <= pad[HALF + 1] + RIM


@njit(cache=True, inner=True, borrows=True, error_model="numpy", forceinline=True)
def feel(
    xpos, xmat, geom_xpos, geom_xmat, pads, frames, parts, laws, curved, tables, tilts, bend, curve, pushed, touches,
    weight, before, spot, views, radii, make,
):  # fmt: skip
    """Adds what presses on the pads to the touches, which counts as so many substeps (weight), with so many of the
    sample before. Returns whether every table that it needs could be made."""
    tips, part_count = len(pads), len(parts)
    place, sides = spot[:3], spot[3 : 3 + SIDES]
    shares, rings = spot[3 + SIDES : 7 + SIDES], spot[7 + SIDES :]
    for f in range(tips):
        if frames[f, KNOWN] == 0.0:
            continue  # nothing has met it
        middle, normal, side_y, side_z = frames[f, :3], frames[f, 3:6], frames[f, 6:9], frames[f, 9:12]
        last, last_around, noted = (
            -1,
            -1,
            0,
        )  # targets that were touched; an object's geoms follow one another
        for g in range(part_count):
            force = pushed[f, g, 0]
            if force <= 0:
                continue
            target, geom, body = parts[g, 0], parts[g, 1], parts[g, 2]
            axis = 0
            if geom >= 0:
                most = 0.0
                x, y, z = (
                    middle[0] - geom_xpos[geom, 0],
                    middle[1] - geom_xpos[geom, 1],
                    middle[2] - geom_xpos[geom, 2],
                )
                for i in range(3):
                    one, two, three = geom_xmat[geom, i], geom_xmat[geom, 3 + i], geom_xmat[geom, 6 + i]
                    place[i] = one * x + two * y + three * z
                    looking = abs(one * normal[0] + two * normal[1] + three * normal[2])
                    if looking > most:
                        most, axis = looking, i
            else:
                # another fingertip: how far the pads' middles are apart along this one's sides
                other = g - (part_count - tips)
                place[0], place[1], place[2] = 0.0, 0.0, 0.0
                for k in range(3):
                    away = middle[k] - xpos[body, k]
                    for j in range(3):
                        away -= xmat[body, 3 * k + j] * pads[other, j]
                    place[1] += away * side_y[k]
                    place[2] += away * side_z[k]
            law = laws[f, g, axis]
            bulging = bend[f, 0] + bend[f, 1] > 0
            if geom < 0:
                bulging = bulging or curve[g, 0, 0] + curve[g, 0, 1] > 0
            conducts, area, long = 0.0, 0.0, 0.0
            number, side, first, second, whole, lying = -1, axis, 0.0, 0.0, 1.0, force
            next_side, part = axis, 0.0  # of an ellipsoid: the side of the next larger radius, and its share
            for k in range(4):
                shares[k] = 0.0
            if not bulging and (parts[g, 3] > 0 or radii[g, 0] > 0):
                for i in range(3):
                    one, two, three = geom_xmat[geom, i], geom_xmat[geom, 3 + i], geom_xmat[geom, 6 + i]
                    sides[i] = one * normal[0] + two * normal[1] + three * normal[2]
            if not bulging and parts[g, 3] > 0:
                side, first, second = viewed(views[g], parts[g, 3], sides, place, law.half_face)
                number = curved[f, g, side, 0]
            elif not bulging and curved[f, g, axis, 0] >= 0:
                # A round body presses where MuJoCo says, which need not be on the sensor's face.
                if radii[g, 0] > 0:
                    side, next_side, part = next_sides(radii[g], sides[:3])
                number, first, second = (
                    curved[f, g, side, 0],
                    pushed[f, g, 1] / force,
                    pushed[f, g, 2] / force,
                )
                if law.shape == CYLINDER:
                    # MuJoCo may name any point of the line of contact: only what is across it is heard.
                    along_y, along_z = 0.0, 0.0
                    for k in range(3):
                        along_y += side_y[k] * geom_xmat[geom, 3 * k + 2]
                        along_z += side_z[k] * geom_xmat[geom, 3 * k + 2]
                    length = math.sqrt(along_y * along_y + along_z * along_z)
                    across = first * along_z - second * along_y
                    slope, away = 0.0, 0.0
                    for k in range(3):
                        slope += geom_xmat[geom, 3 * k + 2] * normal[k]
                        away += (middle[k] - geom_xpos[geom, k]) * normal[k]
                    first, second = 0.0, 0.0
                    if length > 0:
                        # along the pad, from the middle of the line that is nearest to it
                        first, second, slope = (
                            across / length,
                            (place[2] - slope * away) / length - tilts[f, g, axis, RADIUS] * slope,
                            slope / length,
                        )
                    whole, lying = tilted(tilts[f, g, axis], force, slope, second)
            elif bulging:
                _sides(geom_xmat, frames, f, geom, g - (part_count - tips), axis, sides)
                sides[6], sides[7] = 0.0, 0.0
                if geom < 0:
                    sides[6] = place[1] + pushed[f, g, 1] / force
                    sides[7] = place[2] + pushed[f, g, 2] / force
                if geom < 0 or parts[g, 3] > 0 or curve[g, axis, 0] + curve[g, axis, 1] > 0:
                    sides[4], sides[5] = 0.0, 0.0  # fingertips and meshes count as level
                if geom >= 0 and radii[g, 0] > 0:
                    _on_ellipsoid(
                        geom_xmat, frames, f, geom, radii[g], curve[g, axis], bend[f], pushed[f, g, 1] / force,
                        pushed[f, g, 2] / force, sides,
                    )  # fmt: skip
                area, share, kept, longer, even, wedge = round_contact(
                    bend[f], curve[g, axis], sides, force, pushed[f, g, 1] / force, pushed[f, g, 2] / force
                )
                if share > 0 and area > 0:
                    conducts = conductance(law, share / area) * area * kept
                    area *= kept * (1 - law.narrowing * (1 - even))
                    long = math.sqrt(area * longer)
                conducts, area, long = beside_round(law, wedge, conducts, area, long)
            else:
                if geom < 0:
                    _between_turned(frames, f, g - (part_count - tips), place)
                area, share = contact(law, force, place)
                if area > 0:
                    # of two fingertips both faces count as wide as what touches of them, whichever is named first
                    wide = pads[f, WIDTH] if geom >= 0 else 2 * law.half_face
                    long = flat_patch(law, area, place, wide, shares)
                    if share > 0:
                        conducts = conductance(law, share / area) * area
            for ring in range(1 + RINGS if pads[f, AROUND] > 0 else 1):
                for turn in range(2 if part > 0 else 1):
                    known = curved[f, g, next_side if turn else side, ring] if number >= 0 else -1
                    if known >= 0 and tables[known, 1] == 0.0 and asked(make, known) == 0:
                        return False
            if number >= 0 and whole > 0:
                conducts, area, long = curved_touch(tables[number], lying / whole, first, second, shares)
                if part > 0:
                    others = sides[3:7]  # which an ellipsoid under a flat pad leaves free
                    larger = curved_touch(tables[curved[f, g, next_side, 0]], lying, first, second, others)
                    conducts, area, long = between_sides(part, (conducts, area, long), larger, shares, others)
                conducts, area, long = whole * conducts, whole * area, whole * long
            touch = touches[f, target]
            if conducts > 0:
                touch[CONDUCTANCE] += weight * conducts
                touch[AREA] += weight * area
                touch[LENGTH] += weight * area * long
                for k in range(4):
                    touch[ASIDE + k] += weight * area * shares[k]
                if target != last:
                    paused = before - touch[CLOSED]
                    if paused > touch[PAUSED]:
                        touch[PAUSED] = paused
                        touch[PULSES] += 1.0
                    elif before == 0.0:
                        touch[PULSES] = 0.5
                    touch[CLOSED] += weight
                    last = target
            if pads[f, AROUND] > 0 and geom >= 0:
                if target != last_around:
                    last_around, noted = target, 0
                through = 0.0
                if number < 0:
                    through = beside_face(laws[f, g, 3 + axis], pads[f, AROUND:], force, place, rings)
                if number >= 0 and noted & 1 << RINGS == 0:
                    touch[CURVED] += weight
                    noted |= 1 << RINGS
                for ring in range(RINGS):
                    conducts, area = through * rings[ring], rings[ring]
                    if number >= 0 and whole > 0:
                        table = tables[curved[f, g, side, 1 + ring]]
                        conducts, area, _ = curved_contact(table, lying / whole, first, second)
                        if part > 0:
                            table = tables[curved[f, g, next_side, 1 + ring]]
                            more, wide, _ = curved_contact(table, lying, first, second)
                            conducts, area = (
                                (1 - part) * conducts + part * more,
                                (1 - part) * area + part * wide,
                            )
                        conducts, area = whole * conducts, whole * area
                    if conducts > 0:
                        at = BESIDE + 3 * ring
                        touch[at] += weight * conducts
                        touch[at + 1] += weight * area
                        if noted & 1 << ring == 0:
                            touch[at + 2] += weight
                            noted |= 1 << ring
            touch[FORCE] += weight * force
            x, y, z = middle[0] - xpos[body, 0], middle[1] - xpos[body, 1], middle[2] - xpos[body, 2]
            for i in range(3):
                one, two, three = xmat[body, i], xmat[body, 3 + i], xmat[body, 6 + i]
                touch[PLACE + i] = one * x + two * y + three * z
                touch[NORMAL + i] = one * normal[0] + two * normal[1] + three * normal[2]
    return True


@njit(cache=True, error_model="numpy", inline="always")
def _between_turned(frames, f, other, place):
    """Turns place, m along pad f's sides, to what lies between these and the sides of the other pad that are nearest to
    them: so it is the same as seen from either."""
    along, aside = 0.0, 0.0
    for k in range(3):
        along += frames[other, 6 + k] * frames[f, 6 + k]
        aside += frames[other, 6 + k] * frames[f, 9 + k]
    turn = math.atan2(aside, along)
    turn = (turn - math.pi / 2 * math.floor(turn / (math.pi / 2) + 0.5)) / 2
    y, z = place[1], place[2]
    place[1], place[2] = y * math.cos(turn) + z * math.sin(turn), z * math.cos(turn) - y * math.sin(turn)


@njit(cache=True, error_model="numpy", inline="always")
def _sides(geom_xmat, frames, f, geom, other, axis, sides):
    """Fills sides (SIDES,) but for the last two with where the two axes of what a pad meets that lie across point,
    along the pad's y and z, and the rise of the plane across the third: of a geom, or of the other fingertip's pad."""
    n = 0
    across = axis if geom >= 0 else 0
    for i in range(3):
        x, y, z = 0.0, 0.0, 0.0
        for k in range(3):
            points = geom_xmat[geom, 3 * k + i] if geom >= 0 else frames[other, 3 + 3 * i + k]
            x += points * frames[f, 3 + k]
            y += points * frames[f, 6 + k]
            z += points * frames[f, 9 + k]
        if i == across:
            sides[4], sides[5] = y / x, z / x
        else:
            sides[2 * n], sides[2 * n + 1] = y, z
            n += 1


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _on_ellipsoid(geom_xmat, frames, f, geom, radii, curve, bend, y, z, sides):
    """Fills sides[:4] so that with the curvatures of `curve` they are as curved as the ellipsoid where it looks against
    a round pad y and z m from its middle. There the radii of curvature are (A - A n n'A/h^2)/h, with A of the half
    axes' squares, n the normal and h^2 = n'A n: the second derivative of the support function h (Schneider, Convex
    Bodies, section 2.5)."""
    lean_y, lean_z = bend[0] * y, bend[1] * z
    upright = math.sqrt(max(1.0 - lean_y * lean_y - lean_z * lean_z, 0.0))
    square, on_y, on_z, yy, yz, zz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(3):
        along, first, second = 0.0, 0.0, 0.0
        for k in range(3):
            points = geom_xmat[geom, 3 * k + i]
            along += points * frames[f, 3 + k]
            first += points * frames[f, 6 + k]
            second += points * frames[f, 9 + k]
        normal = upright * along + lean_y * first + lean_z * second
        turned = (along + normal) / (1 + upright)  # the pad's sides turn with its normal, the shortest way
        first, second = first - lean_y * turned, second - lean_z * turned
        half = radii[0] * radii[1] * radii[2] / radii[i]  # the half axis's square
        square += half * normal * normal
        on_y, on_z = on_y + half * normal * first, on_z + half * normal * second
        yy, yz, zz = yy + half * first * first, yz + half * first * second, zz + half * second * second
    yy, yz, zz = yy - on_y * on_y / square, yz - on_y * on_z / square, zz - on_z * on_z / square
    high = math.sqrt(square)
    sides[0], sides[2] = math.sqrt(high * zz / (yy * zz - yz * yz) / curve[0]), 0.0
    sides[1], sides[3] = -sides[0] * yz / zz, math.sqrt(high / zz / curve[1])
