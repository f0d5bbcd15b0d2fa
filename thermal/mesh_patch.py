"""A touched patch on a solid's surface: where it lies, and which cells of the grid its heat enters."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from thermograsp.errors import MeshError

from .mesh_cut import cell_range, clip, slab
from .mesh_grid import ALONG, MeshGrid, snapped
from .mesh_patterns import PatchPatterns
from .mesh_solid import SurfacePatch

_FACING = 0.2  # cosine of the angle to the patch's normal, below which a face is not touched
_ABOVE = 5e-6  # m, more than which above a surface lies something else
_CORNERS = 24  # of a triangle clipped by twelve planes: 15


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


@dataclass(frozen=True, slots=True)
class PatchOnGrid:
    """shares: (N, M) how each pattern's heat flow is spread over the cells, the uniform one's in all 1; also how the
    cells' temperatures count in the pattern's. skin: (M, M) K/W from the cells' nodes to the surface. area: m2 of
    surface touched, seen along the normal."""

    shares: np.ndarray
    skin: np.ndarray
    area: float


def place_patch(triangles: np.ndarray, patch: SurfacePatch, frame: np.ndarray) -> PlacedPatch:
    """The patch on the surface nearest to its centre along its normal. triangles: (F, 3, 3) m in the frame.

    Raises MeshError where there is no surface facing that way."""
    centre, normal = frame @ np.array(patch.centre), frame @ patch.direction
    half = patch.half_width
    axis = int(np.argmax(np.abs(normal)))
    aligned = bool(np.abs(normal[axis]) > ALONG)
    if aligned:
        normal = np.sign(normal[axis]) * np.eye(3)[axis]
    first = np.cross(normal, np.eye(3)[(axis + 1) % 3])
    first /= np.linalg.norm(first)
    sides = np.stack((first, np.cross(normal, first)))
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


def layer_beneath(triangles: np.ndarray, patch: PlacedPatch) -> float:
    """m from the patch's middle down to the first boundary of materials, 0 where there is none within half a side.
    triangles: (F, 3, 3) m of all parts in the grid's frame."""
    below = -crossings(triangles, patch.centre, patch.normal)
    below = below[(below > _ABOVE) & (below < patch.half_width)]
    return float(below.min()) if len(below) else 0.0


def patch_on_grid(
    grid: MeshGrid, triangles: np.ndarray, patch: PlacedPatch, patterns: PatchPatterns
) -> PatchOnGrid:
    """The patch's cells. triangles: (F, 3, 3) m in the grid's frame. Surface within half a side above and below the
    centre is touched, where it faces the patch's way and nothing of the object lies above it."""
    axes = np.stack((*patch.sides, patch.normal))
    half = patch.half_width
    areas = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    facing = areas @ patch.normal > _FACING * np.linalg.norm(areas, axis=1)
    local = (triangles[facing] - patch.centre) @ axes.T
    near = np.all((local.min(axis=1) <= half) & (local.max(axis=1) >= -half), axis=1)
    corners, counts = _within(np.ascontiguousarray(local[near]), half)
    corners = np.ascontiguousarray(snapped(corners @ axes + patch.centre, grid.edges))
    room = 4096
    while True:
        cells, seen, middles, spans = _pieces(corners, counts, axes, *grid.edges, room)
        if len(cells) < room:
            break
        room *= 4
    cells = grid.index.ravel()[cells]
    around = (triangles - patch.centre) @ axes.T
    over = np.all((around.min(axis=1) <= [half, half, np.inf]) & (around.max(axis=1) >= -half), axis=1)
    covered = _covered((middles - patch.centre) @ axes.T, np.ascontiguousarray(around[over]))
    there = (cells >= 0) & ~covered
    cells, seen, middles, spans = cells[there], seen[there], middles[there], spans[there]
    total = float(seen.sum())
    if not total > 0:
        raise MeshError(
            f"the patch {2e3 * half:.3g} mm wide meets no surface at its place: it may lie beyond an edge"
        )
    weights = seen / total
    spans = (spans - (patch.sides @ patch.centre)[:, None]) / half
    values = patterns.means(spans[:, :, 0], spans[:, :, 1])
    # Only the uniform pattern lets heat in, also where the surface ends within the patch.
    values[:, 1:] -= weights @ values[:, 1:]
    shares = np.zeros((len(grid.capacity), patterns.count))
    np.add.at(shares, cells, weights[:, None] * values)
    # from a cell's node to its wall, along the normal
    across = grid.conductivity[cells] @ patch.normal**2
    distance = (middles - grid.nodes[cells]) @ patch.normal
    skin = values.T @ ((weights * distance / across / total)[:, None] * values)
    levels, turn = np.linalg.eigh(skin)
    return PatchOnGrid(shares, (turn * np.maximum(levels, 0.0)) @ turn.T, total)


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


def crossings(triangles: np.ndarray, origin: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Distances m along a line at which it leaves through faces that look its way (Moller & Trumbore, J. Graph. Tools
    2, 1997)."""
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


@njit(cache=True)
def _covered(places, triangles):
    """(n,) whether something of triangles (F, 3, 3) lies above places (n, 3), along the third axis."""
    covered = np.zeros(len(places), np.bool_)
    for n in range(len(places)):
        x, y, z = places[n]
        for f in range(len(triangles)):
            a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
            if max(a[2], b[2], c[2]) <= z + _ABOVE:
                continue
            u = (b[0] - x) * (c[1] - y) - (b[1] - y) * (c[0] - x)
            v = (c[0] - x) * (a[1] - y) - (c[1] - y) * (a[0] - x)
            w = (a[0] - x) * (b[1] - y) - (a[1] - y) * (b[0] - x)
            total = u + v + w
            inside = (u >= 0 and v >= 0 and w >= 0) or (u <= 0 and v <= 0 and w <= 0)
            if inside and total != 0 and (u * a[2] + v * b[2] + w * c[2]) / total > z + _ABOVE:
                covered[n] = True
                break
    return covered


@njit(cache=True)
def _within(local, half):
    """Corners (n, 3) and their counts of the triangles' parts within the cube of that half side."""
    corners, counts = np.zeros((_CORNERS * len(local), 3)), np.zeros(len(local), np.int64)
    first, second = np.zeros((_CORNERS, 3)), np.zeros((_CORNERS, 3))
    end = 0
    for f in range(len(local)):
        first[:3] = local[f]
        count = 3
        for axis in range(3):
            count = clip(first, count, axis, -half, True, second)
            count = clip(second, count, axis, half, False, first)
        counts[f] = count
        corners[end : end + count] = first[:count]
        end += count
    return corners[:end], counts


@njit(cache=True)
def _pieces(corners, counts, axes, x, y, z, room):
    """The polygons' pieces in the cells, at most `room`: cells (n,) in the order of memory, areas (n,) seen along the
    last of the axes, middles (n, 3), and spans (n, 2, 2) from where to where along the first two."""
    normal = axes[2]
    in_x, in_y, in_z, spare = (
        np.zeros((_CORNERS, 3)),
        np.zeros((_CORNERS, 3)),
        np.zeros((_CORNERS, 3)),
        np.zeros((_CORNERS, 3)),
    )
    cells, seen = np.zeros(room, np.int64), np.zeros(room)
    middles, spans = np.zeros((room, 3)), np.zeros((room, 2, 2))
    found, start = 0, 0
    for polygon in range(len(counts)):
        count = counts[polygon]
        shape = corners[start : start + count]
        start += count
        if count < 3:
            continue
        i0, i1 = cell_range(shape, count, 0, x, normal[0])
        for i in range(i0, i1 + 1):
            n = slab(shape, count, 0, x, i, i0, i1, spare, in_x)
            if n < 3:
                continue
            j0, j1 = cell_range(in_x, n, 1, y, normal[1])
            for j in range(j0, j1 + 1):
                m = slab(in_x, n, 1, y, j, j0, j1, spare, in_y)
                if m < 3:
                    continue
                k0, k1 = cell_range(in_y, m, 2, z, normal[2])
                for k in range(k0, k1 + 1):
                    c = slab(in_y, m, 2, z, k, k0, k1, spare, in_z)
                    area = _seen(in_z, c, normal, middles[found])
                    if area > 1e-20 and found < room - 1:
                        cells[found] = (i * (len(y) - 1) + j) * (len(z) - 1) + k
                        seen[found] = area
                        _span(in_z, c, axes, spans[found])
                        found += 1
    if found == room - 1:
        found = room
    return cells[:found], seen[:found], middles[:found], spans[:found]


@njit(cache=True)
def _span(polygon, count, axes, span):
    """From where to where (2, 2) a polygon reaches along the first two axes."""
    for side in range(2):
        span[side, 0], span[side, 1] = np.inf, -np.inf
        for i in range(count):
            at = 0.0
            for c in range(3):
                at += polygon[i, c] * axes[side, c]
            span[side, 0], span[side, 1] = min(span[side, 0], at), max(span[side, 1], at)


@njit(cache=True)
def _seen(polygon, count, normal, middle):
    """Area m2 of a polygon seen along a normal; its middle is filled in."""
    total = 0.0
    middle[:] = 0.0
    for t in range(1, count - 1):
        part = 0.0
        for c in range(3):
            d, e = (c + 1) % 3, (c + 2) % 3
            part += (
                0.5
                * normal[c]
                * (
                    (polygon[t, d] - polygon[0, d]) * (polygon[t + 1, e] - polygon[0, e])
                    - (polygon[t, e] - polygon[0, e]) * (polygon[t + 1, d] - polygon[0, d])
                )
            )
        total += part
        for c in range(3):
            middle[c] += part * (polygon[0, c] + polygon[t, c] + polygon[t + 1, c]) / 3
    if total > 0:
        middle /= total
    return total
