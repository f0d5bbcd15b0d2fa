"""Heat of fingertips and objects as separate passive fields that contacts join."""

from .array_narrow import ArrayNarrow, array_narrow
from .fields import AFTERWARDS, TipField, resolution, tip_field, untouched
from .fixed_networks import FixedNetworks
from .fixed_places import FixedPlaces, network_tables
from .joined import HeatBalance, HeatState, JoinedHeat
from .march import sample
from .narrow import narrow_tables

__all__ = [
    "AFTERWARDS",
    "ArrayNarrow",
    "FixedNetworks",
    "FixedPlaces",
    "HeatBalance",
    "HeatState",
    "JoinedHeat",
    "TipField",
    "array_narrow",
    "narrow_tables",
    "network_tables",
    "resolution",
    "sample",
    "tip_field",
    "untouched",
]
