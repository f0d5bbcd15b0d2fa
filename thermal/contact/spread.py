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
from .footprint import beside, solid_conduction, touched
from .law import CYLINDER
from .rough_faces import LAPPED_ALUMINA, Surface

_DEEPEST, _SECONDS = 0.8e-3, 1.0  # m, s, see above
_MOST_NARROWED, _EVENED = 0.56, 1 / 3  # see narrowing
_HALVINGS = 30  # of an interval of areas
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
    """m2, at least the area's, whose flow resists by that many K/W more than one over the whole."""
    if resists <= 0.0:
        return whole
    low, high = area, whole
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        if _drawn_together(middle, whole, below, along) > resists:
            low = middle
        else:
            high = middle
    return high


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
