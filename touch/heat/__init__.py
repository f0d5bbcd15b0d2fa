"""Heat of fingertips and objects as separate passive fields that contacts join."""

from .fields import AFTERWARDS, resolution, tip_field, untouched
from .fixed_places import FixedPlaces
from .joined import HeatBalance, HeatState, JoinedHeat

__all__ = [
    "AFTERWARDS",
    "FixedPlaces",
    "HeatBalance",
    "HeatState",
    "JoinedHeat",
    "resolution",
    "tip_field",
    "untouched",
]
