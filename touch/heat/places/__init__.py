"""Where fingertips touch objects, and the heat fields that are seen there."""

from .bodies import BodyField, crossing_rate, untouched
from .carry import carried_states
from .forgetting import MOST_PLACES
from .known import KnownFields
from .moves import moved
from .place import ACROSS, NEAR, Place
from .tips import TipField, resolution, rings_of, tip_field

__all__ = [
    "ACROSS",
    "MOST_PLACES",
    "NEAR",
    "BodyField",
    "KnownFields",
    "Place",
    "TipField",
    "carried_states",
    "moved",
    "resolution",
    "rings_of",
    "tip_field",
    "crossing_rate",
    "untouched",
]
