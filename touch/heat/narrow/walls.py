"""What spreads heat on either side of a contact, as far as tables tell them apart."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ....thermal import Material, SensorStack
from ....thermal.curves import CONFORMING, LAPPED
from ...scene import PadPlace
from ..places import Place

_STEPS, _THICK, _THINNEST = 8, 0.5, 2.0**-8
"""Steps of thickness from one to its half; what is thick and the thinnest, of the sensor's width."""
_SHARES, _BEHIND = 64, 8
"""Steps of the share of a face that an object is under, and that a fingertip covers of what lies behind it."""
_BEYOND, _NEAR = 1.5, 0.2
"""Of a wall's thickness, and of the sensor's width, that its places may be farther apart than it is thick."""


@dataclass(frozen=True, slots=True)
class Beside:
    """A ring of the pad around a sensor's element under a part of its front: as much more impedance as the part is
    smaller. impedance: K/W of all of it at GRASP."""

    impedance: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Wall:
    """What of an object is under a sensor's face: share of the face, from less than all of which its network knows how
    heat spreads, and thickness m, inf where heat has spread before it comes to the other side."""

    material: Material
    share: float = 1.0
    thickness: float = math.inf


@dataclass(frozen=True, slots=True)
class Pinched:
    """A wall that a fingertip of the same kind presses from behind, on a share `by` of the sensor's face. As the flows
    from both sides are alike, no heat passes its middle: there the wall counts as half, from front to middle."""

    wall: Wall
    half: Wall
    by: float


Side = tuple[Wall | Pinched | SensorStack | Beside | None, float]
"""What spreads heat on one side of a contact, None for nothing, and W/(m2 K) of the contact if that matters."""


def wall_of(
    made_of: Material, covered: float, thickness: float, width: float, by: float = 0.0
) -> Wall | Pinched:
    """An object of that material which is under a share of a sensor's face of that width m and so many m thick there,
    and pressed from behind as pressed_behind has it: in steps that many places share."""
    share = max(round(_SHARES * covered), 1) / _SHARES
    wall, half = (Wall(made_of, share, _thick(each, width)) for each in (thickness, thickness / 2))
    return wall if by == 0.0 or half == wall else Pinched(wall, half, by)


def _thick(thickness: float, width: float) -> float:
    """m, on the steps."""
    if not thickness < _THICK * width:
        return math.inf
    step = round(_STEPS * math.log2(width / max(thickness, _THINNEST * width)))
    return width * 2.0 ** (-step / _STEPS)


def kinds_of(pads: Sequence[PadPlace]) -> list[int]:
    """A number each, the same of pads of one kind: on a wall between them, as much flows from both sides."""
    keys = [
        (*pad.size.round(6).tolist(), pad.curvature, pad.stack, pad.skin, pad.bare, pad.temperature)
        for pad in pads
    ]
    return [keys.index(key) for key in keys]


def pressed_behind(one: Place, others: Sequence[Place], thickness: float, width: float) -> float:
    """The largest share, in _BEHIND steps, that one of the others, of fingertips of the same kind, covers of a sensor's
    face of that width m behind the place, where the object is so many m thick."""
    return max((_over(one, other, thickness, width) for other in others), default=0.0)


def _over(one: Place, other: Place, thickness: float, width: float) -> float:
    if other.face != one.face ^ 1:
        return 0.0
    # between places on a body that is no box may be more than its wall, or a hollow
    away = one.across - other.across if one.face & 1 else other.across - one.across
    if (one.across or other.across) and not -_NEAR * width < away < _BEYOND * thickness + _NEAR * width:
        return 0.0
    covers = 1.0
    for a, b in zip(one.middle, other.middle, strict=True):
        covers *= max(1.0 - abs(a - b) / width, 0.0)
    return round(_BEHIND * covers) / _BEHIND


def narrow_sides(pad: PadPlace, target: Wall | Pinched | PadPlace) -> tuple[Side, Side]:
    """What spreads heat on either side of a pad's contact with an object or another fingertip: None for
    bare thermostats, which have no impedance, and where an element is glued on, which is met with its whole face."""
    if pad.glued is not None or (isinstance(target, PadPlace) and target.glued is not None):
        return (None, 0.0), (None, 0.0)
    tip_side = _side(pad)
    return tip_side, _side(target) if isinstance(target, PadPlace) else (target, tip_side[1])


def widths_of(pad: PadPlace, target: Wall | Pinched | PadPlace) -> tuple[float, float]:
    """m, the sensor's face whose patch the network on either side of that contact knows: an object has the pad's."""
    return pad.stack.width, target.stack.width if isinstance(target, PadPlace) else pad.stack.width


def _side(pad: PadPlace) -> Side:
    return (None if pad.bare else pad.stack, LAPPED if pad.skin is None else CONFORMING)
