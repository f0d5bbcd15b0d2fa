"""Bodies of any shape that are touched anywhere: networks of places, from a body's modes and what lies beneath."""

from .placed import PLACED_SHARE, placed_body
from .ports import LEVEL as PLACED_LEVEL
from .ringed import body_in_pads, surface_patch, wall_below
from .slow import own_network

__all__ = [
    "PLACED_LEVEL",
    "PLACED_SHARE",
    "body_in_pads",
    "own_network",
    "placed_body",
    "surface_patch",
    "wall_below",
]
