"""What a visitor chooses, who moves the gripper, and what the voltage says."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.studio.control.choices import RANGES, SPEEDS, Choices, Controls, Stock, one_of
    from thermograsp.studio.control.driving import Driving
    from thermograsp.studio.control.feeling import SPREAD, Feeling, known_touch

__all__ = [
    "RANGES",
    "SPEEDS",
    "SPREAD",
    "Choices",
    "Controls",
    "Driving",
    "Feeling",
    "Stock",
    "known_touch",
    "one_of",
]

__getattr__ = opened(__name__)
