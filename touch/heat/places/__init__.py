"""Where fingertips touch objects, and the heat fields that are seen there."""

from .bodies import BodyField, untouched
from .carry import carried_states
from .forgetting import MOST_PLACES, forgotten
from .known import KnownFields
from .place import ACROSS, NEAR, Place, near
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
    "forgotten",
    "near",
    "resolution",
    "rings_of",
    "tip_field",
    "untouched",
]
