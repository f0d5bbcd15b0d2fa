"""A sensor's element with the pad around it, which gives heat to the element's sides and to the object."""

from .places import PaddedTip, box_in_pads, padded_tip
from .ring_shares import ring_shares
from .rings import RING_PORTS, RINGS, ring_sides
from .touch import padded_sides

__all__ = [
    "RINGS",
    "RING_PORTS",
    "PaddedTip",
    "box_in_pads",
    "padded_sides",
    "padded_tip",
    "ring_shares",
    "ring_sides",
]
