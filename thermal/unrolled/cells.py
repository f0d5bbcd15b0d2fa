"""Cells of what lies beneath a curved face, unrolled: heat capacities and links.

A, B: rays along u and v. I, J, K: cells along u, v and w. N: those that hold material.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..surfaces import FACING, net_volumes
from .columns import Fineness, Piece, Place
from .fills import fill, planes, wet_area
from .rays import Face, cast

_RAYS = (0.2503, 0.7501), (0.2437, 0.7553)
"""Shares of a cell's length where rays go down, along u and v: edges of triangles lie nowhere so."""
_LEAST = 1e-4  # of a cell, less than which is nothing
_SMOOTH = 0.08  # half widths, by which the surface may differ from a place's face
_ROUGH = 0.03  # of what is touched, that may differ by more
_ROUND = 0.05  # of the way to a curved face's axis, that is left at least
_FAST = 8.0  # diffusivities over the square of the first cell, a rate that no cell exceeds
_LENT = 0.5  # of a cell's heat capacity, that neighbours may borrow


class Cells(NamedTuple):
    """w: (K + 1,) m, edges. numbers: (I, J, K), a cell's number, -1 where there is no material. capacity: (N,) J/K.
    neighbours: (N, 6), a cell itself for none, and links: (N, 6) W/K to them. sink: (N,) W/K to contents. cover: (I, J)
    of each column, that is touched, and top: (I, J), number of its highest cell. wet: whether contents wet most of what
    lies just below the patch."""

    w: np.ndarray
    numbers: np.ndarray
    capacity: np.ndarray
    neighbours: np.ndarray
    links: np.ndarray
    sink: np.ndarray
    cover: np.ndarray
    top: np.ndarray
    wet: bool


def cells_beneath(
    place: Place, pieces: Sequence[Piece], along: tuple[np.ndarray, np.ndarray], film: float, fine: Fineness
) -> Cells | None:
    """along: m, edges of columns along u and v. film: W/(m2 K) at what is wet. None where what is touched does not
    lie on the face."""
    face, half = place.face, place.half
    u, v = (_halves(edges, *shares) for edges, shares in zip(along, _RAYS, strict=True))
    du, dv = (np.repeat(np.diff(edges) / 2, 2) for edges in along)
    hits = [cast(face, piece.triangles, piece.surfaces, u, v, 2 * half, 2 * fine.deep) for piece in pieces]
    outer = [each for each, piece in zip(hits, pieces, strict=True) if piece.host is None]
    tops = np.max([np.where(h.surfaces[..., 0] != 0, h.heights[..., 0], -np.inf) for h in outer], axis=0)
    touched = (np.abs(tops) < half) & (np.max([h.slopes[..., 0] for h in outer], axis=0) > FACING)
    area = touched * (np.abs(face.seen(u, 0)) < half)[:, None] * (np.abs(face.seen(v, 1)) < half)
    area = area * du[:, None] * dv
    if not area.sum() > 0 or area[np.abs(tops) > _SMOOTH * half].sum() > _ROUGH * area.sum():
        return None
    # what differs a little from the face is moved to it, far away more
    slight = _SMOOTH * half * np.maximum(1.0, (u[:, None] ** 2 + v**2) / half**2)
    shift = np.where(np.abs(tops) <= slight, tops, 0.0)
    hits = [each._replace(heights=each.heights - shift[..., None]) for each in hits]
    w = planes(hits, 2 * half, fine)
    fills = [fill(each, w) for each in hits]
    solid = np.minimum(
        sum(each.solid for each, piece in zip(fills, pieces, strict=True) if piece.host is None), 1.0
    )
    shares = [_mean(each.solid) for each in fills]
    if len(pieces) > 1:
        shares = [np.maximum(each, 0.0) for each in net_volumes(shares, [piece.host for piece in pieces])]
    wet = np.zeros_like(shares[0])
    if film > 0:
        wet = 4 * _mean(wet_area(solid, fills, w, du, dv))
    below = np.abs(hits[0].surfaces[..., 1]) == 2
    return _joined(
        _Filled(face, (*along, w), solid, shares, wet, _mean(touched * 1.0)),
        pieces,
        film,
        fine.first,
        bool(area[below].sum() > area.sum() / 2),
    )


def _halves(edges: np.ndarray, first: float, second: float) -> np.ndarray:
    """Two places in each cell, at these shares of its length."""
    size = np.diff(edges)
    return np.stack((edges[:-1] + first * size, edges[:-1] + second * size), axis=1).ravel()


def _mean(rays: np.ndarray) -> np.ndarray:
    """(I, J, ...) of a column's four rays (A, B, ...)."""
    return (rays[::2, ::2] + rays[1::2, ::2] + rays[::2, 1::2] + rays[1::2, 1::2]) / 4


class _Filled(NamedTuple):
    """edges: m along u, v and w. solid: (A, B, K) of each ray in each cell that is filled. shares: (I, J, K) of each
    piece. wet: (I, J, K) m2 along a flat face. cover: (I, J)."""

    face: Face
    edges: tuple[np.ndarray, np.ndarray, np.ndarray]
    solid: np.ndarray
    shares: list[np.ndarray]
    wet: np.ndarray
    cover: np.ndarray


def _joined(filled: _Filled, pieces: Sequence[Piece], film: float, first: float, wet: bool) -> Cells:
    x, y, z = (np.diff(edges) for edges in filled.edges)
    heights = filled.edges[2]
    # lengths along a curved face over those along it at its surface: in cells' middles, and at their edges
    middle, edge = (
        np.maximum(1 + filled.face.bend[:, None] * at, _ROUND)
        for at in ((heights[1:] + heights[:-1]) / 2, heights)
    )
    amount = np.sum(filled.shares, axis=0)
    held = amount > _LEAST
    index = np.where(held, np.cumsum(held).reshape(held.shape) - 1, -1)
    kept = [share[held] for share in filled.shares]
    conducts = sum(piece.conductivity * share for piece, share in zip(pieces, kept, strict=True))
    along = conducts / amount[held]
    across = amount[held] / sum(share / piece.conductivity for piece, share in zip(pieces, kept, strict=True))
    cell = x[:, None, None] * y[:, None] * (z * middle.prod(axis=0))
    capacity = cell[held] * sum(piece.capacity * share for piece, share in zip(pieces, kept, strict=True))
    neighbours = np.repeat(np.arange(len(capacity))[:, None], 6, axis=1)
    links = np.zeros((len(capacity), 6))
    for axis in range(3):
        if axis == 2:
            through = (filled.solid[..., :-1] > _LEAST) & (filled.solid[..., 1:] > _LEAST)
            crossed = _mean(through.astype(float))
            area = crossed * x[:, None, None] * y[:, None] * edge.prod(axis=0)[1:-1]
            length, conductivity = np.broadcast_to(z, index.shape), across
        else:
            rays = np.moveaxis(filled.solid, axis, 0)
            crossed = np.minimum(rays[1:-1:2], rays[2::2])
            area = (crossed[:, ::2] + crossed[:, 1::2]) / 2 * (y, x)[axis][:, None] * (z * middle[1 - axis])
            length = np.broadcast_to((x[:, None, None], y[:, None])[axis] * middle[axis], index.shape)
            conductivity = along
        numbers, size = np.moveaxis(index, axis, 0), np.moveaxis(length, axis, 0)
        low, high = numbers[:-1], numbers[1:]
        area = np.moveaxis(area, 2, 0) if axis == 2 else area
        joined = (low >= 0) & (high >= 0)
        a, b = low[joined], high[joined]
        way = size[:-1][joined] / conductivity[a] + size[1:][joined] / conductivity[b]
        neighbours[a, 2 * axis + 1], neighbours[b, 2 * axis] = b, a
        links[a, 2 * axis + 1] = links[b, 2 * axis] = 2 * area[joined] / way
    sink = np.zeros(len(capacity))
    if film > 0:
        before = np.broadcast_to(z, index.shape)[held] * amount[held] / (2 * across)
        sink = (filled.wet * middle.prod(axis=0))[held] / (1 / film + before)
    fastest = _FAST * max(piece.conductivity / piece.capacity for piece in pieces) / first**2
    capacity = _lent(capacity, neighbours, links, 2 * (links.sum(axis=1) + sink) / fastest)
    top = index.shape[2] - 1 - np.argmax(held[..., ::-1], axis=2)
    highest = np.take_along_axis(index, top[..., None], axis=2)[..., 0]
    cover = np.where(highest >= 0, filled.cover, 0.0)
    return Cells(heights, index, capacity, neighbours, links, sink, cover, highest, wet)


def _lent(capacity: np.ndarray, neighbours: np.ndarray, links: np.ndarray, least: np.ndarray) -> np.ndarray:
    """(N,) J/K of cells with least (N,) J/K, lent by the neighbours that they follow anyway."""
    small = np.flatnonzero(least > capacity)
    lender = neighbours[small, links[small].argmax(axis=1)]
    lent = np.bincount(lender, (least - capacity)[small], len(capacity))
    return np.maximum(capacity, least) - np.minimum(lent, _LENT * capacity)
