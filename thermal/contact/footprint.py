"""What of a sensor's face an object touches, with what force, and what that conducts: compiled functions of a law.

`footprint` evaluates a FOOTPRINT_LAW (law.py) at a force and a place, `solid_conduction` what the area conducts under
its force, and `conduction` both with the gas beside the contact (gas_beside.py). `contact` and `flat_patch` are of flat
objects, whose CONTACT_LAW is enough. Rows never mix.

A bare face of alumina does not sink in. Under a curved body it is a stiff spring, which takes nearly all of the force
where the body's crown is over it, and what the pad beside it leaves where the crown is not. With its force the contact
on it is Hertz's (rigid.py), a disc or a strip that is cut off at a face that is smaller; of a cylinder whose end is
over the face, the part on it takes its share of the length. What a disc conducts more than the gas between faces
without force would is in series with its constriction in both bodies, (1/k + 1/k')(1/a - 1/w)/4, w the radius of a disc
of the face's area: the rest of its heat is no more concentrated than that of the gas around it. Beside it the gap is
Hertz's.
"""

from __future__ import annotations

import math

import numpy as np

from thermograsp.compiled import njit

from ..numerics import (
    FARTHEST,
    FAST,
    HIGH,
    LOW,
    NEAREST,
    SERIES,
    Array,
    namespace_of,
)
from .fingertip import Beneath
from .gas_beside import beside_ball, beside_strip
from .law import CYLINDER, FLAT, SPHERE, TABLE
from .patch_place import NARROW, patch_ends, patch_offset
from .round_bodies import ball_on_pad, cylinder_on_pad, disc_on_face

_FIRST, _STEP = math.log(0.01), math.log(3.0)
_EDGE = 0.7  # how much wider a spot is beneath a skin, over its thickness: a fit, see spread.py
_SPOT = 2.0  # see _spot_share
# Mean planes' distance over roughness, sqrt(2) erfc^-1(x), in powers of where sqrt(-log x) is between LOW and HIGH; the
# series' first terms, good to 1e-11.
LOG_LEAST, LOG_MOST = math.log(FARTHEST), math.log(NEAREST)
SEPARATION = math.sqrt(2) * np.polynomial.chebyshev.cheb2poly(SERIES[:13])


@njit(cache=True, error_model="numpy")
def footprint(law, force, place):
    """(area m2 on the face, its force N) at a normal force N > 0 on the pad.

    place: (3,) m, the pad's middle from the object's in the object's frame; of curved bodies what of it lies along the
    pad. Tables leave it aside."""
    area, load, _, _ = touched(law, force, place)
    return area, load


@njit(cache=True, error_model="numpy")
def conduction(law, force, place):
    """(area m2 on the face, W/K that it conducts, gas beside it with it) at a normal force N > 0 on the pad; see
    footprint. Gas conducts where nothing on the face touches, too."""
    area, load, square, hertz = touched(law, force, place)
    gas, spread = reached(law, law.straight + law.sheet, area, square, hertz, place)
    return area, solid_conduction(law, area, load, place, gas, spread) + gas


@njit(cache=True, error_model="numpy")
def gas_around(law, force, place):
    """(W/K of the gas beside the contact, m2 beside it over which that gas's heat spreads between bodies that give way,
    see spread.py); see conduction."""
    if law.mean_gap == 0.0:
        return 0.0, 0.0
    area, _, square, hertz = touched(law, force, place)
    return reached(law, law.straight + law.sheet, area, square, hertz, place)


@njit(cache=True, inner=True, error_model="numpy")
def reached(law, resistance, area, square, hertz, place):
    """gas_around of what `touched` tells, above what resists by so many m2 K/W; 0 leaves the spread aside."""
    around = beside(law, law.mean_gap, area, square, hertz, place)
    if around <= 0.0 or resistance <= 0.0:
        return around, 0.0
    less = beside(law, law.mean_gap + law.gas * resistance, area, square, hertz, place)
    rest = max(4 * law.half_face * law.half_face - area, 0.0)
    return around, min(around * less * resistance / (around - less), rest) if around > less else rest


@njit(cache=True, inner=True, error_model="numpy")
def beside(law, mean_gap, area, square, hertz, place):
    """W/K of the gas beside a curved contact of that area m2, whose half width has that square m2, where faces that
    touch without force are so far apart, m; 0 beside others. The rest: of touched."""
    if mean_gap <= 0.0:
        return 0.0
    off, half = math.sqrt(place[0] * place[0] + place[1] * place[1]), law.half_face
    if law.shape == SPHERE:
        gas = law.gas * beside_ball(square, hertz, mean_gap, law.radius, half, off, place[2])
        if hertz > 0.0 and area > 0.0:
            under, _ = disc_on_face(square, half, off, place[2])
            gas *= _share_beside(4 * half * half, area, under * math.pi * square)
        return gas
    if law.shape == CYLINDER:
        along = _common(half, law.length / 2, place[2])
        gas = law.gas * along * beside_strip(square, mean_gap, law.radius, half, off)
        if hertz > 0.0 and area > 0.0:
            gas *= _share_beside(2 * half * along, area, _common(half, math.sqrt(square), off) * along)
        return gas
    return 0.0


@njit(cache=True, inner=True, error_model="numpy", forceinline=True)
def _share_beside(whole, touched, under):
    """How much of the face is beside what touches, over what is not under the curve: Hertz's contact stays on the face
    where its middle would be near the edge or beyond it."""
    return max(whole - touched, 0.0) / (whole - under) if under < whole else 0.0


@njit(cache=True, inner=True, error_model="numpy")
def touched(law, force, place):
    """(area m2 on the face, its force N, of a curved contact the squares m2 of its half width and Hertz's)."""
    if law.shape == FLAT:
        area, share = _flat(law, place)
        return area, force * share, 0.0, 0.0
    if law.shape == TABLE:
        area, load = _from_table(law, force)
        return area, load, 0.0, 0.0
    off = math.sqrt(place[0] * place[0] + place[1] * place[1])
    load = force / law.stiffness
    if law.shape == CYLINDER:
        on_pad = _common(law.half_pad, law.length / 2, place[2])
        along = _common(law.half_face, law.length / 2, place[2])
        _, area, part, square = cylinder_on_pad(
            load, law.ratio, law.half_pad, law.half_face, on_pad, along, off
        )
        load, hertz = law.stiffness * part, 0.0
        if law.modulus > 0.0 and along > 0.0:
            load *= min(along / min(law.length, 2 * law.half_face), 1.0)
            hertz = 4 * load * law.radius / (math.pi * law.modulus * along)
            width, held = math.sqrt(hertz), 1.0
            if width > law.half_face:
                share = law.half_face / width
                width, held = law.half_face, (3 - share * share) * share / 2
            area, load = 2 * width * along, load * held
            square = max(min(max(off - law.half_face, 0.0) ** 2, square), hertz)
        return area, load, square, hertz
    _, area, part, square = ball_on_pad(load, law.ratio, law.half_pad, law.half_face, off, place[2])
    load, hertz = law.stiffness * part, 0.0
    if law.modulus > 0.0:
        if load > 0.0:
            hertz = (0.75 * load * law.radius / law.modulus) ** (2 / 3)
            part, held = disc_on_face(hertz, law.half_face, 0.0, 0.0)
            area, load = math.pi * hertz * part, load * held
            away, aside = max(off - law.half_face, 0.0), max(abs(place[2]) - law.half_face, 0.0)
            square = max(min(away * away + aside * aside, square), hertz)
    return area, load, square, hertz


@njit(cache=True, inner=True, error_model="numpy", forceinline=True)
def _flat(law, place):
    """(area m2 on the face, its share of the force) of a flat object. place: see footprint."""
    if law.size[0] == 0.0:
        return law.area, law.share
    on_pad, on_face = _overlap(law, place)
    bearing = on_pad + (law.ratio - 1.0) * on_face
    return on_face, law.ratio * on_face / bearing if bearing > 0.0 else 0.0


@njit(cache=True, inner=True, error_model="numpy", forceinline=True)
def _overlap(law, place):
    """(m2 on the pad, m2 on the face) under a flat object."""
    on_pad, on_face = 1.0, 1.0
    for side in range(2):
        offset, half = place[law.across[side]], law.size[side] / 2
        on_pad *= _common(law.half_pad, half, offset)
        on_face *= _common(law.half_face, half, offset)
    return on_pad, on_face


@njit(cache=True, inner=True, error_model="numpy", forceinline=True)
def _common(half, other, offset):
    """m, that two intervals of these half widths have in common, their middles that far apart."""
    off = abs(offset)
    return max(min(half, other - off) + min(half, other + off), 0.0)


@njit(cache=True, inner=True, error_model="numpy", forceinline=True)
def _from_table(law, force):
    k, part = _between_forces(law.areas, force)
    share = law.shares[k] + max(part, 0.0) * (law.shares[k + 1] - law.shares[k])
    return _at_force(law.areas, force), share * force


@njit(cache=True, inner=True, error_model="numpy")
def _between_forces(values, force):
    """(number of the force of a table before, share of the way to the next)."""
    at = (math.log(force) - _FIRST) / _STEP
    k = min(max(int(math.floor(at)), 0), len(values) - 2)
    return k, min(at - k, 1.0)


@njit(cache=True, inner=True, error_model="numpy")
def _at_force(values, force):
    """Between two forces what a table tells is a power of the force, and below the first as between the first two."""
    k, part = _between_forces(values, force)
    low, high = values[k], values[k + 1]
    if low > 0.0:
        return low * (high / low) ** part
    return high * max(part, 0.0)


@njit(cache=True, error_model="numpy", fastmath=FAST, forceinline=True)
def contact(law, force, place):
    """(area m2 on the face, its force N) of a flat object at a normal force N > 0 on the pad; not numbers of others,
    which footprints and tables know. place: (3,) m, the pad's middle from the object's in the object's frame, which
    laws of a fixed place leave aside."""
    if law.shape != FLAT:
        return math.nan, math.nan
    area, share = _flat(law, place)
    return area, force * share


@njit(cache=True, borrows=True, error_model="numpy")
def flat_patch(law, area, place, width, shares):
    """m, the second side of a flat contact of that area m2 on the face; fills shares (4,) by which it lies at an end of
    the sensor's face of that width m along both sides, of which the law's is what the pad bears, and at an end of the
    object (patch_place.py). place: as contact's."""
    for side in range(4):
        shares[side] = 0.0
    if law.size[0] == 0 or area >= width * width * NARROW:
        return math.sqrt(area)
    length = 0.0
    for side in range(2):
        pad, size = place[law.across[side]], law.size[side]
        low, high = max(-law.half_face, -pad - size / 2), min(law.half_face, size / 2 - pad)
        length = high - low
        shares[side] = patch_offset((low + high) / 2, length, width)
        shares[2 + side] = patch_ends(pad + (low + high) / 2, pad, length, size, width)
    return length


@njit(cache=True, error_model="numpy", fastmath=FAST, forceinline=True)
def conductance(law, pressure):
    """W/(m2 K) at a pressure Pa > 0, solid spots and gas together."""
    log_pressure = math.log(pressure)
    solid = math.exp(min(law.spot_scale + law.spot_power * log_pressure, law.spot_most))
    share, separation = law.elastic_share, 0.0
    if share < 1.0:
        separation += (1 - share) * _separation(log_pressure + math.log(2.0) - law.log_hardness)
    if share > 0.0:
        separation += share * _separation(log_pressure + math.log(4.0) - law.log_elastic_hardness)
    gap = law.roughness * separation + law.jump
    if law.flatness > 0.0:
        return solid + law.gas / law.flatness * math.log1p(law.flatness / gap)
    return solid + law.gas / gap


@njit(cache=True, borrows=True, error_model="numpy")
def beside_face(law, halves, force, place, areas):
    """W/(m2 K) where a flat object touches a pad beside the sensor's face, at a normal force N > 0 on the pad, whose
    own pressure is less there than on the face under a skin. law: pad_law's, of the pad's own surface. Fills areas (R,)
    m2 of what it touches of rings around the face, of which halves (R,) m are half the outer sides. place: as
    contact's."""
    on_pad, within = _overlap(law, place)
    bearing, touched = on_pad + (law.ratio - 1.0) * within, False
    for ring in range(len(halves)):
        whole = 1.0
        for side in range(2):
            whole *= _common(halves[ring], law.size[side] / 2, place[law.across[side]])
        areas[ring] = max(whole - within, 0.0)
        touched = touched or areas[ring] > 0.0
        within = whole
    return conductance(law, force / bearing) if touched and bearing > 0.0 else 0.0


@njit(cache=True, error_model="numpy")
def solid_conduction(law, area, load, place, around, spread):
    """W/K of an area m2 of the face under a force N on it; law: a FOOTPRINT_LAW; place: see footprint; around, spread:
    of gas_around.

    Conductance is that of the mean pressure. Under a curved body pressure varies, and the sum over places is within
    2.5 % of this, as the spots conduct nearly in proportion to pressure and the gas nearly without it."""
    if area <= 0.0:
        return 0.0
    if law.conducts[len(law.conducts) - 1] > 0.0:
        return _at_force(law.conducts, load)
    conducts = conductance(law, load / area) * area
    if law.series > 0.0:
        long = _common(law.half_face, law.length / 2, place[2]) if law.shape == CYLINDER else math.sqrt(area)
        return through_soft(conducts, around, area, long, 2 * law.half_face, area + spread, law)
    return constricted(law, area, conducts, law.constriction)


@njit(cache=True, error_model="numpy")
def constricted(law, area, conducts, constriction):
    """W/K of an area m2 that conducts so much, and constricts heat in both bodies: (1/k + 1/k')/4 of a disc, 0 of
    none, m K/W."""
    if constriction > 0.0:
        more = math.sqrt(math.pi / area) - 0.5 * math.sqrt(math.pi) / law.half_face
        if more > 0.0:
            gas = law.gas / law.mean_gap * area if law.mean_gap > 0.0 else 0.0  # between faces without force
            conducts = gas + (conducts - gas) / (1.0 + (conducts - gas) * constriction * more)
    return conducts


@njit(cache=True, inner=True, error_model="numpy", forceinline=True)
def _spot_share(length, face):
    """How much a contact of that length m is a spot on the sensor's face of that width m: from 0 where it is as long,
    to 1 where it is no longer than half of that."""
    return max(min(_SPOT * (1.0 - length / face), 1.0), 0.0)


@njit(cache=True, error_model="numpy")
def through_soft(conducts, around, area, length, face, whole, below):
    """W/K of a contact of that area m2 and length m between bodies that give way. What it conducts more than as much of
    what is around it is in series with what its heat meets more than it would over `whole` m2: spread.py says what.

    conducts: W/K by itself; around: W/K of the gas over the rest of the whole. face: m, the sensor's width. below: of
    beneath."""
    if not 0.0 < area < whole:
        return conducts
    spot, radius, wide = _spot_share(length, face), math.sqrt(area / math.pi), math.sqrt(whole / math.pi)
    spreads, rim, outer = below.series / 4 * (1.0 / radius - 1.0 / wide), math.pi * radius, math.pi * wide
    if spot < 1.0:
        long = min(length, face)
        strip = -below.series / (math.pi * long) * math.log(math.sin(math.pi / 2 * area / whole))
        spreads, rim, outer = (
            strip + spot * (spreads - strip),
            long + spot * (rim - long),
            long + spot * (outer - long),
        )
    straight, edge = below.deep * (1.0 / area - 1.0 / whole), _EDGE * below.thick
    more = below.sheet * (1.0 / (area + edge * rim) - 1.0 / (whole + edge * outer))
    if spreads > 0.0:
        more += spreads * straight / math.sqrt(spreads * spreads + straight * straight)
    same = min(around * area / (whole - area), conducts)
    return same + (conducts - same) / (1.0 + (conducts - same) * more)


def array_through_soft(
    conducts: Array, around: Array, area: Array, length: Array, face: Array, whole: Array, below: Beneath
) -> Array:
    """through_soft of arrays of one shape, of areas and lengths above 0 and areas below the whole."""
    xp = namespace_of(conducts)
    spot = (_SPOT * (1.0 - length / face)).clip(0.0, 1.0)
    radius, wide, long = (area / math.pi) ** 0.5, (whole / math.pi) ** 0.5, xp.minimum(length, face)
    strip = -below.series / (math.pi * long) * xp.log(xp.sin(math.pi / 2 * area / whole))
    spreads = strip + spot * (below.series / 4 * (1.0 / radius - 1.0 / wide) - strip)
    rim, outer = long + spot * (math.pi * radius - long), long + spot * (math.pi * wide - long)
    straight, edge = below.deep * (1.0 / area - 1.0 / whole), _EDGE * below.thick
    more = below.sheet * (1.0 / (area + edge * rim) - 1.0 / (whole + edge * outer))
    some = spreads > 0
    spreads = xp.where(some, spreads, straight)
    more = more + some * spreads * straight / (spreads * spreads + straight * straight) ** 0.5
    same = xp.minimum(around * area / (whole - area), conducts)
    return same + (conducts - same) / (1.0 + (conducts - same) * more)


@njit(cache=True, inner=True, error_model="numpy", fastmath=FAST, forceinline=True)
def _separation(log_share):
    y = math.sqrt(-min(max(log_share, LOG_LEAST), LOG_MOST))
    z = (2 * y - LOW - HIGH) / (HIGH - LOW)
    total = 0.0
    for i in range(len(SEPARATION) - 1, -1, -1):
        total = total * z + SEPARATION[i]
    return total
