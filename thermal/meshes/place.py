"""Where a touched patch lies on a solid's surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermograsp.compiled import njit
from thermograsp.errors import MeshError

from ..surfaces import SurfacePatch, clip, crossed_above, crossings

ALONG = 1 - 1e-9  # of a unit vector, from which on it is along an axis
CORNERS = 24  # of a triangle clipped by twelve planes: 15
ABOVE = 5e-6  # m, more than which above a surface lies something else


@dataclass(frozen=True, slots=True)
class PlacedPatch:
    """A patch on the surface, in the grid's frame. centre, normal: (3,). half_width: m. sides: (2, 3) directions of
    the square's sides. aligned: whether they and the normal are along the grid's axes. relief: (2,) m, how far below
    and above the centre the surface reaches at the square's edges and corners. slopes: (2,) m, how far at the ends of
    each of the sides."""

    centre: np.ndarray
    normal: np.ndarray
    half_width: float
    sides: np.ndarray
    aligned: bool
    relief: tuple[float, float]
    slopes: tuple[float, float]


def place_patch(triangles: np.ndarray, patch: SurfacePatch, frame: np.ndarray) -> PlacedPatch:
    """The patch on the surface nearest to its centre along its normal. triangles: (F, 3, 3) m in the frame.

    Raises MeshError where there is no surface facing that way."""
    centre, normal = frame @ np.array(patch.centre), frame @ patch.direction
    half = patch.half_width
    axis = int(np.argmax(np.abs(normal)))
    aligned = bool(np.abs(normal[axis]) > ALONG)
    if aligned:
        normal = np.sign(normal[axis]) * np.eye(3)[axis]
    sides = patch_sides(normal)
    # where the very middle is a hole, the surface beside it
    for middle in half * np.array([[0, 0], [0.5, 0.5], [0.5, -0.5], [-0.5, 0.5], [-0.5, -0.5]]):
        depth = crossings(triangles, centre + middle @ sides, normal)
        if len(depth):
            placed = centre + depth[np.argmin(np.abs(depth))] * normal
            relief, slopes = _relief(triangles, placed, normal, half * sides)
            return PlacedPatch(placed, normal, half, sides, aligned, relief, slopes)
    at = ", ".join(f"{1e3 * x:.4g}" for x in patch.centre)
    raise MeshError(
        f"the patch at ({at}) mm with normal {tuple(round(x, 3) for x in patch.normal)} does not meet the "
        "surface: give a point on it and the outward normal there"
    )


def patch_sides(normal: np.ndarray) -> np.ndarray:
    """(2, 3): the directions of a patch's sides, across its normal (3,)."""
    first = np.cross(normal, np.eye(3)[(np.argmax(np.abs(normal)) + 1) % 3])
    first /= np.linalg.norm(first)
    return np.stack((first, np.cross(normal, first)))


def layer_beneath(triangles: np.ndarray, patch: PlacedPatch) -> float:
    """m from the patch's middle down to the first boundary of materials, 0 where there is none within half a side.
    triangles: (F, 3, 3) m of all parts in the grid's frame."""
    below = -crossings(triangles, patch.centre, patch.normal)
    below = below[(below > ABOVE) & (below < patch.half_width)]
    return float(below.min()) if len(below) else 0.0


def _relief(
    triangles: np.ndarray, centre: np.ndarray, normal: np.ndarray, sides: np.ndarray
) -> tuple[tuple[float, float], tuple[float, float]]:
    """See PlacedPatch. sides: (2, 3) m, from the middle to the edges' middles; farther away is another surface."""
    heights = []
    for place in ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)):
        above = crossings(triangles, centre + 0.999 * np.array(place) @ sides, normal)
        nearest = float(above[np.argmin(np.abs(above))]) if len(above) else 0.0
        heights.append(nearest if abs(nearest) < np.linalg.norm(sides[0]) else 0.0)
    steep = np.abs(heights[:4])
    relief = max(-min(heights), 0.0), max(max(heights), 0.0)
    return relief, (float(steep[:2].max()), float(steep[2:].max()))


@njit(cache=True, short_loops=True)
def within_cube(local, half):
    """Corners (n, 3) and their counts of the triangles' parts within the cube of that half side."""
    corners, counts = np.zeros((CORNERS * len(local), 3)), np.zeros(len(local), np.int64)
    first, second = np.zeros((CORNERS, 3)), np.zeros((CORNERS, 3))
    end = 0
    for f in range(len(local)):
        for i in range(3):  # written out: a slice takes a second more to compile
            for c in range(3):
                first[i, c] = local[f, i, c]
        count = 3
        for axis in range(3):
            count = clip(first, count, axis, -half, True, second)
            count = clip(second, count, axis, half, False, first)
        counts[f] = count
        for i in range(count):
            for c in range(3):
                corners[end + i, c] = first[i, c]
        end += count
    return corners[:end], counts


def area_within(local: np.ndarray, over: np.ndarray, half: float) -> float:
    """m2 across the third axis of the triangles' (F, 3, 3) parts within the cube of that half side, but for those that
    have another triangle, of `over` (n, 3, 3), above their middle."""
    corners, counts = within_cube(np.ascontiguousarray(local), half)
    counts = counts[counts > 0]
    if not len(counts):
        return 0.0
    ends = np.cumsum(counts)
    begin, after = ends - counts, np.arange(1, len(corners) + 1)
    after[ends - 1] = begin  # the last one's is the first of its part
    (x, y), (u, v) = corners[:, :2].T, corners[after, :2].T
    areas = np.add.reduceat(x * v - u * y, begin) / 2
    middles = np.add.reduceat(corners, begin) / counts[:, None]
    above = crossed_above(middles, np.ascontiguousarray(over), ABOVE)
    return float(areas[~above.any(axis=1)].sum())
