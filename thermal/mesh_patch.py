"""A touched patch on a solid's surface: where it lies, and which cells of the grid its heat enters."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from thermograsp.errors import MeshError

from .mesh_cut import cell_range, clip, slab
from .mesh_grid import MeshGrid, snapped
from .mesh_solid import SurfacePatch

_FACING = 0.2  # cosine of the angle to the patch's normal, below which a face is not touched
_ALONG = 1 - 1e-9  # of a unit vector, from which on it is along an axis
_REACH = 1.0  # half widths above and below the centre within which the surface is touched
_CORNERS = 16


@dataclass(frozen=True, slots=True)
class PlacedPatch:
    """A patch on the surface, in the grid's frame. centre, normal: (3,). half_width: m. sides: (2, 3) directions of
    the square's sides. aligned: whether they and the normal are along the grid's axes."""

    centre: np.ndarray
    normal: np.ndarray
    half_width: float
    sides: np.ndarray
    aligned: bool


@dataclass(frozen=True, slots=True)
class PatchOnGrid:
    """shares: (N,) of the patch's heat flow that enters each cell, in all 1; also how each cell's temperature counts in
    its mean. skin: K/W from the cells' nodes to the surface. area: m2 of surface touched, seen along the normal."""

    shares: np.ndarray
    skin: float
    area: float


def place_patch(triangles: np.ndarray, patch: SurfacePatch, frame: np.ndarray) -> PlacedPatch:
    """The patch on the surface nearest to its centre along its normal. triangles: (F, 3, 3) m in the frame.

    Raises MeshError where there is no surface facing that way."""
    centre, normal = frame @ np.array(patch.centre), frame @ patch.direction
    half = patch.half_width
    axis = int(np.argmax(np.abs(normal)))
    aligned = bool(np.abs(normal[axis]) > _ALONG)
    if aligned:
        normal = np.sign(normal[axis]) * np.eye(3)[axis]
    sides = np.cross(normal, np.eye(3)[(axis + 1) % 3])
    sides /= np.linalg.norm(sides)
    sides = np.stack((sides, np.cross(normal, sides)))
    for middle in (np.zeros(2), *(0.5 * half * np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]]))):
        depth = _crossings(triangles, centre + middle @ sides, normal)
        if len(depth):
            nearest = depth[np.argmin(np.abs(depth))]
            return PlacedPatch(centre + nearest * normal, normal, half, sides, aligned)
    at = " ".join(f"{1e3 * x:.4g}" for x in patch.centre)
    raise MeshError(
        f"the patch at ({at}) mm with normal {tuple(round(x, 3) for x in patch.direction)} does not meet the "
        "surface: give a point on it and the outward normal there"
    )


def patch_on_grid(grid: MeshGrid, triangles: np.ndarray, patch: PlacedPatch) -> PatchOnGrid:
    """The patch's cells. triangles: (F, 3, 3) m in the grid's frame."""
    areas = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    facing = areas @ patch.normal > _FACING * np.linalg.norm(areas, axis=1)
    axes = np.stack((*patch.sides, patch.normal))
    local = (triangles[facing] - patch.centre) @ axes.T
    reach = np.array([1.0, 1.0, _REACH]) * patch.half_width
    near = np.all((local.min(axis=1) <= reach) & (local.max(axis=1) >= -reach), axis=1)
    pieces = _within(np.ascontiguousarray(local[near]), reach)
    back = [snapped(piece @ axes + patch.centre, grid.edges) for piece in pieces]
    counts = np.array([len(piece) for piece in back], dtype=np.int64)
    corners = np.concatenate(back) if back else np.zeros((0, 3))
    size = grid.index.shape
    area, depth = np.zeros(size), np.zeros(size)
    _spread(corners, counts, patch.normal, *grid.edges, area, depth)
    solid = grid.index >= 0
    cells = grid.index[solid]
    held, offset = np.zeros(len(cells)), np.zeros(len(cells))
    held[cells], offset[cells] = area[solid], depth[solid]
    total = held.sum()
    if not total > 0:
        raise MeshError(
            f"the patch of {2e3 * patch.half_width:.3g} mm meets no surface at its place: it may lie on an edge"
        )
    # mean over the touched area of the distance from node to wall over conductivity, for evenly spread heat
    conductivity = grid.conductivity @ patch.normal**2
    shares = held / total
    above = offset - held * (grid.nodes @ patch.normal)
    return PatchOnGrid(shares, max(float(np.sum(above / conductivity)) / total**2, 0.0), float(total))


def _crossings(triangles: np.ndarray, origin: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Distances m along a line at which it leaves through faces that look its way (Moller & Trumbore 1997)."""
    a = triangles[:, 0]
    first, second = triangles[:, 1] - a, triangles[:, 2] - a
    normal = np.cross(first, second)
    facing = normal @ direction > _FACING * np.linalg.norm(normal, axis=1)
    a, first, second = a[facing], first[facing], second[facing]
    p = np.cross(direction, second)
    scale = np.einsum("fi,fi->f", first, p)
    to = origin - a
    u = np.einsum("fi,fi->f", to, p) / scale
    q = np.cross(to, first)
    v = q @ direction / scale
    inside = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9)
    return np.einsum("fi,fi->f", second, q)[inside] / scale[inside]


def _within(local: np.ndarray, reach: np.ndarray) -> list[np.ndarray]:
    """The triangles' parts within the box of half sides `reach`, as polygons."""
    polygons = []
    first, second = np.zeros((_CORNERS, 3)), np.zeros((_CORNERS, 3))
    for triangle in local:
        first[:3] = triangle
        count = 3
        for axis in range(3):
            count = clip(first, count, axis, -reach[axis], True, second)
            count = clip(second, count, axis, reach[axis], False, first)
        if count > 2:
            polygons.append(first[:count].copy())
    return polygons


@njit(cache=True)
def _spread(corners, counts, normal, x, y, z, area, depth):
    """Adds the polygons' areas seen along the normal, and their moments along it, to the cells that they lie in."""
    in_x, in_y, in_z, room = (np.zeros((24, 3)), np.zeros((24, 3)), np.zeros((24, 3)), np.zeros((24, 3)))
    start = 0
    for polygon in range(len(counts)):
        count = counts[polygon]
        shape = corners[start : start + count]
        start += count
        i0, i1 = cell_range(shape, count, 0, x, normal[0])
        for i in range(i0, i1 + 1):
            n = slab(shape, count, 0, x, i, i0, i1, room, in_x)
            if n < 3:
                continue
            j0, j1 = cell_range(in_x, n, 1, y, normal[1])
            for j in range(j0, j1 + 1):
                m = slab(in_x, n, 1, y, j, j0, j1, room, in_y)
                if m < 3:
                    continue
                k0, k1 = cell_range(in_y, m, 2, z, normal[2])
                for k in range(k0, k1 + 1):
                    c = slab(in_y, m, 2, z, k, k0, k1, room, in_z)
                    for t in range(1, c - 1):
                        seen = _seen(in_z, t, normal)
                        area[i, j, k] += seen
                        for d in range(3):
                            middle = (in_z[0, d] + in_z[t, d] + in_z[t + 1, d]) / 3
                            depth[i, j, k] += seen * middle * normal[d]


@njit(cache=True)
def _seen(polygon, t, normal):
    """Area m2 along the normal of the triangle between corners 0, t and t + 1."""
    total = 0.0
    for c in range(3):
        d, e = (c + 1) % 3, (c + 2) % 3
        total += (
            0.5
            * normal[c]
            * (
                (polygon[t, d] - polygon[0, d]) * (polygon[t + 1, e] - polygon[0, e])
                - (polygon[t, e] - polygon[0, e]) * (polygon[t + 1, d] - polygon[0, d])
            )
        )
    return total
