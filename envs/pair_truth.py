"""What only a simulation of two objects knows of a control step.

B: environments, O = 2 objects, F = 2 fingertips, G: what can be asked.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from .truth import TOLD, Truth

PAIR_TOLD = (*TOLD, "asked", "right", "object_temperatures")
"""What info tells at every step."""


@dataclass(frozen=True, slots=True)
class PairTruth(Truth):
    """The same of a gripper over two objects; what heat tells of fingertips is of the object that each touches or
    touched last, heat's last column and the books are both objects'. episodes: material, rung (B,) tuples of both,
    crushing_force (B, O). lift (B, O). own: object_temperature and object_temperatures (B, O) °C, object_force
    (B, O, F, 3) N, goal (B, G), asked (B,) and right (B,), the number of the right object."""

    own: Mapping[str, Any]

    def __getitem__(self, name: str) -> Any:
        return self.own[name] if name in self.own else Truth.__getitem__(self, name)

    def told(self, row: int) -> dict[str, Any]:
        """See Truth; and what is asked."""
        return Truth.told(self, row) | {
            "asked": self.own["asked"][row],
            "right": self.own["right"][row].item(),
            "object_temperatures": self.own["object_temperatures"][row].copy(),
        }

    def __contains__(self, name: object) -> bool:
        return name in self.own or Truth.__contains__(self, name)

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys((*Truth.__iter__(self), *self.own)))

    def __len__(self) -> int:
        return len(tuple(iter(self)))
