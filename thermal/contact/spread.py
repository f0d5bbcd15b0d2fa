"""How large a patch of even conductance stands for a curved body on a sensor's face.

Beside the contact gas conducts k/(d + r^2/(2 R)): as well as between lapped faces in the middle, and out at the face's
edge a hundredth of it. A network has one patch of one conductance. With g the conductance of the gas over the whole
face, W/K, and g' that of the same gas with 1/b = l (1/k + 1/k') of both bodies in series at each place, a patch of area

    A = g g'/(b (g - g'))

and evenly g/A loses as much to the bodies' resistance as the gas does: little where b is large, so that the patch is
wide under wood and narrow under copper. The contact itself is as large as it is, and the patch is the mean of both
areas, weighted by what they conduct, or what two flows side by side tell, if that is wider. l is how deep heat has come
into the body in a second, but 0.8 mm at most, since it spreads sideways by then: a fit to finite volumes of the contact
place by place (studies/contact/curved_patch.py), balls of 5, 20 and 50 mm of five materials. A skin's resistance is in
b, too.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

from ..matter import Material, Skin
from ..numerics import Array, namespace_of
from .array_law import ArrayLaws
from .footprint import beside, solid_conduction, touched
from .gas_beside import Wedge, array_wedge_gas, wedge_gas
from .law import CYLINDER
from .rough_faces import LAPPED_ALUMINA, Surface

_DEEPEST, _SECONDS = 0.8e-3, 1.0  # m, s, see above
_MOST_NARROWED, _EVENED = 0.56, 1 / 3  # see narrowing
_NEWTON_STEPS = 8
SPOT_ON_SKIN = 2.0
"""A contact under a skin is a line where it is as long as the face, and a spot up to half of that."""
_FEW = 1e-6  # of what both conduct: less is no contact
_MIDDLE = np.zeros(3)


class Beneath(NamedTuple):
    """What heat meets on both sides of a contact. straight: m2 K/W of both bodies, as deep as it comes. series: m K/W,
    the reciprocal of their conductivities in series, between which it spreads. sheet: m2 K/W of a skin, which is
    too thin for heat to spread in it."""

    straight: float
    series: float
    sheet: float


def even_patch(law: np.void, body: Material, force: float, skin: Skin | None = None) -> float:
    """m2, of a round_footprint of the body at a force N > 0 on the pad, over the face's middle."""
    return float(patches(law, beneath(body, skin), force, _MIDDLE)[4])


def narrowing(body: Surface, face: Surface = LAPPED_ALUMINA) -> float:
    """By what share of 1 - e a patch is narrower than the bare contact that it stands for, which conducts as it
    presses. e: its mean pressure's square over the mean of its square, .75 of a ball's on springs, 1 of an even one.

    Heat crowds in the sensor's face where the contact presses most. In a body that conducts less than the face it
    crowds to the contact's edge instead, which evens the flow. A fit to finite elements of balls of 5, 8 and 15 mm at 1
    to 20 N on copper, aluminium, steel, glass and wood (studies/elements/narrow_faces.py): a seventh on metals."""
    return _MOST_NARROWED / (1 + _EVENED * face.conductivity / body.conductivity)


def beneath(body: Material, skin: Skin | None = None) -> Beneath:
    """Of a body under a sensor's face, which wears that skin or is bare."""
    depth = min(float(np.sqrt(body.diffusivity * _SECONDS)), _DEEPEST)
    series = 1 / LAPPED_ALUMINA.conductivity + 1 / body.conductivity
    return Beneath(depth * series, series, 0.0 if skin is None else skin.resistance)


@njit(cache=True, error_model="numpy")
def patches(law, below, force, place):
    """(W/K of the contact, W/K of the gas, m2 of their two patches, m2 of the one that stands for both) at a force
    N > 0 on the pad. below: of beneath."""
    contact, gas, area, wide, whole, around = both_contacts(law, below, force, place)
    total = contact + gas
    if total <= 0.0:
        return contact, gas, area, wide, area
    even = (contact * area + gas * wide) / total
    if contact < _FEW * total or around <= 0.0 or law.constriction > 0.0:
        return contact, gas, area, wide, even
    if law.shape == CYLINDER:
        half, other = law.half_face, law.length / 2
        along = max(min(half, other - place[2]) - max(-half, -other - place[2]), 0.0)
        least = flows_of_line(contact, gas, area, whole, below, along)
    else:
        least = flows_of_spot(total - around, around, area, whole, below)
    if least <= even:
        return contact, gas, area, wide, even
    area, wide = widened(contact, gas, area, whole, least)
    return contact, gas, area, wide, least


@njit(cache=True, error_model="numpy")
def widened(contact, gas, area, whole, patch):
    """m2 of the contact's patch, of area m2 at least, and of the gas's, `whole` at most, whose mean by what they
    conduct is `patch`."""
    wide = (patch * (contact + gas) - contact * area) / gas
    if wide > whole:
        return (patch * (contact + gas) - gas * whole) / contact, whole
    return area, wide


@njit(cache=True, error_model="numpy")
def flows_of_line(contact, gas, area, whole, below, along):
    """m2 of a patch that resists as much as two flows side by side do: an even one through the gas over `whole` m2, and
    one over the contact's m2. along: m, the contact's length. The rest as in patches.

    A flow that may choose between more ways meets no more resistance (Thomson's principle). Where the contact conducts
    more than the bodies beneath it, or than a skin, the mean of the areas is narrower than this: it let a can of
    plastic take up half as much heat when it was pressed harder (studies/contact/curved_patch.py --cylinders)."""
    if area <= 0.0 or area >= whole:
        return whole
    both = (below.straight + below.sheet) / whole
    narrow, wide = 1.0 / contact + both + _drawn_together(area, whole, below, along), 1.0 / gas + both
    resists = _beside_one_another(narrow, wide, both) - 1.0 / (contact + gas) - both
    return _resisting(resists, area, whole, below, along)


@njit(cache=True, error_model="numpy")
def flows_of_spot(contact, gas, area, whole, below):
    """The same where the contact is a disc and the gas conducts around it alone, both in W/K. In a skin the two flows
    have nothing in common."""
    if area <= 0.0 or area >= whole:
        return whole
    common = below.straight / whole
    sheet, both = below.sheet / whole, (below.straight + below.sheet) / (whole - area)
    narrow = 1.0 / contact + common + sheet + _drawn_together(area, whole, below, 0.0)
    resists = _beside_one_another(narrow, 1.0 / gas + both, common) - 1.0 / (contact + gas) - common - sheet
    return _resisting(resists, area, whole, below, 0.0)


@njit(cache=True, error_model="numpy")
def _beside_one_another(one, other, common):
    """K/W of two flows, of which a part is common to both."""
    return (one * other - common * common) / (one + other - 2 * common)


@njit(cache=True, error_model="numpy")
def _resisting(resists, area, whole, below, along):
    """m2, at least the area's, whose flow resists by that many K/W more than one over the whole: the lesser of straight
    flow and of what spreads from a strip in a channel, or from a disc; and what a skin resists. along: m, of a strip, 0
    of a disc."""
    if resists <= 0.0:
        return whole
    sheet = below.sheet
    straight = 1.0 / (1.0 / whole + resists / (below.straight + sheet))
    if along > 0.0:
        spreads = _from_strip(resists, area, whole, below, along)
    else:
        root = below.series * math.sqrt(math.pi) / 8  # half of what a disc's resistance takes over sqrt(area)
        more = resists + sheet / whole + 2 * root / math.sqrt(whole)
        spreads = ((root + math.sqrt(root * root + sheet * more)) / more) ** 2
    return max(min(straight, spreads), area)


@njit(cache=True, inner=True, error_model="numpy")
def _from_strip(resists, area, whole, below, along):
    """m2 of a strip in a channel, by Newton's method on its logarithm, over which its resistance is convex: from less,
    each step is towards it and not beyond."""
    strength, sheet = below.series / (math.pi * along), below.sheet
    found = area
    if sheet > 0.0:
        found = max(found, 1.0 / (1.0 / whole + resists / sheet))
    for _ in range(_NEWTON_STEPS):
        at = math.pi / 2 * found / whole
        more = -strength * math.log(math.sin(at)) + sheet * (1.0 / found - 1.0 / whole) - resists
        if more <= 0.0:
            break
        found *= math.exp(more / (strength * at / math.tan(at) + sheet / found))
    return found


@njit(cache=True, error_model="numpy")
def _drawn_together(area, whole, below, along):
    """K/W by which a flow over so many m2 meets more resistance than one over the whole: the lesser of straight flow's
    and of what spreads from a strip in a channel, or from a disc; and what a skin resists."""
    narrower = 1.0 / area - 1.0 / whole
    if along > 0.0:
        spread = -below.series / (math.pi * along) * math.log(math.sin(math.pi / 2 * area / whole))
    else:
        spread = below.series / 4 * (math.sqrt(math.pi / area) - math.sqrt(math.pi / whole))
    return min(spread, below.straight * narrower) + below.sheet * narrower


@njit(cache=True, error_model="numpy")
def both_contacts(law, below, force, place):
    """(W/K of the contact, W/K of the gas, m2 of their two patches, m2 of all the gas, W/K of the gas beside what
    touches) at a force N > 0 on the pad; see footprint's conduction. The gas is as it would be without force under the
    contact too, where it is spread as wide as beside it if heat is constricted, and is so among all the gas."""
    area, load, square, hertz = touched(law, force, place)
    around = beside(law, law.mean_gap, area, square, hertz, place)
    total, spread = solid_conduction(law, area, load) + around, 0.0
    if law.mean_gap <= 0.0:
        return total, 0.0, area, area, area, 0.0
    if around > 0.0:
        resistance = below.straight + below.sheet
        less = beside(law, law.mean_gap + law.gas * resistance, area, square, hertz, place)
        spread = max(4 * law.half_face * law.half_face - area, 0.0)
        if around > less:
            spread = min(around * less * resistance / (around - less), spread)
    gas, whole = min(around + law.gas / law.mean_gap * area, total), area + spread
    if law.constriction == 0.0 and gas > 0.0:
        spread *= around / gas
    return total - gas, gas, area, area + spread, whole, around


@njit(cache=True, error_model="numpy")
def beside_round(law, wedge, conducts, area, length):
    """(W/K, m2, m) of what touches between round bodies together with the gas beside it, as `patches` has them of one
    body: what they conduct, the patch that stands for both, and its longer side.

    law: a CONTACT_LAW with what is beside it. wedge: of the two. conducts, area, length: W/K, m2 and m of what touches
    of the face, 0 each where nothing does."""
    if law.mean_gap <= 0.0:
        return conducts, area, length
    around = law.gas * wedge_gas(wedge, law.mean_gap)
    if around <= 0.0:
        return conducts, area, length
    below = Beneath(law.straight, law.series, law.sheet)
    resistance, face = below.straight + below.sheet, 2 * law.half_face
    less = law.gas * wedge_gas(wedge, law.mean_gap + law.gas * resistance)
    rest = max((wedge.right - wedge.left) * (wedge.upper - wedge.lower) - area, 0.0)
    spread = min(around * less * resistance / (around - less), rest) if around > less else rest
    total, longer = conducts + around, max(length * length / area, 1.0) if area > 0.0 else 1.0
    gas, whole = min(around + law.gas / law.mean_gap * area, total), area + spread
    wide = area + spread * around / gas
    patch = ((total - gas) * area + gas * wide) / total
    if area > 0.0 and total - gas > _FEW * total:
        line = max(1.0 - SPOT_ON_SKIN * (1.0 - min(length / face, 1.0)), 0.0)
        flows = 0.0
        if line > 0.0:
            flows = line * flows_of_line(total - gas, gas, area, whole, below, min(length, face))
        if line < 1.0:
            flows += (1.0 - line) * flows_of_spot(conducts, around, area, whole, below)
        patch = max(patch, flows)
    return total, patch, max(min(math.sqrt(patch * longer), face), patch / face)


def array_beside_round(
    law: ArrayLaws, wedge: Wedge, conducts: Array, area: Array, length: Array
) -> tuple[Array, Array, Array]:
    """beside_round of arrays of one shape, in whatever library."""
    xp = namespace_of(conducts)
    none, one = 0.0 * conducts, 1.0 + 0.0 * conducts
    gap = law.mean_gap + none
    known = gap > 0
    gap = xp.where(known, gap, one)
    below = Beneath(*(xp.where(known, each + none, one) for each in (law.straight, law.series, law.sheet)))
    resistance, face = below.straight + below.sheet, 2 * law.half_face + none
    around, less = (law.gas * each for each in array_wedge_gas(wedge, (gap, gap + law.gas * resistance)))
    rest = ((wedge.right - wedge.left) * (wedge.upper - wedge.lower) - area).clip(0.0, None)
    differs, conducting = around > less, known & (around > 0)
    spread = around * less * resistance / xp.where(differs, around - less, one)
    spread = xp.where(differs, xp.minimum(spread, rest), rest)
    touches, total = area > 0, conducts + around
    safe_area = xp.where(touches, area, one)
    longer = xp.where(touches, (length * length / safe_area).clip(1.0, None), one)
    safe = xp.where(conducting, total, one)
    gas, whole = xp.minimum(around + law.gas / gap * area, total), area + spread
    safe_gas = xp.where(conducting, gas, one)
    wide = area + spread * around / safe_gas
    patch = ((total - gas) * area + gas * wide) / safe
    both = conducting & touches & (total - gas > _FEW * total) & (whole > area)
    contact, whole = xp.where(both, total - gas, one), xp.where(both, whole, 2 * safe_area)
    long = xp.where(touches, xp.minimum(length, face), face)
    line = (1.0 - SPOT_ON_SKIN * (1.0 - long / face)).clip(0.0, None)
    of_line = _array_flows(contact, safe_gas, safe_area, whole, below, long)
    solid, beside = xp.where(both, conducts, one), xp.where(both, around, one)
    of_spot = _array_flows(solid, beside, safe_area, whole, below, None)
    flows = line * of_line + (1.0 - line) * of_spot
    patch = xp.where(both, xp.maximum(patch, flows), patch)
    side = xp.maximum(xp.minimum((patch * longer) ** 0.5, face), patch / face)
    return (
        xp.where(conducting, total, conducts),
        xp.where(conducting, patch, area),
        xp.where(conducting, side, length),
    )


def _array_flows(
    contact: Array, gas: Array, area: Array, whole: Array, below: Beneath, along: Array | None
) -> Array:
    """flows_of_line of arrays, or flows_of_spot where `along` is None."""
    xp = namespace_of(contact)
    narrower, sheet = 1.0 / area - 1.0 / whole, below.sheet
    strength = below.series / (math.pi * (1.0 if along is None else along))
    if along is None:
        common, beside = below.straight / whole, (below.straight + sheet) / (whole - area)
        spread = below.series / 4 * math.sqrt(math.pi) * (area**-0.5 - whole**-0.5)
        beneath = common + sheet / whole
    else:
        common = beneath = beside = (below.straight + sheet) / whole
        spread = -strength * xp.log(xp.sin(math.pi / 2 * area / whole))
    narrow = 1.0 / contact + beneath + xp.minimum(spread, below.straight * narrower) + sheet * narrower
    wide = 1.0 / gas + beside
    together = (narrow * wide - common * common) / (narrow + wide - 2 * common)
    resists = together - 1.0 / (contact + gas) - beneath
    found, resists = resists > 0, xp.where(resists > 0, resists, 1.0 + 0.0 * resists)
    straight = 1.0 / (1.0 / whole + resists / (below.straight + sheet))
    if along is None:
        root = below.series * math.sqrt(math.pi) / 8
        more = resists + sheet / whole + 2 * root / whole**0.5
        spreads = ((root + (root * root + sheet * more) ** 0.5) / more) ** 2
    else:
        skinned = sheet > 0
        least = 1.0 / (1.0 / whole + resists / xp.where(skinned, sheet, 1.0 + sheet))
        spreads = xp.where(skinned, xp.maximum(area, least), area)
        for _ in range(_NEWTON_STEPS):
            at = math.pi / 2 * spreads / whole
            more = sheet * (1.0 / spreads - 1.0 / whole) - strength * xp.log(xp.sin(at)) - resists
            slope = strength * at * xp.cos(at) / xp.sin(at) + sheet / spreads
            spreads = spreads * xp.exp(more.clip(0.0, None) / slope)
    return xp.where(found, xp.maximum(xp.minimum(straight, spreads), area), whole)
