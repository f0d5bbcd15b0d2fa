"""A film between a body's walls and the contents of its hollow.

N: cells, F: triangles.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..network import ThermalNetwork
from ..surfaces import Solid, enclosed, wetted_faces
from .grid import MeshGrid, snapped

_LEAST = 1e-9  # singular values below that share of the largest are left out
_ALONE = 1e-3  # of a wall's area in a cell, that others may add there
_LEAST_FILM = 0.2  # of the film's resistance, that is left where a wall lies before its cell's node
_ACROSS = 0.3  # cosine of an axis to a wall's normal, from which on a node is moved to the wall along it
_STRETCHED = 0.2, 4.0  # of a link's resistance, that is left at least, and at most, where nodes are moved


class Film(NamedTuple):
    """conductance: W/K in all, even over the walls. walls: (F, 3, 3) float64 m, the triangles that are wet, as bytes,
    so that a film is a key."""

    conductance: float
    walls: bytes

    @property
    def triangles(self) -> np.ndarray:
        """(F, 3, 3) m."""
        return np.frombuffer(self.walls).reshape(-1, 3, 3)

    @property
    def area(self) -> float:
        """m2 of the walls."""
        a, b, c = self.triangles.transpose(1, 0, 2)
        return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)

    def spread(self, grid: MeshGrid) -> np.ndarray:
        """(N,) W/K of each cell's share, by the area of its wall, through the film alone."""
        return self._shared(_cut(grid, self.triangles))

    def joined(self, grid: MeshGrid, outside: np.ndarray) -> tuple[MeshGrid, np.ndarray]:
        """A grid that is fine or as coarse as the wall is thick, with its links, and (N,) W/K of each of its cells to
        the contents: from its node to the wall, and through the film. outside: (F, 3, 3) m, the body's surface. Where a
        wall alone cuts a cell, the share that is left of it tells how far from the node that wall is; elsewhere half of
        what is left lies between. What a node that lies beyond its wall has too much of the way is left out of the
        film's resistance; as far as that is less, the node is moved along the axes, so that the links to the next ones
        are as long as the way is in the body."""
        vectors = _cut(grid, self.triangles)
        through = self._shared(vectors)
        wet = np.flatnonzero((vectors**2).sum(axis=1) > 0)
        whole, held = _cut(grid, outside)[wet], vectors[wet]
        areas = np.linalg.norm(held, axis=1)
        at = np.nonzero(grid.index >= 0)
        lengths = np.stack([np.diff(axis.edges)[n] for axis, n in zip(grid.axes, at, strict=True)], axis=1)
        nodes = np.stack(
            [(axis.nodes - axis.edges[:-1])[n] for axis, n in zip(grid.axes, at, strict=True)], axis=1
        )
        normal = held / areas[:, None]
        filled = (grid.volume[wet] / lengths[wet].prod(axis=1))[:, None] * lengths[wet]
        beyond = np.where(normal > 0, filled - nodes[wet], filled - lengths[wet] + nodes[wet])
        alone = np.linalg.norm(whole - held, axis=1) < _ALONE * areas
        way = np.where(alone, (np.abs(normal) * beyond).sum(axis=1), grid.volume[wet] / (2 * areas))
        across = areas * (grid.conductivity[wet] * normal**2).sum(axis=1)
        least = np.maximum(way, (_LEAST_FILM - 1) * across / through[wet])
        through[wet] = 1 / (1 / through[wet] + least / across)
        moved = np.zeros(nodes.shape)
        moved[wet] = (way - least)[:, None] / np.where(np.abs(normal) > _ACROSS, normal, np.inf)
        return replace(grid, links=_moved(grid, nodes, lengths - nodes, moved)), through

    def _shared(self, vectors: np.ndarray) -> np.ndarray:
        """(N,) W/K of walls with area vectors (N, 3)."""
        areas = np.linalg.norm(vectors, axis=1)
        return self.conductance * areas / areas.sum()


def _cut(grid: MeshGrid, triangles: np.ndarray) -> np.ndarray:
    """(N, 3) m2, area vectors of triangles (F, 3, 3) m in each cell."""
    faces = enclosed(snapped(triangles @ grid.frame.T, grid.edges), grid.edges)[1]
    held = grid.index >= 0
    vectors = np.zeros((len(grid.capacity), 3))
    vectors[grid.index[held]] = faces[held]
    return vectors


def _moved(grid: MeshGrid, below: np.ndarray, above: np.ndarray, moved: np.ndarray) -> np.ndarray:
    """(N, 6) W/K of the links where nodes are moved by (N, 3) m along the axes. below, above: (N, 3) m from each node
    to its cell's faces."""
    factors = np.ones(grid.links.shape)
    for axis in range(3):
        low = np.flatnonzero(grid.neighbours[:, 2 * axis + 1] >= 0)
        high, along = grid.neighbours[low, 2 * axis + 1], grid.conductivity[:, axis]
        resistance = above[low, axis] / along[low] + below[high, axis] / along[high]
        more = moved[high, axis] / along[high] - moved[low, axis] / along[low]
        stretched = np.clip(1 + more / resistance, *_STRETCHED)
        factors[low, 2 * axis + 1], factors[high, 2 * axis] = stretched, stretched
    return grid.links / factors


def film_rows(sink: np.ndarray, fields: np.ndarray, film: float) -> dict[str, np.ndarray]:
    """Outputs of states with fields (N, K): "wet", the walls' mean temperature, and "film:0" ..., of which the sum of
    squares times the film is what flows through it by a unit of driving temperature. sink (N,), film: in one unit."""
    cells = np.flatnonzero(sink)
    wetted, fields = sink[cells], fields[cells]
    _, sizes, vectors = np.linalg.svd(np.sqrt(wetted / film)[:, None] * fields, full_matrices=False)
    kept = sizes > _LEAST * sizes[0]
    rows = sizes[kept, None] * vectors[kept]
    return {"wet": wetted @ fields / wetted.sum()} | {f"film:{n}": row for n, row in enumerate(rows)}


def held_apart(network: ThermalNetwork, film: float) -> tuple[np.ndarray, np.ndarray]:
    """1/s (K,) at which a network's states fade while its contents are held at one temperature, and the matrix (K, K)
    to its own states from these. film: W/K."""
    wet = np.stack([row for name, row in network.outputs.items() if name.startswith("film:")])
    rates, turn = np.linalg.eigh(np.diag(network.rates) + film * wet.T @ wet)
    return np.maximum(rates, 0.0), turn


@lru_cache(maxsize=16)
def film_of(body: Solid, conductance: float) -> Film | None:
    """That of W/K in all between a body and its contents; None where there is no hollow, or nothing flows."""
    walls = wetted_faces(body) if conductance > 0 else np.zeros((0, 3, 3))
    return Film(conductance, np.ascontiguousarray(walls, float).tobytes()) if len(walls) else None


def wetted_area(body: Solid) -> float:
    """m2 of the walls of its hollow; 0 where there is none."""
    film = film_of(body, 1.0)
    return 0.0 if film is None else film.area
