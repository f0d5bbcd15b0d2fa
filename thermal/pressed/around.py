"""What the pad around a sensor's face touches of balls and cylinders, ring by ring, as tables over force and place.

The face's own contact has closed forms (thermal/contact). A ring's comes from the same springs, summed: they sink into
the ball's or the cylinder's true shape until they take the force. The gas beside a ring's contact is left out. It
conducts some 60 W/(m2 K) where faces are .4 mm apart.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from thermograsp.compiled import njit

from ..contact import FORCES, PLACES, Pad, bared, curved_places, skinned
from ..matter import Material, Skin
from .mesh_table import conducting
from .springs import (
    Ring,
    borne,
    loads,
    lowered,
    no_springs,
    rises,
    springs,
    touched_less,
    touching_joint,
    under,
)


@dataclass(frozen=True, slots=True)
class RoundRing:
    """A ring of a fingertip's pad on a ball of that radius m, or on a cylinder of that length m. pad: its silicone;
    skin: over it, None for a bare one, in which the sensor's face is rigid. body: the object's material."""

    pad: Pad
    skin: Skin | None
    body: Material
    radius: float
    length: float | None
    ring: Ring

    def table(self) -> np.ndarray:
        """(CURVED_TABLE,), at the places of the face's own."""
        sheet = bared(self.pad) if self.skin is None else skinned(self.pad, self.skin)
        places = np.stack(curved_places(self.pad, self.length))
        touched = np.zeros((FORCES, PLACES, PLACES, 2))
        length = math.inf if self.length is None else self.length
        shape = self.radius, length, self.length is None
        points = springs(sheet, self.ring)
        near = no_springs(len(points.places))
        _press_round(*shape, places, *points, loads(sheet), near, touched)
        return conducting(sheet, touching_joint(self.skin, self.body, self.ring), places, touched)


@njit(cache=True, error_model="numpy", nogil=True)
def _press_round(radius, length, ball, places, points, areas, stiffness, counted, loads, near, touched):
    """Fills touched of springs at (n, 2) points m, of which the first are looked at, under a ball, or under
    a cylinder of that length m along the second axis. loads: m3, forces over the stiffness of springs around the
    face. near: room."""
    heights, cover = np.zeros(len(points)), np.zeros(len(points))
    slopes, touching = np.zeros(len(points)), np.zeros(counted)
    for a in range(places.shape[1]):
        for b in range(places.shape[1]):
            at = touched[:, a, b]
            for i in range(len(points)):
                y, z = points[i, 0] - places[0, a], points[i, 1] - places[1, b]
                square = y * y + (z * z if ball else 0.0)
                inside = square < radius * radius and abs(z) <= length / 2
                heights[i] = radius - math.sqrt(radius * radius - square) if inside else 0.0
                cover[i] = areas[i] if inside else 0.0
            if cover[:counted].max() == 0.0:
                continue
            lowered(heights, cover)
            rises(heights, cover, slopes[:counted])
            depth, count = np.inf, under(heights, cover, stiffness, slopes, near)
            for n in range(len(loads) - 1, -1, -1):
                depth, at[n, 0], at[n, 1] = borne(near, count, cover, loads[n], depth, touching)
                count = touched_less(near, count, depth)
