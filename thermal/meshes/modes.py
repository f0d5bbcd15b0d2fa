"""A body's slow temperature fields, once per shape: modes of a uniform grid.

A body of one material has the modes of its shape, as if of 1 W/(m K) and 1 J/(m3 K): a material only scales time, by
its diffusivity, and temperatures, by its heat capacity. Several materials have modes of their own. The slowest are
found by Lanczos' method on the inverse (ARPACK, through SciPy).

N: cells, R: modes.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.sparse import coo_array, csc_array, diags_array
from scipy.sparse.linalg import LinearOperator, eigsh, splu

from thermograsp.files import cached_arrays

from ..matter import Material
from ..surfaces import Solid, SolidPart, checked
from .grid import GridAxis, MeshGrid, distinct, flat_places, mesh_grid
from .network import conducting_parts

_CELLS = 8000
_OVER = 1.1  # of them, at most
_MODES = 256
_ACCURACY = 1e-3  # relative, of the rates
_SHIFT = 0.1  # of about the slowest rate
_KEPT = 8  # shapes
_UNIT = Material("unit", 1.0, 1.0, 1.0)


@dataclass(frozen=True, slots=True, eq=False)
class BodyModes:
    """grid: in the object's frame. rates: (R,), the first 0. fields: (N, R) orthonormal over the body by its heat
    capacity. diffusivity: m2/s times which the rates are 1/s. capacity: J/(m3 K), by whose root fields are divided to
    be 1/sqrt(J/K). Both are 1 where the grid has the materials' own, and the material's where it is of the unit's."""

    grid: MeshGrid
    rates: np.ndarray
    fields: np.ndarray
    diffusivity: float
    capacity: float


def body_modes(body: Solid, *, cache: bool = True) -> BodyModes:
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
    grid, rates, fields = _modes(parts, cache)
    material = body.parts[0].material if alone else _UNIT
    return BodyModes(grid, rates, fields, material.diffusivity, material.volumetric_heat_capacity)


@lru_cache(maxsize=_KEPT)
def _modes(
    parts: tuple[tuple[bytes, bytes, float, float], ...], cache: bool
) -> tuple[MeshGrid, np.ndarray, np.ndarray]:
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
        rates, fields = _slowest(grid)
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
        }

    found = cached_arrays({"modes of": arrays, "cells": _CELLS, "modes": _MODES}, build, enabled=cache)
    x, y, z = (GridAxis(found[f"edges {k}"], found[f"nodes {k}"]) for k in range(3))
    grid = MeshGrid(axes=(x, y, z), **{name: found[name] for name in _ARRAYS})
    return grid, found["rates"], found["fields"]


_ARRAYS = "frame", "index", "capacity", "neighbours", "links", "conductivity", "volume"


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


def _slowest(grid: MeshGrid) -> tuple[np.ndarray, np.ndarray]:
    """Rates (R,) and fields (N, R)."""
    root = np.sqrt(grid.capacity)
    operator, count = _operator(grid), len(root)
    modes = min(_MODES, count - 1)
    width = max(np.ptp(edges) for edges in grid.edges)
    slow = float(np.min(grid.conductivity.min(axis=1) * grid.volume / grid.capacity)) * (np.pi / width) ** 2
    shifted = csc_array(operator + diags_array(np.full(count, _SHIFT * slow)))
    factors = splu(
        shifted, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
    rates, fields = eigsh(
        operator,
        k=modes,
        sigma=-_SHIFT * slow,
        OPinv=LinearOperator((count, count), factors.solve),
        ncv=min(count, modes + modes // 2),
        tol=_ACCURACY,  # pyright: ignore[reportArgumentType]  (any number)
        v0=np.random.default_rng(0).standard_normal(count),  # the same bits each time
    )
    order = np.argsort(rates)
    rates, fields = np.maximum(rates[order], 0.0), fields[:, order] / root[:, None]
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
