"""What only a simulation of several objects knows of a control step.

B: environments, O: objects, F = 2 fingertips.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from .truth import TOLD, Truth

SCENE_TOLD = (*TOLD, "touched", "object_temperatures")
"""What info tells at every step."""


@dataclass(slots=True, eq=False)
class SceneTruth(Truth):
    """The same of a gripper over several objects; what heat tells of fingertips is of the object that each touches or
    touched last, heat's last column and the books are all objects'. own: what besides is known, by name; here
    object_temperatures (B, O) °C and touched (B, F), the number of that object."""

    own: Mapping[str, Any]

    def __getitem__(self, name: str) -> Any:
        return self.own[name] if name in self.own else Truth.__getitem__(self, name)

    def told(self, row: int) -> dict[str, Any]:
        """See Truth; and what each fingertip touches, and how warm the objects are."""
        return Truth.told(self, row) | {
            "touched": self.own["touched"][row].copy(),
            "object_temperatures": self.own["object_temperatures"][row].copy(),
        }

    def __contains__(self, name: object) -> bool:
        return name in self.own or Truth.__contains__(self, name)

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys((*Truth.__iter__(self), *self.own)))

    def __len__(self) -> int:
        return len(tuple(iter(self)))
