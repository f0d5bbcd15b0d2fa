"""Bodies of any shape: closed meshes on cut-cell grids, their networks, and where they are touched."""

from .check import open_edges, wrongly_enclosed
from .nesting import BENEATH, NEARLY_ALL, hosts, shares_within
from .network import body_network
from .press import press_body
from .rays import crossed_above, crossings
from .solid import Solid, SolidPart, SurfacePatch, solid
from .touched import TouchedBody, field_carried, surface_normal, touched_body

__all__ = [
    "BENEATH",
    "NEARLY_ALL",
    "Solid",
    "SolidPart",
    "SurfacePatch",
    "TouchedBody",
    "body_network",
    "crossed_above",
    "crossings",
    "field_carried",
    "hosts",
    "open_edges",
    "press_body",
    "shares_within",
    "solid",
    "surface_normal",
    "touched_body",
    "wrongly_enclosed",
]
