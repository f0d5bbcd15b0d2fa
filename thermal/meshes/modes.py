"""A body's slow temperature fields, once per shape: modes of a uniform grid.

A body of one material has the modes of its shape, as if of 1 W/(m K) and 1 J/(m3 K): a material only scales time, by
its diffusivity, and temperatures, by its heat capacity. Several materials have modes of their own, and so has a body
with contents behind a film: what fades while the contents are held at one temperature. The slowest are found by
Lanczos' method on the inverse.

N: cells, R: modes.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, csc_array, diags_array
from scipy.sparse.linalg import splu

from thermograsp.files import cached_arrays

from ..matter import Material
from ..network import ThermalNetwork
from ..numerics import largest_eigenvalues
from ..surfaces import Solid, SolidPart, checked
from .film import Film, film_rows
from .grid import GridAxis, MeshGrid, distinct, flat_places, mesh_grid
from .network import conducting_parts

_CELLS = 8000
_OVER = 1.1  # of them, at most
_MODES = 256
_ACCURACY = 1e-3  # relative, of the shifted rates' residuals
_SHIFT = 0.1  # of about the slowest rate
_EVEN = 1e-10  # of a mode's square, what is not even, at least
_KEPT = 8  # shapes
_UNIT = Material("unit", 1.0, 1.0, 1.0)


@dataclass(frozen=True, slots=True, eq=False)
class BodyModes:
    """grid: in the object's frame. rates: (R,), the first 0. fields: (N, R) orthonormal over the body by its heat
    capacity. diffusivity: m2/s times which the rates are 1/s. capacity: J/(m3 K), by whose root fields are divided to
    be 1/sqrt(J/K). Both are 1 where the grid has the materials' own, and the material's where it is of the unit's.
    sink: (N,) of each cell to the contents, as links are, with which the first rate is not 0; zeros without."""

    grid: MeshGrid
    rates: np.ndarray
    fields: np.ndarray
    diffusivity: float
    capacity: float
    sink: np.ndarray

    def network(self, seen: np.ndarray, even: np.ndarray, film: float) -> ThermalNetwork:
        """Of the first of them. seen: (M, K) of these by ports, and even (M,) of 1 K everywhere. film: W/K to contents,
        which in the network are no longer held: one temperature is a state, and the modes join them by film_rows'
        outputs."""
        still = np.sqrt(self.capacity * self.grid.capacity.sum())
        states = _states(self, seen.shape[1], film)
        row = np.eye(len(states.rates))[0]
        level = even[None] / still
        return ThermalNetwork(
            self.diffusivity * states.rates,
            np.concatenate((level, states.turn.T @ (seen - level.T * states.share).T)),
            np.zeros((len(seen), len(seen))),
            {"heat": still * row, "mean": row / still} | states.wet,
        )


class _States(NamedTuple):
    """rates: (J,), of one temperature and of what fades. turn: (K, J - 1), these from modes less the share (K,) of each
    that is even. wet: the film's outputs."""

    rates: np.ndarray
    turn: np.ndarray
    share: np.ndarray
    wet: dict[str, np.ndarray]


@lru_cache(maxsize=_KEPT)
def _states(modes: BodyModes, count: int, film: float) -> _States:
    if film == 0:
        return _States(modes.rates[:count], np.eye(count)[:, 1:], np.zeros(count), {})
    fields, sink = modes.fields[:, :count], modes.sink
    even = np.full(len(fields), modes.grid.capacity.sum() ** -0.5)
    share = fields.T @ (modes.grid.capacity * even)
    # what is not even: one less where it is all that a mode is
    sizes, vectors = np.linalg.eigh(np.eye(count) - np.outer(share, share))
    turn = vectors[:, sizes > _EVEN] / np.sqrt(sizes[sizes > _EVEN])
    split = np.diag(modes.rates[:count]) - fields.T @ (sink[:, None] * fields)
    rates, eigenvectors = np.linalg.eigh(turn.T @ split @ turn)
    turn = turn @ eigenvectors
    felt = np.column_stack((even, (fields - np.outer(even, share)) @ turn)) / np.sqrt(modes.capacity)
    wet = film_rows(sink, felt, film / (modes.diffusivity * modes.capacity))
    return _States(np.append(0.0, np.maximum(rates, 0.0)), turn, share, wet)


@lru_cache(maxsize=_KEPT)
def body_modes(body: Solid, film: Film | None = None, *, cache: bool = True) -> BodyModes:
    """The body's modes. cache: keep them on disk, by content. Raises MeshError where it crosses itself, is in pieces or
    metres long."""
    alone = len(body.parts) == 1
    parts = tuple(
        (
            np.ascontiguousarray(vertices, float).tobytes(),
            np.ascontiguousarray(faces, np.int64).tobytes(),
            1.0 if alone else conductivity,
            1.0 if alone else capacity,
        )
        for vertices, faces, conductivity, capacity in conducting_parts(body)
    )
    material = body.parts[0].material if alone else _UNIT
    if film is not None:
        film = film._replace(conductance=film.conductance / material.conductivity)
    grid, rates, fields, sink = _modes(parts, film, cache)
    return BodyModes(grid, rates, fields, material.diffusivity, material.volumetric_heat_capacity, sink)


@lru_cache(maxsize=_KEPT)
def _modes(
    parts: tuple[tuple[bytes, bytes, float, float], ...], film: Film | None, cache: bool
) -> tuple[MeshGrid, np.ndarray, np.ndarray, np.ndarray]:
    arrays = [
        (np.frombuffer(vertices).reshape(-1, 3), np.frombuffer(faces, np.int64).reshape(-1, 3), *others)
        for vertices, faces, *others in parts
    ]

    def build() -> dict[str, np.ndarray]:
        body = Solid(
            tuple(
                SolidPart(vertices, faces, Material("part", conductivity, 1.0, capacity))
                for vertices, faces, conductivity, capacity in arrays
            )
        )
        grid = _uniform(checked(body))
        grid, sink = (grid, np.zeros(len(grid.capacity))) if film is None else _joined(grid, film, body)
        rates, fields = _slowest(grid, sink)
        axes = {
            f"{name} {k}": getattr(axis, name)
            for k, axis in enumerate(grid.axes)
            for name in ("edges", "nodes")
        }
        return {
            **axes,
            **{name: getattr(grid, name) for name in _ARRAYS},
            "rates": rates,
            "fields": fields,
            "sink": sink,
        }

    wetted = None if film is None else (film.conductance, film.triangles)
    key = {"modes of": arrays, "film": wetted, "cells": _CELLS, "modes": _MODES}
    found = cached_arrays(key, build, enabled=cache)
    x, y, z = (GridAxis(found[f"edges {k}"], found[f"nodes {k}"]) for k in range(3))
    grid = MeshGrid(axes=(x, y, z), **{name: found[name] for name in _ARRAYS})
    return grid, found["rates"], found["fields"], found["sink"]


_ARRAYS = "frame", "index", "capacity", "neighbours", "links", "conductivity", "volume"


def _joined(grid: MeshGrid, film: Film, body: Solid) -> tuple[MeshGrid, np.ndarray]:
    """The grid with its links, and (N,) of each cell to the contents: through the cell and the film where a wall is as
    thick as cells are long. A thinner one lies in one cell here and in two there, whose links resist as much as its
    depth does, or more."""
    wall = sum(part.volume for part in body.parts) / film.area
    length = max(float(np.median(np.diff(edges))) for edges in grid.edges)
    return film.joined(grid, body.outside) if wall >= length else (grid, film.spread(grid))


def _uniform(body: Solid) -> MeshGrid:
    """About so many cells of nearly one length, with planes in the large flat pieces of the surface."""
    triangles = np.concatenate([part.triangles for part in body.parts])
    low, high = triangles.reshape(-1, 3).min(axis=0), triangles.reshape(-1, 3).max(axis=0)
    breaks = [distinct([low[k], high[k], *flat_places(triangles, k)]) for k in range(3)]
    length = (max(part.volume for part in body.parts) / _CELLS) ** (1 / 3)
    while True:
        x, y, z = (_axis(each, length) for each in breaks)
        grid = mesh_grid(body, np.eye(3), (x, y, z))
        over = len(grid.capacity) / _CELLS
        if over < _OVER:
            return grid
        length *= over**0.4


def _axis(breaks: np.ndarray, length: float) -> GridAxis:
    counts = np.maximum(1, np.ceil(np.diff(breaks) / length - 1e-9).astype(int))
    runs = [np.linspace(a, b, n + 1)[:-1] for a, b, n in zip(breaks[:-1], breaks[1:], counts, strict=True)]
    edges = np.append(np.concatenate(runs), breaks[-1])
    return GridAxis(edges, (edges[1:] + edges[:-1]) / 2)


def _slowest(grid: MeshGrid, sink: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rates (R,) and fields (N, R)."""
    root = np.sqrt(grid.capacity)
    operator, count = csc_array(_operator(grid) + diags_array(sink / grid.capacity)), len(root)
    modes = min(_MODES, count - 1)
    width = max(np.ptp(edges) for edges in grid.edges)
    slow = float(np.min(grid.conductivity.min(axis=1) * grid.volume / grid.capacity)) * (np.pi / width) ** 2
    shifted = csc_array(operator + diags_array(np.full(count, _SHIFT * slow)))
    factors = splu(
        shifted, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
    inverse, fields = largest_eigenvalues(factors.solve, count, modes, _ACCURACY)
    rates, fields = np.maximum(1 / inverse - _SHIFT * slow, 0.0), fields / root[:, None]
    if not sink.any():
        rates[0], fields[:, 0] = 0.0, 1 / np.sqrt(grid.capacity.sum())  # all at one temperature does not fade
    return rates, fields


def _operator(grid: MeshGrid) -> csc_array:
    """(N, N) symmetric: conduction by the roots of the capacities."""
    count, inverse = len(grid.capacity), diags_array(1 / np.sqrt(grid.capacity))
    joined = grid.neighbours.ravel() >= 0
    rows = np.repeat(np.arange(count), 6)[joined]
    between = coo_array(
        (-grid.links.ravel()[joined], (rows, grid.neighbours.ravel()[joined])), shape=(count, count)
    )
    return csc_array(inverse @ (between + diags_array(grid.links.sum(axis=1))) @ inverse)
