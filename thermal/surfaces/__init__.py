"""Closed surfaces of triangles: what rays meet, what they enclose, cut and hold, and the solids that they bound."""

from .check import open_edges, wrongly_enclosed
from .cut import Edges, clip, cut_mesh, cutting, enclosed, in_planes
from .hollow import wetted_faces
from .nesting import BENEATH, NEARLY_ALL, hosts, net_volumes, shares_within
from .rays import FACING, cross, crossed_above, crossings, depths, twice_areas
from .solid import Solid, SolidPart, SurfacePatch, checked, solid, surface_patches

__all__ = [
    "BENEATH",
    "FACING",
    "NEARLY_ALL",
    "Edges",
    "Solid",
    "SolidPart",
    "SurfacePatch",
    "checked",
    "clip",
    "cross",
    "crossed_above",
    "crossings",
    "cut_mesh",
    "cutting",
    "depths",
    "enclosed",
    "hosts",
    "in_planes",
    "net_volumes",
    "open_edges",
    "shares_within",
    "solid",
    "surface_patches",
    "twice_areas",
    "wetted_faces",
    "wrongly_enclosed",
]
