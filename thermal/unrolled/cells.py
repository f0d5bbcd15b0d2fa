"""Cells of what lies beneath a curved face, unrolled: how much of each is filled, heat capacities, links."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

from ..numerics import graded_cells
from ..surfaces import FACING, net_volumes
from .rays import Face, Hits, cast

_LEAST = 1e-4  # of a cell, less than which is nothing
_FAST = 8.0
_LENT = 0.5
_ROUND = 0.05  # of the way to a round face's axis, that is left at least
_ROUGH = 0.03  # of what is touched, that is not on the face
_BIN = 50e-6  # m
_MANY = 0.03  # of the rays


class Part(NamedTuple):
    """triangles: (F, 3, 3) m along a face's axes. wet: (F,) of them, by contents. conductivity: W/(m K). capacity:
    J/(m3 K). host: of the parts, in which it lies, or None."""

    triangles: np.ndarray
    wet: np.ndarray
    conductivity: float
    capacity: float
    host: int | None


class Cells(NamedTuple):
    """edges: (n + 1,) m along u, v and w, ascending. index: (I, J, K) numbers of those that hold material, others -1.
    capacity: (N,) J/K. neighbours: (N, 6), itself for none, and links (N, 6) W/K. wet: (N,) m2 of a film, and behind
    (N,) K m2/W of the cell before it. cover: (I, J) of each column's middle, that is touched from above, and top
    (I, J) number of its first cell."""

    edges: tuple[np.ndarray, np.ndarray, np.ndarray]
    index: np.ndarray
    capacity: np.ndarray
    neighbours: np.ndarray
    links: np.ndarray
    sink: np.ndarray
    cover: np.ndarray
    top: np.ndarray
    wet: bool


def cells_beneath(
    face: Face,
    parts: Sequence[Part],
    along: tuple[np.ndarray, np.ndarray],
    half: float,
    depth: float,
    film: float,
    first: float,
    growth: float,
    largest: float,
    smooth: float,
) -> Cells | None:
    """along: edges of columns. depth: m that cells reach. film: W/(m2 K) at what is wet. smooth: m, by which
    the surface may differ from the face and be taken as on it."""
    u, v = (_halves(edges) for edges in along)
    hits = [
        cast(face, part.triangles, np.where(part.wet, 2, 1), u, v, 2 * depth) for part in parts
    ]
    outer = [n for n, part in enumerate(parts) if part.host is None]
    tops = np.max([np.where(hits[n].counts > 0, hits[n].heights[..., 0], -np.inf) for n in outer], axis=0)
    far = np.maximum(1.0, (u[:, None] ** 2 + v**2) / half**2)
    shift = np.where(np.abs(tops) <= smooth * far, tops, 0.0)
    steep = np.max([np.where(hits[n].counts > 0, hits[n].slopes[..., 0], 0.0) for n in outer], axis=0)
    touched = (np.abs(tops) < half) & (steep > FACING)
    on = touched & (np.abs(u) <= half)[:, None] & (np.abs(v) <= half)
    area = on * np.repeat(np.diff(along[0]), 2)[:, None] * np.repeat(np.diff(along[1]), 2)
    covered = area.sum()
    if not covered > 0 or (area * (np.abs(tops) > smooth)).sum() > _ROUGH * covered:
        return None
    below = np.abs(hits[0].surfaces[..., 1]) == 2
    under = bool((area * below).sum() > covered / 2)
    for each in hits:
        each.heights[...] -= shift[..., None]
    w = _down(hits, depth, half, first, growth, largest)
    fills, wetted = zip(*(_fill(each, w) for each in hits), strict=True)
    whole = sum(fills[n] for n in outer)
    whole = np.minimum(whole, 1.0)
    bare = _wet(whole, *[sum(x) for x in zip(*wetted)], w, np.diff(along[0]) / 2, np.diff(along[1]) / 2)
    edges = along[0], along[1], w
    return _joined(face, parts, edges, fills, whole, bare, film, touched, under, first)


def _halves(edges: np.ndarray) -> np.ndarray:
    """Two places in each cell."""
    size = np.diff(edges)
    return np.stack((edges[:-1] + 0.2503 * size, edges[:-1] + 0.7501 * size), axis=1).ravel()


def _down(
    hits: Sequence[Hits], depth: float, half: float, first: float, growth: float, largest: float
) -> np.ndarray:
    """Edges of cells along w, with planes where many rays enter or leave, to which the heights next to them are
    moved."""
    bins = np.zeros(int((depth + half) / _BIN) + 2, np.int64)
    high = 0.0
    for each in hits:
        kept = (each.heights > -depth) & (each.heights < half) & (each.surfaces != 0)
        heights = each.heights[kept]
        high = max(high, float(heights.max(initial=0.0)))
        bins += np.bincount(((heights + depth) / _BIN).astype(np.int64), minlength=len(bins))
    breaks = [-depth, 0.0]
    if high > _BIN:
        breaks.append(high)
    near = bins.copy()
    near[1:] += bins[:-1]
    near[:-1] += bins[1:]
    while True:
        most = int(near.argmax())
        if near[most] < _MANY * hits[0].counts.size:
            break
        around = slice(max(most - 1, 0), most + 2)
        places = -depth + _BIN * (np.arange(len(bins)) + 0.5)
        middle = float(places[around] @ bins[around] / bins[around].sum())
        near[max(most - 3, 0) : most + 4] = 0
        met = [each.heights[(np.abs(each.heights - middle) < 1.5 * _BIN) & (each.surfaces != 0)] for each in hits]
        at = float(np.mean(np.concatenate(met)))
        if abs(at) < 2 * _BIN:
            at = 0.0
        elif min(abs(at - other) for other in breaks) > 2 * _BIN:
            breaks.append(at)
        else:
            continue
        for each in hits:
            each.heights[(np.abs(each.heights - at) < 1.5 * _BIN) & (each.surfaces != 0)] = at
    return graded_cells(sorted(breaks), {0.0: first}, growth, largest)


@njit(cache=True, error_model="numpy")
def _filled(heights, surfaces, counts, w, fill, void, bottoms, slopes):
    """fill: (A, B, K) of each ray in each cell. void: of it that is empty and wet. bottoms: (A, B, K) wet faces that a
    ray leaves or enters by, over the cosine to it."""
    cells = len(w) - 1
    for a in range(heights.shape[0]):
        for b in range(heights.shape[1]):
            inside, top, wet = 0, w[cells], False
            for n in range(counts[a, b] + 1):
                last = n == counts[a, b]
                at = w[0] if last else heights[a, b, n]
                code = 0 if last else surfaces[a, b, n]
                was = inside > 0
                inside += 1 if code > 0 else (-1 if code < 0 else 0)
                filled = inside > 0
                hit_wet = abs(code) == 2
                if filled == was and not last:
                    continue
                low, high = max(at, w[0]), min(top, w[cells])
                if high > low and (was or wet or hit_wet):
                    for k in range(cells):
                        part = min(high, w[k + 1]) - max(low, w[k])
                        if part > 0:
                            if was:
                                fill[a, b, k] += part / (w[k + 1] - w[k])
                            else:
                                void[a, b, k] += part / (w[k + 1] - w[k])
                if hit_wet and w[0] < at < w[cells]:
                    k = 0
                    while w[k + 1] < at - 1e-9 if filled else w[k + 1] <= at + 1e-9:
                        k += 1  # the cell on the body's side
                    if k < cells:
                        bottoms[a, b, k] += 1 / max(slopes[a, b, n], 0.5)
                top, wet = at, hit_wet


def _fill(hits: Hits, w: np.ndarray):
    shape = (*hits.counts.shape, len(w) - 1)
    fill, void, bottoms = np.zeros(shape), np.zeros(shape), np.zeros(shape)
    _filled(hits.heights, hits.surfaces, hits.counts, w, fill, void, bottoms, hits.slopes)
    return fill, (void, bottoms)


def _wet(whole, void, bottoms, w, du, dv):
    """(I, J, K) m2 of each cell that is wet, per unit of metric."""
    if not void.any() and not bottoms.any():
        return None
    dw = np.diff(w)
    size = np.repeat(du, 2)[:, None, None] * np.repeat(dv, 2)[:, None]
    wet = bottoms * size
    void = np.minimum(void, 1 - whole)
    for axis, (step, beside) in enumerate(((np.repeat(du, 2), np.repeat(dv, 2)), (np.repeat(dv, 2), np.repeat(du, 2)))):
        f, e, b = (np.moveaxis(x, axis, 0) for x in (whole, void, wet))
        for here, there in ((slice(None, -1), slice(1, None)), (slice(1, None), slice(None, -1))):
            met = np.minimum(f[here], e[there]) * dw
            tall = met.sum(axis=-1, keepdims=True) > np.maximum(step[1:], step[:-1])[:, None, None]
            b[here] += np.where(tall, met, 0.0) * beside[:, None]
    return _mean(wet) * 4


def _mean(x: np.ndarray) -> np.ndarray:
    return (x[::2, ::2] + x[1::2, ::2] + x[::2, 1::2] + x[1::2, 1::2]) / 4


def _joined(face, parts, edges, fills, whole, bare, film, touched, under, first) -> Cells:
    x, y, z = (np.diff(e) for e in edges)
    middle = (edges[2][1:] + edges[2][:-1]) / 2
    around = np.maximum(1 + face.bend[:, None] * middle, _ROUND)  # (2, K), lengths along u and v there
    below = np.maximum(1 + face.bend[:, None] * edges[2], _ROUND)
    hosts = [part.host for part in parts]
    shares = [_mean(share) for share in fills]
    if len(parts) > 1:
        shares = [np.maximum(s, 0.0) for s in net_volumes(shares, hosts)]
    filled = sum(shares)
    held = filled > _LEAST
    index = np.where(held, np.cumsum(held).reshape(held.shape) - 1, -1)
    count = int(held.sum())
    along = sum(part.conductivity * s for part, s in zip(parts, shares, strict=True))[held] / filled[held]
    across = filled[held] / sum(s / part.conductivity for part, s in zip(parts, shares, strict=True))[held]
    density = sum(part.capacity * s for part, s in zip(parts, shares, strict=True))
    cell = x[:, None, None] * y[:, None] * z * around[0] * around[1]
    amount = filled[held]
    capacity = (density * cell)[held]
    neighbours = np.repeat(np.arange(count)[:, None], 6, axis=1)
    links = np.zeros((count, 6))
    wide = np.full(whole.shape, 0.0)
    for axis in range(3):
        k = np.moveaxis(index, axis, 0)
        low, high = k[:-1], k[1:]
        joined = (low >= 0) & (high >= 0)
        if axis == 2:
            spans = (whole[..., :-1] > _LEAST) & (whole[..., 1:] > _LEAST)
            open_ = np.moveaxis(_mean(spans * 1.0), 2, 0)
            area = open_ * np.moveaxis(x[:, None, None] * y[:, None] * (below[0] * below[1])[1:-1], 2, 0)
            size, conductivity = np.broadcast_to(z, index.shape), across
        else:
            f = np.moveaxis(whole, axis, 0)
            face_fill = np.minimum(f[1:-1:2], f[2::2])
            open_ = (face_fill[:, ::2] + face_fill[:, 1::2]) / 2
            other = (y, x)[axis]
            area = open_ * other[:, None] * (z * around[1 - axis])
            size = np.broadcast_to(
                (x[:, None, None] if axis == 0 else y[:, None]) * around[axis], index.shape
            )
            conductivity = along
        length = np.moveaxis(size, axis, 0)
        a, b = low[joined], high[joined]
        way = (length[:-1][joined] / conductivity[a] + length[1:][joined] / conductivity[b]) / 2
        link = area[joined] / way
        neighbours[a, 2 * axis + 1], links[a, 2 * axis + 1] = b, link
        neighbours[b, 2 * axis], links[b, 2 * axis] = a, link
    sink = np.zeros(count)
    if bare is not None and film > 0:
        wet = bare * around[0] * around[1]
        wet = wet[held]
        thick = np.broadcast_to(z, index.shape)[held] * amount
        sink = wet / (1 / film + thick / 2 / across)
    fastest = _FAST * max(part.conductivity / part.capacity for part in parts) / first**2
    _shared(capacity, neighbours, links, sink, fastest)
    heldw = whole > _LEAST
    last = np.where(heldw.any(axis=2), whole.shape[2] - 1 - np.argmax(heldw[..., ::-1], axis=2), -1)
    top = np.where(held.any(axis=2), held.shape[2] - 1 - np.argmax(held[..., ::-1], axis=2), -1)
    i, j = np.indices(top.shape)
    number = np.where(top >= 0, index[i, j, np.maximum(top, 0)], -1)
    return Cells(edges, index, capacity, neighbours, links, sink, _mean(touched * (last >= 0)), number, under)


def _shared(capacity, neighbours, links, sink, fastest) -> None:
    """Cells that would change faster than that borrow heat capacity of the neighbours that they follow."""
    need = 2 * (links.sum(axis=1) + sink) / fastest - capacity
    small = np.flatnonzero(need > 0)
    best = links[small].argmax(axis=1)
    lender = neighbours[small, best]
    lent = np.minimum(need[small], _LENT * capacity[lender])
    capacity[small] += need[small]
    total = np.bincount(lender, lent, len(capacity))
    capacity -= np.minimum(total, _LENT * capacity)
