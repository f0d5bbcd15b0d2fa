"""A solid on a tensor grid fine at its touched patches: heat capacities of cells, conductances between neighbours.

Finite volumes with cut cells: nodes in the middle of whole cells, volumes and open areas of faces exact. A field that
is linear along the walls, or whose gradient is the heat flux that a wall is given, is met exactly wherever the walls
cut the cells, so sheets thinner than a cell conduct as they should (cut-cell method: Johansen & Colella, J. Comput.
Phys. 147, 1998, without its second-order flux correction, which would cost the symmetry).

N: cells that hold material.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from thermograsp.errors import MeshError

from ..numerics import graded_cells
from ..surfaces import Edges, Solid, SurfacePatch, cut_mesh, in_planes, net_volumes
from .place import ALONG, PlacedPatch

_SNAP = 1e-6  # m, from a plane of the grid within which a vertex is in it
_EMPTY = 1e-7  # of a cell, less than which is nothing
_LEAST_PLANE = 0.02  # of the surface, in one plane across an axis, for which the grid has a plane there
_FLAT = 20e-6  # m that the surface of a patch may rise or fall and be flat to the grid
_CRUMB = 1e-3  # of the solid's volume, less than which a piece of its own is left out


_FIRST_NODE = 8**-0.5
"""Distance of the first node from a wall over that between nodes: the impedance of a uniform grid is then of fourth
order in the length of its cells, where 1/2 makes it err by (length/penetration)^2/8 and 0 by as much the other way."""


@dataclass(frozen=True, slots=True)
class MeshGridding:
    """How fine a grid is. depth: m, first cell under a patch. side: m, cells at a patch's edge. growth:
    length of a cell per distance from there. largest: m, longest cell. slanted: m, cells at a patch of which one side
    is along the grid's axes. oblique: m, at one of which none is. relief: cells between the middle of a patch that is
    not flat and its lowest or highest place."""

    depth: float = 20e-6
    side: float = 0.05e-3
    growth: float = 0.5
    largest: float = 4e-3
    slanted: float = 0.2e-3
    oblique: float = 0.4e-3
    relief: int = 12


@dataclass(frozen=True, slots=True)
class GridAxis:
    """One axis of a tensor grid. edges: (n + 1,) m, cell boundaries. nodes: (n,) m, where each cell's temperature
    is."""

    edges: np.ndarray
    nodes: np.ndarray


@dataclass(frozen=True, slots=True)
class MeshGrid:
    """Cells and links of a solid. frame: (3, 3) rows are the directions of the axes. index: (I, J, K) number of each
    cell among those with material, -1 for others. capacity: (N,) J/K. neighbours: (N, 6) of -x, +x, -y, +y, -z, +z, -1
    for none, and links: (N, 6) W/K to them. conductivity: (N, 3) W/(m K) along the axes. volume: (N,) m3."""

    frame: np.ndarray
    axes: tuple[GridAxis, GridAxis, GridAxis]
    index: np.ndarray
    capacity: np.ndarray
    neighbours: np.ndarray
    links: np.ndarray
    conductivity: np.ndarray
    volume: np.ndarray

    @property
    def edges(self) -> Edges:
        """m, cell boundaries along the axes."""
        x, y, z = self.axes
        return x.edges, y.edges, z.edges

    @property
    def nodes(self) -> np.ndarray:
        """(N, 3) m in the grid's frame."""
        x, y, z = (axis.nodes for axis in self.axes)
        i, j, k = np.nonzero(self.index >= 0)
        return np.stack((x[i], y[j], z[k]), axis=1)


def grid_frame(solid: Solid, patches: Sequence[SurfacePatch]) -> np.ndarray:
    """(3, 3) axes as rows: the last along the last patch's normal, the first along most of the surface's sides."""
    up = patches[-1].direction
    helper = np.eye(3)[np.argmin(np.abs(up))]
    first = np.cross(helper, up)
    first /= np.linalg.norm(first)
    second = np.cross(up, first)
    areas = np.concatenate([part.area_vectors for part in solid.parts])
    # The mean of four times the angle: sides at right angles to each other add up.
    along = areas @ first + 1j * (areas @ second)
    sides = np.abs(areas @ up) < 0.05 * np.linalg.norm(areas, axis=1)
    total = np.sum(along[sides] ** 4 / np.maximum(np.abs(along[sides]), 1e-300) ** 3)
    if np.abs(total) > 0.05 * np.abs(along).sum():
        angle = np.angle(total) / 4
        first, second = (
            np.cos(angle) * first + np.sin(angle) * second,
            np.cos(angle) * second - np.sin(angle) * first,
        )
    return np.stack((first, second, up))


def grid_axes(
    triangles: np.ndarray, patches: Sequence[PlacedPatch], layers: Sequence[float], gridding: MeshGridding
) -> tuple[GridAxis, GridAxis, GridAxis]:
    """The axes around triangles (F, 3, 3) m and fine at the patches, all in the grid's frame. layers: m, thickness of
    what lies on another material there, 0 for none."""
    corners = triangles.reshape(-1, 3)
    low, high = corners.min(axis=0), corners.max(axis=0)
    largest = max(gridding.largest, float((high - low).max()) / 40)
    axes = []
    for axis in range(3):
        fine: dict[float, float] = {}
        breaks = [low[axis], high[axis], *flat_places(triangles, axis)]
        for patch, layer in zip(patches, layers, strict=True):
            at = float(np.clip(patch.centre[axis], low[axis], high[axis]))
            if not patch.aligned and np.abs(patch.sides[:, axis]).max() < ALONG:
                places, length = _along_oblique(patch, axis, gridding)
            elif abs(patch.normal[axis]) > 0.5:
                breaks.append(at)
                fine[at] = gridding.depth
                places, length = _across_relief(patch, layer, gridding)
                places = np.sign(patch.normal[axis]) * places
            else:
                for end in (-patch.half_width, patch.half_width):
                    fine[float(np.clip(at + end, low[axis], high[axis]))] = gridding.side
                places, length = _along_relief(patch, axis, gridding)
            for place in np.clip(at + places, low[axis], high[axis]).tolist():
                fine[place] = min(length, fine.get(place, length))
        axes.append(_staggered(distinct(breaks), fine, gridding.growth, largest))
    return axes[0], axes[1], axes[2]


def _across_relief(patch: PlacedPatch, layer: float, gridding: MeshGridding) -> tuple[np.ndarray, float]:
    """Places m above a patch's centre where its surface goes up and down, and to the bottom of a layer there, and the
    cells' length."""
    below, above = patch.relief
    relief = max(patch.relief)
    if relief <= _FLAT:
        return np.zeros(0), gridding.depth
    step = 2 * relief / gridding.relief
    places = np.arange(-round((below + layer) / step), round(above / step) + 1)
    return step * places[places != 0], max(step / 2, gridding.depth)


def _along_relief(patch: PlacedPatch, axis: int, gridding: MeshGridding) -> tuple[np.ndarray, float]:
    """Places m from a patch's centre along one of its sides, so near that the surface goes up or down by no more than
    the length of the cells across it, and the cells' length."""
    relief = max(patch.relief)
    slope = patch.slopes[int(np.argmax(np.abs(patch.sides[:, axis])))]
    if min(relief, slope) <= _FLAT:
        return np.zeros(0), patch.half_width
    count = int(np.ceil(gridding.relief / 2 * slope / relief))
    return patch.half_width * np.arange(1 - count, count) / count, patch.half_width / (2 * count)


def _along_oblique(patch: PlacedPatch, axis: int, gridding: MeshGridding) -> tuple[np.ndarray, float]:
    """Places m from the centre of a patch that is not along the axes, as far as it reaches, and the cells' length."""
    slanted = np.abs(patch.sides).max() >= ALONG
    length = gridding.slanted if slanted else gridding.oblique
    reach = patch.half_width * np.abs(patch.sides[:, axis]).sum() + length
    reach += max(patch.relief) * abs(patch.normal[axis])
    return np.arange(-reach, reach + 1e-9, 2 * length), length


def _staggered(breaks: np.ndarray, fine: dict[float, float], growth: float, largest: float) -> GridAxis:
    """Nodes and boundaries between them on one smooth map of their numbers: between them the errors that graded cells
    make with nodes in their middles, and the opposite ones with boundaries midway between nodes, cancel."""
    from scipy.interpolate import PchipInterpolator  # slow to import, and boxes do without it

    edges, nodes = [breaks[:1]], []
    for start, stop in zip(breaks[:-1], breaks[1:], strict=True):
        points = graded_cells([start, stop], fine, growth, largest)
        count = len(points) - 1
        place = PchipInterpolator(np.arange(count + 1), points) if count > 1 else None
        number = (np.arange(count) + _FIRST_NODE) * count / (count - 1 + 2 * _FIRST_NODE)
        if place is None:
            nodes.append(np.array([(start + stop) / 2]))
        else:
            nodes.append(place(number))
            edges.append(place((number[1:] + number[:-1]) / 2))
        edges.append(np.array([stop]))
    return GridAxis(np.concatenate(edges), np.concatenate(nodes))


def mesh_grid(solid: Solid, frame: np.ndarray, axes: tuple[GridAxis, GridAxis, GridAxis]) -> MeshGrid:
    """The solid on the grid. Raises MeshError where it is in separate pieces."""
    edges = (axes[0].edges, axes[1].edges, axes[2].edges)
    parts = [snapped(part.triangles @ frame.T, edges) for part in solid.parts]
    volumes, areas = zip(*(cut_mesh(part, edges) for part in parts), strict=True)
    outer = [n for n, host in enumerate(solid.hosts or (None,) * len(parts)) if host is None]
    joints = _joints([parts[n] for n in outer], edges)
    conductivities = [part.material.conductivity for part in solid.parts]
    capacities = [part.material.volumetric_heat_capacity for part in solid.parts]
    cell = np.multiply.outer(np.multiply.outer(*(np.diff(e) for e in edges[:2])), np.diff(edges[2]))
    shares = _visible(list(volumes), cell, solid.hosts)
    filled = np.sum(shares, axis=0)
    solid_cells = filled > _EMPTY * cell
    along = _conductivity(shares, list(areas), conductivities)
    index = np.where(solid_cells, np.cumsum(solid_cells).reshape(cell.shape) - 1, -1)
    count = int(solid_cells.sum())
    neighbours, links = np.full((count, 6), -1, np.int32), np.zeros((count, 6))
    for axis in range(3):
        lower = index[_cut(axis, slice(None, -1))]
        upper = index[_cut(axis, slice(1, None))]
        within = np.sum([areas[n][axis] for n in outer], axis=0) + joints[axis]
        open_area = np.minimum(within, _full(edges, axis))[_cut(axis, slice(1, -1))]
        joined = (lower >= 0) & (upper >= 0) & (open_area > 0)
        a, b = lower[joined], upper[joined]
        to_low, to_high = (
            np.broadcast_to(np.expand_dims(distance, [d for d in range(3) if d != axis]), cell.shape)[
                solid_cells
            ]
            / along[solid_cells, axis]
            for distance in (axes[axis].nodes - edges[axis][:-1], edges[axis][1:] - axes[axis].nodes)
        )
        link = open_area[joined] / (to_high[a] + to_low[b])
        neighbours[a, 2 * axis + 1], links[a, 2 * axis + 1] = b, link
        neighbours[b, 2 * axis], links[b, 2 * axis] = a, link
    held = [share[solid_cells] for share in shares]
    if solid.hosts is not None:  # corners that were moved into planes take up to 1e-5 of the volume along
        whole = net_volumes([np.array(part.volume) for part in solid.parts], solid.hosts)
        held = [s * max(float(v), 0.0) / s.sum() if s.any() else s for s, v in zip(held, whole, strict=True)]
    capacity = np.sum([c * s for c, s in zip(capacities, held, strict=True)], axis=0)
    grid = MeshGrid(frame, axes, index, capacity, neighbours, links, along[solid_cells], filled[solid_cells])
    return _one_piece(grid)


def _joints(parts: list[np.ndarray], edges: Edges) -> Edges:
    """m2 of each cell face in which surfaces of the body meet back to back, so that heat passes: each part's own open
    areas end there. parts: triangles (F, 3, 3) m of each."""
    if len(parts) == 1:
        return np.zeros(1), np.zeros(1), np.zeros(1)
    below, above = in_planes(np.concatenate(parts), edges)
    x, y, z = (np.minimum(*sides) for sides in zip(below, above, strict=True))
    return x, y, z


def snapped(triangles: np.ndarray, edges: Edges) -> np.ndarray:
    """Corners moved into planes of the grid that they nearly lie in."""
    moved = np.array(triangles)
    for axis, edge in enumerate(edges):
        value = moved[..., axis]
        nearest = np.clip(np.searchsorted(edge, value), 1, len(edge) - 1)
        nearest = np.where(value - edge[nearest - 1] < edge[nearest] - value, nearest - 1, nearest)
        moved[..., axis] = np.where(np.abs(value - edge[nearest]) < _SNAP, edge[nearest], value)
    return moved


def flat_places(triangles: np.ndarray, axis: int) -> list[float]:
    """m along an axis at which the surface has flat pieces across it, together _LEAST_PLANE of its area or more."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    areas = np.cross(b - a, c - a)
    size = np.linalg.norm(areas, axis=1)
    flat = np.ptp(triangles[..., axis], axis=1) < _SNAP
    where = np.round(triangles[flat, 0, axis] / (10 * _SNAP)).astype(np.int64)
    places, inverse = np.unique(where, return_inverse=True)
    weight = np.bincount(inverse, size[flat], len(places))
    first = np.zeros(len(places), int)
    first[inverse[::-1]] = np.arange(len(inverse))[::-1]
    return list(triangles[flat, 0, axis][first[weight > _LEAST_PLANE * size.sum()]])


def distinct(values: Sequence[float] | np.ndarray) -> np.ndarray:
    """Sorted values, of those closer than a few snaps only one; the ends stay."""
    ordered = np.sort(np.asarray(values, float))
    kept = [ordered[0]]
    for value in ordered[1:-1]:
        if value - kept[-1] > 4 * _SNAP and ordered[-1] - value > 4 * _SNAP:
            kept.append(value)
    return np.array([*kept, ordered[-1]])


def _visible(
    volumes: list[np.ndarray], cell: np.ndarray, within: tuple[int | None, ...] | None
) -> list[np.ndarray]:
    """Each part's volume in the cells less what later parts take of it, by the part that each lies in. Without that,
    parts that overlap anywhere are taken as overlapping as much as they can in a cell, others as side by side."""
    if within is not None:
        return [np.maximum(volume, 0.0) for volume in net_volumes(volumes, within)]
    shares = []
    for n, volume in enumerate(volumes):
        left = volume.copy()
        for later in volumes[n + 1 :]:
            if np.any(volume + later > (1 + 1e-6) * cell):
                left -= np.minimum(left, later)
        shares.append(np.maximum(left, 0.0))
    return shares


def _conductivity(
    shares: list[np.ndarray],
    areas: list[Edges],
    conductivities: list[float],
) -> np.ndarray:
    """(I, J, K, 3) W/(m K) along the axes: where materials share a cell, of a laminate across their boundary's normal
    (harmonic mean across, arithmetic along it; diagonal of the tensor)."""
    filled = np.maximum(sum(shares), 1e-300)
    along = sum(k * s for k, s in zip(conductivities, shares, strict=True)) / filled
    across = filled / np.maximum(sum(s / k for k, s in zip(conductivities, shares, strict=True)), 1e-300)
    mean = np.where(along > 0, along, conductivities[0])
    tensor = np.repeat(mean[..., None], 3, axis=-1)
    if len(set(conductivities)) == 1:
        return tensor
    normal = np.zeros_like(tensor)
    for share, area in zip(shares, areas, strict=True):
        mixed = (share > _EMPTY * filled) & (share < (1 - _EMPTY) * filled)
        for axis in range(3):  # the last part's wall in the cell decides
            normal[..., axis] = np.where(mixed, -np.diff(area[axis], axis=axis), normal[..., axis])
    square = np.sum(normal**2, axis=-1, keepdims=True)
    direction = np.where(square > 0, normal**2 / np.where(square > 0, square, 1.0), 1 / 3)
    return tensor - np.maximum(mean - across, 0.0)[..., None] * direction


def _one_piece(grid: MeshGrid) -> MeshGrid:
    """The grid without crumbs, which cells that a wall barely meets may leave."""
    count = len(grid.capacity)
    rows = np.repeat(np.arange(count), 6)
    columns = grid.neighbours.ravel()
    linked = columns >= 0
    pieces, piece = connected_components(
        coo_array((np.ones(linked.sum()), (rows[linked], columns[linked])), shape=(count, count)),
        directed=False,
    )
    if pieces == 1:
        return grid
    sizes = np.bincount(piece, grid.volume, pieces)
    main = int(np.argmax(sizes))
    others = np.flatnonzero(sizes > _CRUMB * sizes.sum())
    if len(others) > 1:
        raise MeshError(
            f"the object is in {len(others)} separate pieces of "
            f"{', '.join(f'{1e6 * size:.3g}' for size in sizes[others])} cm3: let them touch, or make them "
            "objects of their own"
        )
    kept = piece == main
    number = np.append(np.where(kept, np.cumsum(kept) - 1, -1), -1).astype(np.int32)
    return MeshGrid(
        grid.frame,
        grid.axes,
        number[grid.index],
        # what the crumbs held is shared out, so that the heat capacity stays the solid's
        grid.capacity[kept] * (grid.capacity.sum() / grid.capacity[kept].sum()),
        number[grid.neighbours[kept]],
        grid.links[kept],
        grid.conductivity[kept],
        grid.volume[kept],
    )


def _cut(axis: int, part: slice) -> tuple[slice, ...]:
    return tuple(part if a == axis else slice(None) for a in range(3))


def _full(edges: Edges, axis: int) -> np.ndarray:
    """m2 of the whole faces across an axis, one long along it."""
    return np.expand_dims(np.multiply.outer(*(np.diff(e) for a, e in enumerate(edges) if a != axis)), axis)
