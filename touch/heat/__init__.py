"""Heat of fingertips and objects as separate passive fields that contacts join."""

from .array_narrow import ArrayNarrow, array_narrow
from .fixed import FixedNetworks, FixedPlaces, network_tables
from .joined import JoinedHeat
from .march import sample
from .narrow import Wall, narrow_tables, wall_of
from .places import TipField, crossing_rate, resolution, tip_field, untouched
from .records import HeatBalance, HeatState
from .reported import tell_books, tell_drop, tell_warmth
from .ripple import array_ripple

__all__ = [
    "ArrayNarrow",
    "FixedNetworks",
    "FixedPlaces",
    "HeatBalance",
    "HeatState",
    "JoinedHeat",
    "TipField",
    "Wall",
    "array_narrow",
    "array_ripple",
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
