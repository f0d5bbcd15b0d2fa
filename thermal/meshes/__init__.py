"""Bodies of any shape: solids on cut-cell grids, their networks, and where they are touched."""

from .film import wetted_area
from .modes import body_modes
from .network import body_network
from .placed import LEVEL as PLACED_LEVEL
from .placed import PLACED_SHARE, placed_body
from .press import press_body
from .ringed import body_in_pads, covered_share, surface_patch
from .touched import TouchedBody, field_carried, surface_normal, touched_body

__all__ = [
    "PLACED_LEVEL",
    "PLACED_SHARE",
    "TouchedBody",
    "body_in_pads",
    "body_modes",
    "body_network",
    "covered_share",
    "field_carried",
    "placed_body",
    "press_body",
    "surface_normal",
    "surface_patch",
    "touched_body",
    "wetted_area",
]
