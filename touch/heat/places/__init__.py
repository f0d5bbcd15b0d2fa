"""Where fingertips touch objects, and the heat fields that are seen there."""

from .bodies import BodyField, untouched
from .carry import AFTERWARDS, carried_states
from .known import KnownFields
from .place import ACROSS, MOST_PLACES, NEAR, Place, near
from .tips import TipField, resolution, rings_of, tip_field

__all__ = [
    "ACROSS",
    "AFTERWARDS",
    "MOST_PLACES",
    "NEAR",
    "BodyField",
    "KnownFields",
    "Place",
    "TipField",
    "carried_states",
    "near",
    "resolution",
    "rings_of",
    "tip_field",
    "untouched",
]
