"""Closed triangle meshes cut by a tensor grid: how much of each cell and of each cell's faces lies inside, exactly.

Each triangle is clipped to the cells that it passes through. The pieces' area vectors, summed along an axis, are the
open areas of the cell faces across it, and their moments the volumes (divergence theorem), so that the areas of a
cell's faces and of its wall close to round-off whatever the mesh is.

I, J, K: cells along the axes. A face in a plane of the grid belongs to the cell on the body's side.
"""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit

_MOST_CORNERS = 12  # of a triangle clipped by six planes: 9


Edges = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Cell boundaries m along the three axes."""


def cut_mesh(triangles: np.ndarray, edges: Edges) -> tuple[np.ndarray, Edges]:
    """Volumes (I, J, K) m3 inside a closed mesh, and open areas m2 of the faces across the axes: (I + 1, J, K),
    (I, J + 1, K), (I, J, K + 1).

    triangles: (F, 3, 3) m, outward counter-clockwise. edges: around the whole mesh. What overlapping surfaces enclose
    twice counts once in a cell that is wholly inside.
    """
    volumes, walls = enclosed(triangles, edges)
    open_areas = []
    for axis in range(3):
        padding = [(0, 0)] * 3
        padding[axis] = (1, 0)
        passed = np.pad(-np.cumsum(walls[..., axis], axis=axis), padding)
        across = [np.diff(e) for a, e in enumerate(edges) if a != axis]
        full = np.expand_dims(np.multiply.outer(*across), axis)
        open_areas.append(np.clip(passed, 0.0, full))
    x, y, z = (np.diff(e) for e in edges)
    full = x[:, None, None] * y[:, None] * z
    return np.clip(volumes, 0.0, full), (open_areas[0], open_areas[1], open_areas[2])


def enclosed(triangles: np.ndarray, edges: Edges) -> tuple[np.ndarray, np.ndarray]:
    """Volumes (I, J, K) m3, each counted as often as it is enclosed and negative where inside out, and the area
    vectors (I, J, K, 3) m2 of the mesh within each cell."""
    x, y, z = edges
    shape = (len(x) - 1, len(y) - 1, len(z) - 1)
    walls, moments = np.zeros((*shape, 3)), np.zeros(shape)
    _accumulate(np.ascontiguousarray(triangles, float), x, y, z, walls, moments)
    right = -np.cumsum(walls[..., 0], axis=0)
    volumes = moments - x[:-1, None, None] * walls[..., 0] + np.diff(x)[:, None, None] * right
    return volumes, walls


def in_planes(triangles: np.ndarray, edges: Edges) -> tuple[Edges, Edges]:
    """Areas m2 of a mesh that lie in the planes of the grid, on each cell face across the axes (shapes as open areas):
    those with the body below and those with the body above."""
    below, above = [], []
    for axis in range(3):
        order = [(axis + 1) % 3, (axis + 2) % 3, axis]
        first, second, across = (edges[a] for a in order)
        flat = np.ptp(triangles[..., axis], axis=1) == 0
        plane = np.searchsorted(across, triangles[:, 0, axis])
        flat &= across[np.minimum(plane, len(across) - 1)] == triangles[:, 0, axis]
        size = (len(first) - 1, len(second) - 1, len(across))
        found = np.zeros((2, *size))
        _flat_areas(np.ascontiguousarray(triangles[flat][..., order]), plane[flat], first, second, found)
        back = [order.index(a) for a in range(3)]
        below.append(found[0].transpose(back))
        above.append(found[1].transpose(back))
    return (below[0], below[1], below[2]), (above[0], above[1], above[2])


@njit(cache=True)
def clip(polygon, count, axis, bound, above, out):
    """The part of a polygon (count corners) with coordinate `axis` above or below a bound. Returns its count."""
    kept = 0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        a, b = polygon[i, axis] - bound, polygon[j, axis] - bound
        if not above:
            a, b = -a, -b
        if a >= 0:
            for c in range(3):
                out[kept, c] = polygon[i, c]
            kept += 1
        if (a > 0 and b < 0) or (a < 0 and b > 0):
            t = a / (a - b)
            for c in range(3):
                out[kept, c] = polygon[i, c] + t * (polygon[j, c] - polygon[i, c])
            out[kept, axis] = bound
            kept += 1
    return kept


@njit(cache=True, inner=True)
def _cell_range(polygon, count, axis, edges, outward):
    """First and last cell along an axis that a polygon passes through; one in a plane of the grid is the body's."""
    low = high = polygon[0, axis]
    for i in range(1, count):
        low = min(low, polygon[i, axis])
        high = max(high, polygon[i, axis])
    last = len(edges) - 2
    if low == high:
        at = _place(edges, low, False)
        if at < len(edges) and edges[at] == low:
            first = at - 1 if outward > 0 else at
        else:
            first = at - 1
        first = min(max(first, 0), last)
        return first, first
    first = _place(edges, low, True) - 1
    final = _place(edges, high, False) - 1
    return min(max(first, 0), last), min(max(final, 0), last)


@njit(cache=True, inner=True)
def _place(edges, value, beyond):
    """np.searchsorted, to the right of equal ones if beyond: numba's takes longer to compile."""
    low, high = 0, len(edges)
    while low < high:
        middle = (low + high) // 2
        if edges[middle] < value or (beyond and edges[middle] == value):
            low = middle + 1
        else:
            high = middle
    return low


def cutting(visit):
    """A compiled function that cuts a polygon (count corners) by the grid and calls visit(piece, count, i, j, k, kept)
    for each cell that it passes through. outward: (3,), which side of a polygon in a plane of the grid is not the
    body's. rooms: (4, M, 3), of the most corners M that a piece has."""

    @njit(inner=True, forceinline=True)
    def cut(polygon, count, outward, x, y, z, rooms, kept):
        in_x, in_y, piece, spare = rooms[0], rooms[1], rooms[2], rooms[3]
        i0, i1 = _cell_range(polygon, count, 0, x, outward[0])
        for i in range(i0, i1 + 1):
            n = _slab(polygon, count, 0, x, i, i0, i1, spare, in_x)
            if n < 3:
                continue
            j0, j1 = _cell_range(in_x, n, 1, y, outward[1])
            for j in range(j0, j1 + 1):
                m = _slab(in_x, n, 1, y, j, j0, j1, spare, in_y)
                if m < 3:
                    continue
                k0, k1 = _cell_range(in_y, m, 2, z, outward[2])
                for k in range(k0, k1 + 1):
                    visit(piece, _slab(in_y, m, 2, z, k, k0, k1, spare, piece), i, j, k, kept)

    return cut


@njit(cache=True)
def _slab(polygon, count, axis, edges, cell, first, final, room, out):
    """The part of a polygon in one cell's slab, between the first and the final that it passes through."""
    if first == final:
        for i in range(count):
            for c in range(3):
                out[i, c] = polygon[i, c]
        return count
    if cell == first:
        return clip(polygon, count, axis, edges[cell + 1], False, out)
    if cell == final:
        return clip(polygon, count, axis, edges[cell], True, out)
    kept = clip(polygon, count, axis, edges[cell], True, room)
    return clip(room, kept, axis, edges[cell + 1], False, out)


@njit(cache=True, inner=True)
def _add(polygon, count, i, j, k, kept):
    """Area vector of a polygon and the moment of its first component along the first axis."""
    walls, moments = kept
    wall = walls[i, j, k]
    for t in range(1, count - 1):
        for c in range(3):
            d, e = (c + 1) % 3, (c + 2) % 3
            part = 0.5 * (
                (polygon[t, d] - polygon[0, d]) * (polygon[t + 1, e] - polygon[0, e])
                - (polygon[t, e] - polygon[0, e]) * (polygon[t + 1, d] - polygon[0, d])
            )
            wall[c] += part
            if c == 0:
                moments[i, j, k] += part * (polygon[0, 0] + polygon[t, 0] + polygon[t + 1, 0]) / 3


@njit(cache=True, inner=True)
def _add_flat(polygon, count, i, j, k, kept):
    found, plane = kept
    area = 0.0
    for t in range(1, count - 1):
        area += 0.5 * (
            (polygon[t, 0] - polygon[0, 0]) * (polygon[t + 1, 1] - polygon[0, 1])
            - (polygon[t, 1] - polygon[0, 1]) * (polygon[t + 1, 0] - polygon[0, 0])
        )
    found[0 if area > 0 else 1, i, j, plane] += abs(area)


_CUT_AND_ADD, _CUT_AND_ADD_FLAT = cutting(_add), cutting(_add_flat)


@njit(cache=True, short_loops=True)
def _accumulate(triangles, x, y, z, walls, moments):
    rooms, normal = np.zeros((4, _MOST_CORNERS, 3)), np.zeros(3)
    for f in range(len(triangles)):
        corners = triangles[f]
        for c in range(3):
            d, e = (c + 1) % 3, (c + 2) % 3
            normal[c] = (corners[1, d] - corners[0, d]) * (corners[2, e] - corners[0, e]) - (
                corners[1, e] - corners[0, e]
            ) * (corners[2, d] - corners[0, d])
        _CUT_AND_ADD(corners, 3, normal, x, y, z, rooms, (walls, moments))


@njit(cache=True, short_loops=True)
def _flat_areas(triangles, plane, first, second, found):
    """Adds the areas of triangles across the third axis to the faces (I, J) of their planes, body below or above."""
    rooms, outward, everywhere = np.zeros((4, _MOST_CORNERS, 3)), np.zeros(3), np.array([-np.inf, np.inf])
    for f in range(len(triangles)):
        _CUT_AND_ADD_FLAT(triangles[f], 3, outward, first, second, everywhere, rooms, (found, plane[f]))
