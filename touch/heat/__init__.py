"""Heat of fingertips and objects as separate passive fields that contacts join."""

from .fixed import FixedNetworks, FixedPlaces, network_tables
from .joined import JoinedHeat
from .march import sample
from .narrow import (
    ArrayNarrow,
    Pinched,
    Wall,
    array_narrow,
    array_ripple,
    face_modes,
    kinds_of,
    narrow_tables,
    wall_of,
)
from .places import TipField, crossing_rate, resolution, tip_field, untouched
from .records import HeatBalance, HeatState
from .reported import tell_books, tell_drop, tell_warmth

__all__ = [
    "ArrayNarrow",
    "FixedNetworks",
    "FixedPlaces",
    "HeatBalance",
    "HeatState",
    "JoinedHeat",
    "Pinched",
    "TipField",
    "Wall",
    "array_narrow",
    "array_ripple",
    "face_modes",
    "kinds_of",
    "narrow_tables",
    "network_tables",
    "resolution",
    "sample",
    "tell_books",
    "tell_drop",
    "tell_warmth",
    "tip_field",
    "crossing_rate",
    "untouched",
    "wall_of",
]
