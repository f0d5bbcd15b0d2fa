"""Grasp-v0 with stakes: objects of one look of which each forgives another force.

Metal slips through fingers that are gentle enough for cheese, and time is too short to try: the right force must be
known before the lift, and only touch tells. Densities, friction and crushing stresses are those of the material table,
with its sources; nothing is chosen but the list of materials, the size and the limits.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from ..bodies import ObjectSpec
from ..footprint import GraspBody
from ..limits import LIFT_ACCELERATION

_GRAVITY = 9.81  # m/s2

STAKES: Mapping[str, Any] = MappingProxyType(
    {
        "material": (
            "butter",
            "cheese",
            "banana",
            "expanded_polystyrene",
            "brass",
            "copper",
            "iron",
            "steel",
        ),
        "objects": ObjectSpec(size=(0.06, 0.07, 0.07)),
        "hold_seconds": 0.5,
        "seconds": 3.0,
        "most_slip": 0.002,
    }
)
"""Keywords: gymnasium.make("thermograsp/Grasp-v0", **STAKES)."""


def force_window(body: GraspBody) -> tuple[float, float]:
    """N on each pad: the least that lifts the object without a slip, m (g + a)/(2 mu) with the arm's acceleration a,
    and the force that crushes it."""
    friction = body.spec.sliding_friction
    least = body.spec.weight * (_GRAVITY + LIFT_ACCELERATION) / (2 * friction)
    return least, body.crushing_force
