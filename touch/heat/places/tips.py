"""Heat fields of fingertips: passive networks of their whole faces, so that a field goes with a fingertip wherever it
touches.

n: states, M: patterns of a contact.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ....thermal.kernels import Resolution, Tip, glued_element, tip
from ....thermal.numerics import ThermalNetwork
from ....thermal.padded import PaddedTip, padded_tip, ring_sides
from ...scene import PadPlace

Rings = tuple[float, ...]
"""m, the outer sides of the rings of a pad."""

_SLOWEST = 3e-3  # 1/s, so that rates serve the minute of a grasp, and pads, in which heat stays for long
_LEVELS = ((0.04, Resolution(14, 3, slowest=_SLOWEST)), (0.0, Resolution(14, 4, slowest=_SLOWEST)))
_PADDED_MOMENTS = 12


def resolution(tolerance: float, solid: bool = False) -> Resolution:
    """Rates and patterns that are meant to keep a tolerance, K of temperature drop for a difference of 12 K. solid:
    whether an object is no box, which has one level."""
    if solid:
        from ....thermal.anywhere import PLACED_LEVEL  # nothing that meshes need is loaded without them

        return PLACED_LEVEL
    return next(level for least, level in _LEVELS if tolerance >= least)


@dataclass(frozen=True, slots=True, eq=False)
class TipField:
    """A fingertip's or a glued element's network. tip: of its whole face. face: (n, M) sqrt(K/J), its ports for another
    fingertip that touches it. uniform: (n,) states of one that is 1 K warm throughout. padded: in its pad, whose heat
    the network has too; None for an element without one."""

    tip: Tip
    face: np.ndarray
    uniform: np.ndarray
    padded: PaddedTip | None = None


def tip_field(pad: PadPlace, level: Resolution) -> TipField:
    """The network of a fingertip's whole face, of an element that is glued on, or of a bare thermostat, which has no
    states and stays as warm as it is."""
    if pad.glued is not None:
        element = glued_element(pad.stack, level)
        return TipField(element.bond, element.top, element.uniform)
    if pad.surround is not None:
        padded = padded_tip(pad.stack, pad.surround, level, _PADDED_MOMENTS)
        return TipField(padded.tip, padded.tip.side.ports, padded.tip.uniform, padded)
    whole = (0.0, pad.stack.width)
    made = tip(pad.stack, (whole, whole), level)
    if pad.bare:
        none = np.zeros(0)
        made = replace(
            made,
            side=ThermalNetwork(none, np.zeros((0, level.patterns)), outputs={"drop": none, "element": none}),
        )
    return TipField(made, made.side.ports, made.uniform)


def rings_of(pad: PadPlace) -> Rings | None:
    """Of the pad around a fingertip's element."""
    return None if pad.surround is None else ring_sides(pad.stack.width, pad.surround)
