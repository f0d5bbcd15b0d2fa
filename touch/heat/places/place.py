"""Where fingertips touch objects, and when two places are one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

NEAR = 0.1875 + 1e-6
"""Of the sensor's width: a pad that is as near to a known place is on it. A little more than one and a half steps of
the grid (march.py): the next place of a pad that slides is two steps on, half a step before it when it gets there.
Round-off does not decide between places, which are whole steps apart."""
ACROSS = 0.25
"""What a step across a face counts for one along it: pads sink in, and walls of one object are far from each other."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where a fingertip touches: a face of the object's box, 2 axis + side, the middle (2,) m along the other two axes
    from its corner, and the fingertip, by number. across: m from that corner along the face's axis, where the object is
    no box."""

    face: int
    middle: tuple[float, float]
    fingertip: int
    across: float = 0.0

    @classmethod
    def on_grid(cls, fingertip: int, face: int, middle: Sequence[float] | np.ndarray) -> Place:
        """middle: (3,) m along the face's axes and across it."""
        along, beside, across = map(float, middle)
        return cls(int(face), (along, beside), fingertip, across)

    @property
    def whole(self) -> tuple[float, float, float]:
        """m along the face's axes and across it."""
        return (*self.middle, self.across)


def near(one: Place, other: Place, reach: float) -> bool:
    """Whether two places of one fingertip are the same to it. reach: m."""
    distance = max(abs(a - b) for a, b in zip(one.middle, other.middle, strict=True))
    distance = max(distance, ACROSS * abs(one.across - other.across))
    return one.fingertip == other.fingertip and one.face == other.face and distance <= reach
