"""What a system of contacts keeps of an object that is no plate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..plates import Geometry


@dataclass(frozen=True, slots=True)
class BodyGeometry(Geometry):
    """Fingertips on a body of any shape. body_capacity: J/K. body_surface: m2. The plate in the other fields is the one
    that the sensors' states and flux patterns were learned on."""

    body_capacity: float = np.nan
    body_surface: float = np.nan

    @property
    def whole_capacity(self) -> float:
        """J/K of the whole object."""
        return self.body_capacity

    @property
    def surface(self) -> float:
        """m2 of the whole object's surface."""
        return self.body_surface
