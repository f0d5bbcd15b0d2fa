"""The heat kernel of a sensor's face on a body, before its heat has gone far: of cells beneath, unrolled, beside a box.

What cells are too coarse for, a box that is cut into the same cells is, too: the kernel is that of the cells, turned by
what turns the box's into that of the box itself.

M: patterns, T: times.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..kernels import FUNCTIONS, NODES, Patches, Tip, basis_shares, basis_terms, box_kernel
from ..numerics import graded_cells
from .cells import Cells, Part, cells_beneath
from .filmed import filmed
from .fading import Fading, fading
from .rays import Face, cast

_STEP = 0.1e-3  # m, between rays that look for what is not even
_JUMP = 0.3


class Fineness(NamedTuple):
    side: float = 0.5e-3
    first: float = 0.25e-3
    growth: float = 0.45
    largest: float = 3e-3
    reach: float = 9e-3
    least: float = 0.3e-3


class LocalKernel(NamedTuple):
    fading: Fading
    cells: Cells
    gridded: tuple
    size: tuple[float, float, float]
    middle: np.ndarray
    half: np.ndarray
    values: np.ndarray
    jumps: np.ndarray
    diffusivity: float
    capacity: float
    film: float

    def kernel(self, times: np.ndarray) -> np.ndarray:
        """(T, M, M) K/J."""
        count = self.jumps.shape[1]
        taus = self.diffusivity * times
        patches = Patches(np.array([5]), self.middle[None], self.half[None])
        exact, _, port, _, _ = box_kernel(
            self.size, 1.0, 1.0, 0.0, patches, self.jumps[None], basis_terms(count), 1, taus
        )
        exact = exact + np.outer(port, port)
        if self.film > 0:
            exact *= filmed(taus, self.size[2], self.film)[:, None, None]
        coarse = _box_on_cells(self.gridded, taus, count)
        turn = np.linalg.cholesky(exact) @ np.linalg.inv(np.linalg.cholesky(coarse))
        return turn @ self.fading.kernel(times) @ turn.transpose(0, 2, 1)


def local_kernel(
    face: Face, parts: Sequence[Part], half: float, ends: np.ndarray, depth: float, tip: Tip, film: float, last: float,
    fine: Fineness = Fineness(),
) -> LocalKernel | None:
    """ends: (2, 2) m, seen along the normal, where the face ends; depth m."""
    outer = parts[0]
    diffusivity = outer.conductivity / outer.capacity
    edges, spans = [], []
    for axis in range(2):
        wide = face.along(half, axis)
        reach = wide + fine.reach
        if face.bend[axis]:
            reach = min(reach, 1.3 / abs(face.bend[axis]))
        low, high = (
            reach if end * abs(face.bend[axis]) > 0.99 else min(face.along(float(end), axis), reach)
            for end in ends[axis]
        )
        a, b = max(-wide, -low), min(wide, high)
        if not b - a > 0.1 * wide:
            return None
        points = {-reach, reach, a, b, -low, high}
        jumps = _jumps(face, parts, axis, (a + b) / 2, reach, depth)
        others = [p for p in jumps if min(abs(p - q) for q in points) > 0.2e-3]
        breaks = sorted(points | set(others))
        sizes = {x: fine.side for x in (a, b)}
        for at in others:
            sizes[at] = min(fine.side, max(min(abs(at - q) for q in breaks if q != at) / 2, fine.least))
        edges.append(graded_cells(breaks, sizes, fine.growth, fine.largest))
        spans.append((-low, high, a, b))
    cells = cells_beneath(
        face, parts, (edges[0], edges[1]), half, fine.reach, film, fine.first, fine.growth, fine.largest, 0.08 * half
    )
    if cells is None:
        return None
    shares = (basis_shares(tip.basis) @ FUNCTIONS)  # (2, M, strips)
    shares[1, 0] = 1.0
    ports = _ports(face, cells, shares, half)
    faded = fading(cells.capacity, cells.neighbours, cells.links, cells.sink, ports, last)
    # box
    values, gridded = [], []
    for axis in range(2):
        low, high, a, b = spans[axis]
        strips = (a + b) / 2 + (b - a) / 2 * NODES
        means = _means(shares[axis], face.seen(strips, axis) / half)
        means[1:] -= (means[1:] @ np.diff(NODES) / 2)[:, None]
        values.append(means)
        e = edges[axis]
        e = e[(e >= low - 1e-12) & (e <= high + 1e-12)]
        cum = np.concatenate((np.zeros((len(means), 1)), np.cumsum(means * np.diff(strips), axis=1)), axis=1)
        on = np.array([np.interp(e, strips, row) for row in cum])
        gridded.append((*_line(e), np.diff(on, axis=1) / (b - a)))
    w = cells.edges[2]
    deep = min(depth, -w[0])
    w = w[(w <= 1e-12) & (w >= -deep - 0.1e-3)].copy()
    w[0], w[-1] = -deep, 0.0
    wet = film / outer.conductivity if film > 0 and cells.wet else 0.0
    gridded.append((*_line(w, wet), np.eye(len(w) - 1)[-1:]))
    jumps = -np.diff(np.pad(np.array(values), ((0, 0), (0, 0), (1, 1))), axis=2)
    size = (spans[0][1] - spans[0][0], spans[1][1] - spans[1][0], deep)
    middle = np.array([(s[2] + s[3]) / 2 - s[0] for s in spans])
    halves = np.array([(s[3] - s[2]) / 2 for s in spans])
    return LocalKernel(faded, cells, tuple(gridded), size, middle, halves, np.array(values), jumps, diffusivity, outer.capacity, wet)


def _jumps(face: Face, parts: Sequence[Part], axis: int, middle: float, reach: float, depth: float) -> list[float]:
    """m along an axis of the face, where the body beneath gets thicker or thinner at once."""
    places = np.arange(-reach, reach, _STEP) + _STEP / 3
    thickness = np.zeros(len(places))
    for part in parts:
        if part.host is None:
            across = places, np.array([1.3e-6])
            hits = cast(face, part.triangles, np.where(part.wet, 2, 1), *across[:: 1 if axis == 0 else -1], 2 * reach)
            heights = hits.heights.reshape(len(places), -1)
            surfaces = hits.surfaces.reshape(len(places), -1)
            top = np.where(surfaces[:, 0] > 0, heights[:, 0], np.nan)
            bottom = np.where(surfaces[:, 1] < 0, heights[:, 1], -2 * reach)
            thickness = np.fmax(thickness, top - bottom)
    thickness = np.minimum(np.nan_to_num(thickness), reach)
    step = np.abs(np.diff(thickness)) > _JUMP * np.minimum(thickness[1:], thickness[:-1]) + _STEP
    return ((places[1:] + places[:-1]) / 2)[step].tolist()


def _means(values: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """(M, n) of functions that are even over strips, over other strips."""
    cum = np.concatenate((np.zeros((len(values), 1)), np.cumsum(values * np.diff(NODES), axis=1)), axis=1)
    at = np.array([np.interp(edges, NODES, row) for row in cum])
    return np.diff(at, axis=1) / np.diff(edges)


def _ports(face: Face, cells: Cells, shares: np.ndarray, half: float) -> np.ndarray:
    """(N, M)."""
    seen = [np.clip(face.seen(cells.edges[axis], axis) / half, -1.0, 1.0) for axis in range(2)]
    spans = [np.diff(s) for s in seen]
    means = []
    for axis in range(2):
        cum = np.concatenate(
            (np.zeros((shares.shape[1], 1)), np.cumsum(shares[axis] * np.diff(NODES), axis=1)), axis=1
        )
        at = np.array([np.interp(seen[axis], NODES, row) for row in cum])
        means.append(np.diff(at, axis=1) / np.where(spans[axis] > 0, spans[axis], 1.0))
    weight = cells.cover * spans[0][:, None] * spans[1]
    weight = np.where(cells.top >= 0, weight, 0.0)
    weight /= weight.sum()
    value = means[0][:, :, None] + means[1][:, None, :]
    value[0] = 1.0
    value[1:] -= np.einsum("nij,ij->n", value[1:], weight)[:, None, None]
    ports = np.zeros((len(cells.capacity), shares.shape[1]))
    at = weight > 0
    ports[cells.top[at]] = (weight * value)[:, at].T
    return ports


def _line(edges: np.ndarray, film: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Rates (n,) and fields (n, n), of cells along a line, of unit material."""
    size = np.diff(edges)
    link = 2 / (size[1:] + size[:-1])
    root = 1 / np.sqrt(size)
    matrix = np.zeros((len(size), len(size)))
    i = np.arange(len(link))
    matrix[i, i] += link
    matrix[i + 1, i + 1] += link
    matrix[i, i + 1] = matrix[i + 1, i] = -link
    if film > 0:
        matrix[0, 0] += 1 / (1 / film + size[0] / 2)
    rates, turn = np.linalg.eigh(root[:, None] * matrix * root)
    return np.maximum(rates, 0.0), root[:, None] * turn


def _box_on_cells(gridded: tuple, taus: np.ndarray, count: int) -> np.ndarray:
    lines = []
    for rates, fields, on in gridded:
        seen = on @ fields
        lines.append(np.einsum("ir,tr,jr->tij", seen, np.exp(-np.outer(taus, rates)), seen, optimize=True))
    x, y, z = lines
    one, other = x.copy(), y.copy()
    kernel = x * y[:, :1, :1]
    kernel = np.zeros((len(taus), count, count))
    for n in range(count):
        for m in range(count):
            kernel[:, n, m] = x[:, n, m] * y[:, 0, 0]
            if m:
                kernel[:, n, m] += x[:, n, 0] * y[:, 0, m]
            if n:
                kernel[:, n, m] += x[:, 0, m] * y[:, n, 0]
            if n and m:
                kernel[:, n, m] += x[:, 0, 0] * y[:, n, m]
    return kernel * z[:, :, :1]
