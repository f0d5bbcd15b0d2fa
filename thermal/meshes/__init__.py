"""Bodies of any shape: solids on cut-cell grids, their networks, and where they are touched."""

from .film import wetted_area
from .modes import body_modes
from .network import body_network
from .placed import LEVEL as PLACED_LEVEL
from .placed import PLACED_SHARE, own_network, placed_body
from .press import press_body
from .ringed import body_in_pads, surface_patch, wall_below
from .touched import TouchedBody, field_carried, surface_normal, touched_body

__all__ = [
    "PLACED_LEVEL",
    "PLACED_SHARE",
    "TouchedBody",
    "body_in_pads",
    "body_modes",
    "body_network",
    "field_carried",
    "own_network",
    "placed_body",
    "press_body",
    "surface_normal",
    "surface_patch",
    "touched_body",
    "wall_below",
    "wetted_area",
]
