"""What only a simulation of two objects knows of a control step.

B: environments, O = 2 objects, F = 2 fingertips, G: what can be asked.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .scene_truth import SceneTruth
from .truth import TOLD, Truth

PAIR_TOLD = (*TOLD, "asked", "right", "object_temperatures")
"""What info tells at every step."""


@dataclass(slots=True, eq=False)
class PairTruth(SceneTruth):
    """As a scene's. episodes: material, rung (B,) tuples of both, crushing_force (B, O). lift (B, O). own:
    object_temperature and object_temperatures (B, O) °C, object_force (B, O, F, 3) N, goal (B, G), asked (B,) and right
    (B,), the number of the right object."""

    def told(self, row: int) -> dict[str, Any]:
        """See Truth; and what is asked."""
        return Truth.told(self, row) | {
            "asked": self.own["asked"][row],
            "right": self.own["right"][row].item(),
            "object_temperatures": self.own["object_temperatures"][row].copy(),
        }
