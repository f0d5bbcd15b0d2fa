"""Bodies of any shape on a pad's springs."""

from .around import RoundRing
from .foundation import face_springs, pressure_map
from .height_map import HeightMap, height_map, map_heights
from .lying import Moments, lie
from .mesh_table import PressedMesh, PressedView, pressed_view
from .rounded import corner_normals
from .springs import Ring, square_middles

__all__ = [
    "HeightMap",
    "Moments",
    "PressedMesh",
    "PressedView",
    "Ring",
    "RoundRing",
    "corner_normals",
    "face_springs",
    "height_map",
    "lie",
    "map_heights",
    "pressed_view",
    "pressure_map",
    "square_middles",
]
