"""A touched patch on a solid's surface: patterns of heat flux over it, and which cells of the grid its heat enters."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermograsp.compiled import njit
from thermograsp.errors import MeshError

from ..network import SHIFTS, patch_modes
from ..plates import Geometry, SquarePatch, sample_bodies
from ..surfaces import FACING, crossed_above, cutting, twice_areas
from .grid import MeshGrid, snapped
from .place import ABOVE, CORNERS, PlacedPatch, within_cube


@dataclass(frozen=True, slots=True, eq=False)
class PatchPatterns:
    """Patterns of heat flux over a square patch, by their integrals. edges: (T + 1,) 0 .. 1, strips along a half side
    of 1. sums: (T + 1, T + 1, M), each pattern's integral from the middle to the strips' corners, of a quarter that is
    mirrored to the other three. Over the patch a pattern's mean square is 1 and the first one is 1 everywhere."""

    edges: np.ndarray
    sums: np.ndarray

    @property
    def count(self) -> int:
        """M."""
        return self.sums.shape[2]

    def means(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """(n, M) over rectangles with corners low and high (n, 2), in half sides from the middle."""
        corners = np.stack((low, high))
        total = np.zeros((len(low), self.count))
        for i, j in np.ndindex(2, 2):
            total += (1 if i == j else -1) * self._integral(corners[i, :, 0], corners[j, :, 1])
        return total / np.prod(high - low, axis=1)[:, None]

    def _integral(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """(n, M) from the middle to (u, v), counted as the coordinates' signs are."""
        strips = len(self.edges) - 2
        i, a = self._within(np.abs(u), strips)
        j, b = self._within(np.abs(v), strips)
        s = self.sums
        amount = (
            s[i, j] * ((1 - a) * (1 - b))[:, None]
            + s[i + 1, j] * (a * (1 - b))[:, None]
            + s[i, j + 1] * ((1 - a) * b)[:, None]
            + s[i + 1, j + 1] * (a * b)[:, None]
        )
        return np.sign(u * v)[:, None] * amount

    def _within(self, x: np.ndarray, last: int) -> tuple[np.ndarray, np.ndarray]:
        """Strip and the share of it at x (n,)."""
        strip = np.clip(np.searchsorted(self.edges, x, side="right") - 1, 0, last)
        return strip, (x - self.edges[strip]) / np.diff(self.edges)[strip]


def uniform_pattern() -> PatchPatterns:
    """The uniform one alone."""
    ends = np.array([0.0, 1.0])
    return PatchPatterns(ends, np.outer(ends, ends)[:, :, None])


def learned_patterns(geometry: Geometry, count: int) -> PatchPatterns:
    """The patterns that `count` modes of a geometry's square contact are; see modes.py."""
    patch = geometry.patch
    assert isinstance(patch, SquarePatch)
    modes = patch_modes(geometry, sample_bodies(geometry, SHIFTS), SHIFTS, count)
    edges = patch.edges / patch.half_width
    # of the patterns along one axis, whose mean square over the half side is 1
    integrals = patch.shapes * np.sqrt(np.diff(edges))[:, None]
    sums = np.concatenate((np.zeros((1, integrals.shape[1])), np.cumsum(integrals, axis=0)))
    products = (patch.symmetrize @ modes).reshape(sums.shape[1], sums.shape[1], count)
    return PatchPatterns(edges, np.einsum("ta,abm,ub->tum", sums, products, sums, optimize=True))


@dataclass(frozen=True, slots=True)
class PatchOnGrid:
    """A touched patch as the cells of a grid feel it. shares: (N, M) how each pattern's heat flow is spread over the
    cells, the uniform one's in all 1; also how the cells' temperatures count in the pattern's. skin: (M, M) K/W from
    the cells' nodes to the surface. area: m2 of surface touched, seen along the normal."""

    shares: np.ndarray
    skin: np.ndarray
    area: float


def patch_on_grid(
    grid: MeshGrid, triangles: np.ndarray, patch: PlacedPatch, patterns: PatchPatterns
) -> PatchOnGrid:
    """The patch's cells. triangles: (F, 3, 3) m in the grid's frame. Surface within half a side above and below the
    centre is touched, where it faces the patch's way and nothing of the object lies above it within a side: the wall of
    a hollow that is as wide can be touched from within."""
    axes = np.stack((*patch.sides, patch.normal))
    half = patch.half_width
    areas = twice_areas(triangles)
    facing = areas @ patch.normal > FACING * np.linalg.norm(areas, axis=1)
    local = (triangles[facing] - patch.centre) @ axes.T
    near = np.all((local.min(axis=1) <= half) & (local.max(axis=1) >= -half), axis=1)
    corners, counts = within_cube(np.ascontiguousarray(local[near]), half)
    corners = np.ascontiguousarray(snapped(corners @ axes + patch.centre, grid.edges))
    room = 4096
    while True:
        cells, areas, middles, spans = _pieces(corners, counts, axes, *grid.edges, room)
        if len(cells) < room:
            break
        room *= 4
    cells = grid.index.ravel()[cells]
    around = (triangles - patch.centre) @ axes.T
    over = np.all((around.min(axis=1) <= [half, half, 2 * half]) & (around.max(axis=1) >= -half), axis=1)
    above = crossed_above((middles - patch.centre) @ axes.T, np.ascontiguousarray(around[over]), ABOVE)
    touched = (cells >= 0) & ~above.any(axis=1)
    cells, areas, middles, spans = cells[touched], areas[touched], middles[touched], spans[touched]
    total = float(areas.sum())
    if not total > 0:
        raise MeshError(
            f"the patch {2e3 * half:.3g} mm wide meets no surface at its place: it may lie beyond an edge"
        )
    weights = areas / total
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


@njit(cache=True, inner=True)
def _note(polygon, count, i, j, k, kept):
    """Writes down a piece, as long as there is room."""
    axes, along_y, along_z, cells, areas, middles, spans, found = kept
    n = found[0]
    area = _projected_area(polygon, count, axes[2], middles[n])
    if area > 1e-20 and n < len(cells) - 1:
        cells[n] = (i * along_y + j) * along_z + k
        areas[n] = area
        _span(polygon, count, axes, spans[n])
        found[0] += 1


@njit(cache=True, inner=True)
def _span(polygon, count, axes, span):
    """From where to where (2, 2) a polygon reaches along the first two axes."""
    for side in range(2):
        span[side, 0], span[side, 1] = np.inf, -np.inf
        for i in range(count):
            at = 0.0
            for c in range(3):
                at += polygon[i, c] * axes[side, c]
            span[side, 0], span[side, 1] = min(span[side, 0], at), max(span[side, 1], at)


@njit(cache=True, inner=True)
def _projected_area(polygon, count, normal, middle):
    """Area m2 of a polygon seen along a normal; its middle is filled in."""
    total = 0.0
    for c in range(3):
        middle[c] = 0.0
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
        for c in range(3):
            middle[c] /= total
    return total


_CUT_AND_NOTE = cutting(_note)


@njit(cache=True, short_loops=True)
def _pieces(corners, counts, axes, x, y, z, room):
    """The polygons' pieces in the cells, at most `room`: cells (n,) in the order of memory, areas (n,) seen along the
    last of the axes, middles (n, 3), and spans (n, 2, 2) from where to where along the first two."""
    cells, areas, found = np.zeros(room, np.int64), np.zeros(room), np.zeros(1, np.int64)
    middles, spans = np.zeros((room, 3)), np.zeros((room, 2, 2))
    kept = axes, len(y) - 1, len(z) - 1, cells, areas, middles, spans, found
    rooms, start = np.zeros((4, CORNERS, 3)), 0
    for polygon in range(len(counts)):
        count = counts[polygon]
        if count >= 3:
            _CUT_AND_NOTE(corners[start : start + count], count, axes[2], x, y, z, rooms, kept)
        start += count
    n = found[0] if found[0] < room - 1 else room
    return cells[:n], areas[:n], middles[:n], spans[:n]
