"""Heat of fingertips and objects as separate passive fields that contacts join."""

from .fields import AFTERWARDS, resolution, tip_field, untouched
from .joined import HeatBalance, HeatState, JoinedHeat

__all__ = [
    "AFTERWARDS",
    "HeatBalance",
    "HeatState",
    "JoinedHeat",
    "resolution",
    "tip_field",
    "untouched",
]
