"""How large a patch of even conductance stands for a curved body on a sensor's face.

Beside the contact gas conducts k/(d + r^2/(2 R)): as well as between lapped faces in the middle, and out at the face's
edge a hundredth of it. A network has one patch of one conductance. With g the conductance of the gas over the whole
face, W/K, and g' that of the same gas with 1/b = l (1/k + 1/k') of both bodies in series at each place, a patch of area

    A = g g'/(b (g - g'))

and evenly g/A loses as much to the bodies' resistance as the gas does: little where b is large, so that the patch is
wide under wood and narrow under copper. l is how deep heat has come into the body in a second, but 0.8 mm at most,
since it spreads sideways by then: a fit to finite volumes of the contact place by place
(studies/contact/curved_patch.py), balls of 5, 20 and 50 mm of five materials. A skin's resistance is in b, too.

**Under a skin**, or between bodies that give way, the patch is what touches and the gas's A together, whole. Heat of
what touches meets more on its way there, K/W (through_soft): of the skin

    sheet (1/(area + edge) - 1/(whole + edge'))

where edge is how far it spreads in the skin, 0.35 times its thickness along what touches, and of the bodies the lesser
of straight flow's and of what spreads from a disc, (1/k + 1/k')(1/a - 1/w)/4, or from a strip in a channel; as
1/sqrt(1/u^2 + 1/v^2), since the one is the other's limit in time. All of it is in series with what touches, less what
would flow evenly through as much gas. The patch hardly changes with the force, and what it conducts does: drops after a
second are within 5 % of the volumes' for balls of 5 to 50 mm of copper, aluminium, glass and wood at 0.01 to 10 N, and
within 7 % for cylinders of 20 mm at 0.05 to 60 N.

**On a bare face**, which is rigid, the contact of a ball is constricted in footprint.py, and its patch is the mean of
its own area and the gas's, weighted by what they conduct. A line's is as wide as two flows side by side tell, if that
is more.
"""

from __future__ import annotations

import math

import numpy as np

from thermograsp.compiled import njit

from ..matter import Material, Skin
from ..numerics import Array, namespace_of
from .array_law import ArrayLaws
from .fingertip import Beneath, beneath
from .footprint import array_through_soft, reached, solid_conduction, through_soft, touched
from .gas_beside import Wedge, array_wedge_gas, wedge_gas
from .law import CYLINDER
from .rough_faces import LAPPED_ALUMINA, Surface

_MOST_NARROWED, _EVENED = 0.56, 1 / 3  # see narrowing
_FEW = 1e-6  # of what both conduct: less is no contact
_MIDDLE = np.zeros(3)


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


@njit(cache=True, error_model="numpy")
def patches(law, below, force, place):
    """(W/K of the contact, W/K of the gas, m2 of their two patches, m2 of the one that stands for both) at a force
    N > 0 on the pad. below: of beneath."""
    contact, gas, area, wide, whole, around = both_contacts(law, below, force, place)
    total = contact + gas
    if law.series > 0.0:
        return total - around, around, whole, whole, whole
    if total <= 0.0:
        return contact, gas, area, wide, area
    even = (contact * area + gas * wide) / total
    if contact < _FEW * total or around <= 0.0 or law.shape != CYLINDER:
        return contact, gas, area, wide, even
    half, other = law.half_face, law.length / 2
    along = max(min(half, other - place[2]) - max(-half, -other - place[2]), 0.0)
    least = flows_of_line(contact, gas, area, whole, below, along)
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
    """m2 of a bare face's patch that resists as much as two flows side by side do: an even one through the gas over
    `whole` m2, and one over the contact's m2. along: m, the contact's length. The rest as in patches.

    A flow that may choose between more ways meets no more resistance (Thomson's principle). Where the contact conducts
    more than the bodies beneath it, the mean of the areas is narrower than this: it let a can of plastic take up half
    as much heat when it was pressed harder (studies/contact/curved_patch.py --cylinders)."""
    if area <= 0.0 or area >= whole:
        return whole
    both = below.straight / whole  # which is common to them
    strength = below.series / (math.pi * along)  # K/W, of a strip in a channel
    spreads = -strength * math.log(math.sin(math.pi / 2 * area / whole))
    drawn = min(spreads, below.straight * (1.0 / area - 1.0 / whole))
    narrow, wide = 1.0 / contact + both + drawn, 1.0 / gas + both
    resists = (narrow * wide - both * both) / (narrow + wide - 2 * both) - 1.0 / (contact + gas) - both
    if resists <= 0.0:
        return whole
    straight = 1.0 / (1.0 / whole + resists / below.straight)
    strip = 2 / math.pi * whole * math.asin(math.exp(-resists / strength))
    return max(min(straight, strip), area)


@njit(cache=True, error_model="numpy")
def both_contacts(law, below, force, place):
    """(W/K of the contact, W/K of the gas, m2 of their two patches, m2 of all the gas, W/K of the gas beside what
    touches) at a force N > 0 on the pad; see footprint's conduction. The gas is as it would be without force under the
    contact too, where it is spread as wide as beside it if heat is constricted, and is so among all the gas."""
    area, load, square, hertz = touched(law, force, place)
    around, spread = reached(law, below.straight + below.sheet, area, square, hertz, place)
    total = solid_conduction(law, area, load, place, around, spread) + around
    if law.mean_gap <= 0.0:
        return total, 0.0, area, area, area, 0.0
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
    below = Beneath(law.straight, law.deep, law.series, law.sheet, law.thick)
    resistance, face = below.straight + below.sheet, 2 * law.half_face
    less = law.gas * wedge_gas(wedge, law.mean_gap + law.gas * resistance)
    rest = max((wedge.right - wedge.left) * (wedge.upper - wedge.lower) - area, 0.0)
    spread = min(around * less * resistance / (around - less), rest) if around > less else rest
    whole, longer = area + spread, 1.0
    if area > 0.0:
        longer = max(length * length / area, 1.0)
        conducts = through_soft(conducts, around, area, length, face, whole, below)
    return conducts + around, whole, max(min(math.sqrt(whole * longer), face), whole / face)


def array_beside_round(
    law: ArrayLaws, wedge: Wedge, conducts: Array, area: Array, length: Array
) -> tuple[Array, Array, Array]:
    """beside_round of arrays of one shape, in whatever library."""
    xp = namespace_of(conducts)
    none, one = 0.0 * conducts, 1.0 + 0.0 * conducts
    gap = law.mean_gap + none
    known = gap > 0
    gap = xp.where(known, gap, one)
    told = (law.straight, law.deep, law.series, law.sheet, law.thick)
    below = Beneath(*(xp.where(known, each + none, one) for each in told))
    resistance, face = below.straight + below.sheet, 2 * law.half_face + none
    around, less = (law.gas * each for each in array_wedge_gas(wedge, (gap, gap + law.gas * resistance)))
    rest = ((wedge.right - wedge.left) * (wedge.upper - wedge.lower) - area).clip(0.0, None)
    differs, conducting = around > less, known & (around > 0)
    spread = around * less * resistance / xp.where(differs, around - less, one)
    spread = xp.where(differs, xp.minimum(spread, rest), rest)
    touches, whole = conducting & (area > 0), area + spread
    partly = touches & (spread > 0)
    longer = xp.where(touches, (length * length / xp.where(touches, area, one)).clip(1.0, None), one)
    of_all = ((conducts, one), (around, one), (area, one), (length, one), (face, one), (whole, 2 * one))
    solid, beside, some, long, width, more = (xp.where(partly, each, other) for each, other in of_all)
    solid = array_through_soft(solid, beside, some, long, width, more, below)
    side = xp.maximum(xp.minimum((whole * longer) ** 0.5, face), whole / face)
    return (
        xp.where(conducting, xp.where(partly, solid, conducts) + around, conducts),
        xp.where(conducting, whole, area),
        xp.where(conducting, side, length),
    )
