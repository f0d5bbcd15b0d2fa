"""The inside of cups, bottles and tubes: which faces of a solid its contents wet.

A place is inside a hollow where at least five of the six ways along the axes meet the solid: a cup is open upward, and
what is between a handle and the cup is open on two sides.

F: faces.
"""

from __future__ import annotations

import numpy as np

from .cut import cut_mesh
from .solid import Solid

_PITCH = 1.5e-3  # m, of the grid on which hollows are looked for
_MOST = 96  # cells along an axis
_WAYS = 5
_EMPTY = 1e-6  # of a cell, less than which is nothing


def wetted_faces(body: Solid) -> np.ndarray:
    """(F, 3, 3) m, the faces that look into a hollow; none where there is no hollow."""
    triangles = body.outside
    low, high = body.bounds
    pitch = max(_PITCH, float((high - low).max()) / _MOST)
    counts = np.ceil((high - low) / pitch).astype(int) + 2
    edges = tuple(at - pitch + pitch * np.arange(count + 1) for at, count in zip(low, counts, strict=True))
    solid = cut_mesh(triangles, edges)[0] > _EMPTY * pitch**3
    ways = np.zeros(solid.shape, int)
    for axis in range(3):
        ways += np.maximum.accumulate(solid, axis=axis)
        ways += np.flip(np.maximum.accumulate(np.flip(solid, axis), axis=axis), axis)
    inside = ~solid & (ways >= _WAYS)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    seen = triangles.mean(axis=1) + 2 * pitch * normals / np.maximum(length, 1e-300)
    cell = ((seen - low) / pitch + 1).astype(int)
    within = np.all((cell >= 0) & (cell < solid.shape), axis=1)
    cell = np.clip(cell, 0, np.array(solid.shape) - 1)
    return triangles[within & inside[tuple(cell.T)]]
