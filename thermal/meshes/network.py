"""The thermal network of an object of any shape, seen through the patches where it is touched.

The object is a grid (grid.py). Its temperatures under heat flow into each patch, at shifts over the moments from a
millisecond to minutes, span the states (rational Krylov: Grimme 1997; Galerkin, so an error of a field enters the
impedance squared and any span is passive). The object's mean temperature is a state of its own of rate 0 and the only
one that holds heat.

N: cells, M: ports, P: patches, K: states.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import block_diag, eigh

from thermograsp.errors import InvalidValueError
from thermograsp.files import cached_arrays

from ..network import ThermalNetwork
from ..surfaces import (
    Solid,
    SurfacePatch,
    checked,
    surface_patches,
)
from .film import Film
from .grid import (
    MeshGrid,
    MeshGridding,
    grid_axes,
    grid_frame,
    mesh_grid,
)
from .patch import PatchOnGrid, PatchPatterns, patch_on_grid, uniform_pattern
from .place import layer_beneath, place_patch
from .solve import conduct, solve_shifted

_SHIFTS = np.geomspace(4000, 1 / 400, 10)  # 1/s: moments from under a millisecond to minutes
_SETTLED = 1e-3  # of the heat flow, left over when a field is good enough to span a state
_RANK = 1e-10  # relative size of Gram eigenvalues that round-off has not spoiled


def body_network(
    body: Solid,
    patches: Sequence[SurfacePatch],
    *,
    patterns: PatchPatterns | None = None,
    points: Sequence[Sequence[float]] = (),
    gridding: MeshGridding | None = None,
    cache: bool = True,
) -> ThermalNetwork:
    """The object's network with one port per patch, in the patches' order: heat flow W into the object, spread evenly
    over the patch; mean temperature K of the patch above the object's first. With patterns each patch has one port a
    pattern, the uniform one first.

    A patch is a square of SurfacePatch.area round its centre, projected on the surface along its normal; where the
    surface ends within it, heat flows through what is there. The grid is aligned with the last patch's normal and
    with the object's sides; it resolves a patch whose normal is along one of its axes to about 0.3 % of its impedance
    from 0.05 s on, any other more coarsely (glass: 5 % in 0.05 s, 1 % in 0.2 s), so the patch that matters comes last.
    points: (Q, 3) m in the object's frame, where the object's own temperature is an output, such as where it may be
    touched next.
    Outputs: "heat" (J that the object has gained, exact: only the state of rate 0 holds any), "mean" (K, its mean
    temperature, by heat), "point:0" ... "point:Q-1" (K at the points, of the nearest cell with material). The direct
    term is 0.
    cache: keep it on disk, by content.

    Raises MeshError where a patch does not meet the surface, or the object is in pieces, crosses itself or is metres
    long, and InvalidValueError for values that make no sense.
    """
    patches = surface_patches(patches)
    where = np.asarray(points, float).reshape(-1, 3)
    if not np.isfinite(where).all():
        raise InvalidValueError("points must be finite, m in the object's frame")
    gridding = gridding or MeshGridding()
    patterns = patterns or uniform_pattern()

    def build() -> dict[str, np.ndarray]:
        frame = grid_frame(checked(body), patches)
        grid, placed = _gridded(body, patches, frame, gridding, patterns)
        rates, ports, basis = _reduced(grid, placed)
        points = basis[_nearest(grid, where @ frame.T)]
        return {"rates": rates, "ports": ports, "capacity": grid.capacity.sum(), "points": points}

    arrays = cached_arrays(_key(body, patches, patterns, where, gridding), build, enabled=cache)
    rates, capacity = arrays["rates"], float(arrays["capacity"])
    still = np.eye(len(rates))[0]
    outputs = {"heat": np.sqrt(capacity) * still, "mean": still / np.sqrt(capacity)}
    outputs |= {f"point:{n}": row for n, row in enumerate(arrays["points"])}
    count = arrays["ports"].shape[1]
    return ThermalNetwork(rates, arrays["ports"], np.zeros((count, count)), outputs)


@dataclass(frozen=True, slots=True, eq=False)
class PatchFields:
    """What flows through patches leaves of fields on a grid that is fine there. grid: aligned with the last patch,
    without its links. rates: (K,) 1/s, the first 0. ports: (K, P M) sqrt(K/J). fields: (N, K) of the states, of single
    precision."""

    grid: MeshGrid
    rates: np.ndarray
    ports: np.ndarray
    fields: np.ndarray

    def seen(self, body: Solid, patch: SurfacePatch, patterns: PatchPatterns) -> np.ndarray:
        """(K, M) sqrt(K/J) of the states by another patch. Raises MeshError where it meets no surface."""
        outside = body.outside @ self.grid.frame.T
        placed = place_patch(outside, patch, self.grid.frame)
        shares = patch_on_grid(self.grid, outside, placed, patterns).shares
        cells = np.flatnonzero(shares.any(axis=1))
        return self.fields[cells].T @ shares[cells]


def patch_fields(
    body: Solid,
    patches: Sequence[SurfacePatch],
    patterns: PatchPatterns,
    gridding: MeshGridding,
    film: Film | None = None,
) -> PatchFields:
    """As body_network's, with its states' fields. film: of contents that are held at one temperature, so that no state
    has rate 0. Raises as body_network does."""
    patches = surface_patches(patches)
    frame = grid_frame(checked(body), patches)
    grid, placed = _gridded(body, patches, frame, gridding, patterns)
    grid, sink = (grid, None) if film is None else film.joined(grid, body.outside)
    rates, ports, fields = _reduced(grid, placed, sink)
    cells = replace(grid, neighbours=grid.neighbours[:0], links=grid.links[:0])
    return PatchFields(cells, rates, ports, fields.astype(np.float32))


def _gridded(
    body: Solid,
    patches: tuple[SurfacePatch, ...],
    frame: np.ndarray,
    gridding: MeshGridding,
    patterns: PatchPatterns,
) -> tuple[MeshGrid, list[PatchOnGrid]]:
    triangles = np.concatenate([part.triangles for part in body.parts]) @ frame.T
    outside = body.outside @ frame.T
    placed = [place_patch(outside, patch, frame) for patch in patches]
    axes = grid_axes(triangles, placed, [layer_beneath(triangles, patch) for patch in placed], gridding)
    grid = mesh_grid(body, frame, axes)
    return grid, [patch_on_grid(grid, outside, patch, patterns) for patch in placed]


def _reduced(
    grid: MeshGrid, placed: list[PatchOnGrid], sink: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rates (K,), ports (K, M) and the states' fields (N, K), the mean first. sink: (N,) W/K of each cell to contents
    that are held at one temperature, with which the mean is no state of its own. Fields that flow without it do not
    span those with it: where a wall insulates, their impedance was 6 % too small."""
    drive = np.concatenate([patch.shares for patch in placed], axis=1)
    direct = np.asarray(block_diag(*(patch.skin for patch in placed)))
    total = grid.capacity.sum()
    count, ports = drive.shape
    most = len(_SHIFTS) * ports
    fields = np.empty((count, most))
    gram, pencil, seen, scales = (
        np.empty((most, most)),
        np.empty((most, most)),
        np.empty((most, ports)),
        np.empty(most),
    )
    for n, s in enumerate(_SHIFTS):
        old, new, known = slice(n * ports), slice(n * ports, (n + 1) * ports), slice((n + 1) * ports)
        level = drive.sum(axis=0) / (s * total) if sink is None else np.zeros(ports)
        guess = level * np.ones_like(drive)
        if n:
            guess += (
                fields[:, old]
                @ np.linalg.lstsq(s * gram[old, old] + pencil[old, old], seen[old], rcond=1e-12)[0]
            )
        if sink is None:
            x = solve_shifted(grid, s, drive, guess, _SETTLED)
            x -= grid.capacity @ x / total
        else:  # a sink is as much more capacity at one shift
            x = solve_shifted(replace(grid, capacity=grid.capacity + sink / s), s, drive, guess, _SETTLED)
        scales[new] = 1 / np.sqrt(grid.capacity @ x**2)
        x *= scales[new]
        fields[:, new] = x
        gram[known, new] = fields[:, known].T @ (grid.capacity[:, None] * x)
        lost = conduct(grid, x) if sink is None else conduct(grid, x) + sink[:, None] * x
        pencil[known, new] = fields[:, known].T @ lost
        gram[new, old], pencil[new, old] = gram[old, new].T, pencil[old, new].T
        seen[new] = x.T @ drive
    # The wall of a patch lies off its cells' nodes by a thermal resistance without capacity: it joins every field as
    # the flow that made it.
    skin = np.tile(direct, (len(_SHIFTS), 1)) * scales[:, None]
    through = (np.tile(direct, (len(_SHIFTS),) * 2) * scales[:, None]) * scales
    values, vectors = eigh((gram + gram.T) / 2)
    kept = values > _RANK * values[-1]
    basis = vectors[:, kept] / np.sqrt(values[kept])
    rates, turn = eigh(basis.T @ (pencil + pencil.T + 2 * through) @ basis / 2)
    basis = basis @ turn
    coupled = basis.T @ (seen + skin)
    if sink is not None:
        return np.maximum(rates, 0.0), coupled, fields @ basis
    mean = np.sum(drive, axis=0) / np.sqrt(total)
    whole = np.full((len(grid.capacity), 1), 1 / np.sqrt(total))
    return (
        np.concatenate(([0.0], np.maximum(rates, 0.0))),
        np.concatenate((mean[None], coupled)),
        np.concatenate((whole, fields @ basis), axis=1),
    )


def _nearest(grid: MeshGrid, points: np.ndarray) -> np.ndarray:
    """(Q,) cells with material nearest to points (Q, 3) in the grid's frame."""
    nodes = grid.nodes
    return np.array([int(np.argmin(np.sum((nodes - p) ** 2, axis=1))) for p in points], dtype=int)


def conducting_parts(body: Solid) -> list[tuple[np.ndarray, np.ndarray, float, float]]:
    """What heat conduction depends on, by part: vertices, faces, W/(m K) and J/(m3 K), but no material's name."""
    return [
        (p.vertices, p.faces, p.material.conductivity, p.material.volumetric_heat_capacity)
        for p in body.parts
    ]


def _key(
    body: Solid,
    patches: tuple[SurfacePatch, ...],
    patterns: PatchPatterns,
    points: np.ndarray,
    gridding: MeshGridding,
) -> dict[str, object]:
    return {
        "parts": conducting_parts(body),
        "patches": patches,
        "patterns": (patterns.edges, patterns.sums),
        "points": points,
        "gridding": gridding,
    }
