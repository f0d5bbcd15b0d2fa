"""Bodies of any shape: solids on cut-cell grids, their networks and modes, and where they are touched."""

from .film import Film, film_of, held_apart, wetted_area
from .grid import MeshGridding
from .modes import BodyModes, body_modes
from .network import PatchFields, body_network, patch_fields
from .patch import PatchPatterns, patch_on_grid, uniform_pattern
from .place import ABOVE, PlacedPatch, area_within, patch_sides, place_patch
from .press import press_body
from .touched import (
    PLATE,
    PLATE_MATERIAL,
    TouchedBody,
    field_carried,
    geometry_of,
    nearest_surface,
    surface_normal,
    touched_body,
)

__all__ = [
    "ABOVE",
    "PLATE",
    "PLATE_MATERIAL",
    "BodyModes",
    "Film",
    "MeshGridding",
    "PatchFields",
    "PatchPatterns",
    "PlacedPatch",
    "TouchedBody",
    "body_modes",
    "body_network",
    "field_carried",
    "film_of",
    "geometry_of",
    "held_apart",
    "nearest_surface",
    "patch_fields",
    "patch_on_grid",
    "area_within",
    "patch_sides",
    "place_patch",
    "press_body",
    "surface_normal",
    "touched_body",
    "uniform_pattern",
    "wetted_area",
]
