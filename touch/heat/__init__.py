"""Heat of fingertips and objects as separate passive fields that contacts join."""

from .fields import AFTERWARDS, resolution, tip_field, untouched
from .fixed_places import FixedPlaces
from .joined import HeatBalance, HeatState, JoinedHeat
from .narrow import narrow_of

__all__ = [
    "AFTERWARDS",
    "FixedPlaces",
    "HeatBalance",
    "HeatState",
    "JoinedHeat",
    "narrow_of",
    "resolution",
    "tip_field",
    "untouched",
]
