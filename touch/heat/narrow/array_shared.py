"""shared.py's contacts of one face as a pure function of arrays: NumPy, PyTorch, JAX.

B: rows, F: fingertips, O: objects, N = F O: pairs, S: contacts of a face that know of one another, K: states.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from ....thermal.contact import array_offset_of_share
from ....thermal.numerics import Array, as_like, namespace_of
from .shared import ALIKE, FIRM, SHARED, SPREAD
from .tables import MODES

Rows = list[list[Array]]


@dataclass(frozen=True, slots=True)
class ArrayFaces:
    """What pairs (fingertip, object) of whole faces need to know of one another. modes: (F, MODES, MODES, K) of
    face_modes. width: (F,) m. decay: (K,) 1/s. objects: O."""

    modes: Array
    width: Array
    decay: Array
    objects: int

    def shared(
        self, touching: Array, area: Array, length: Array, aside: Array, own: Array, besides: Array
    ) -> SharedFaces:
        """Of contacts (B, N) that are touching, of that area m2 and length m, which lie aside (B, N, 2) by those
        shares, and have of their own, and of what else there is, squares (B, N, K)."""
        xp, pairs = namespace_of(area), (area.shape[0], len(self.width), self.objects)
        whole = self.width[:, None] + 0.0 * area.reshape(pairs)
        there = area.reshape(pairs) > 0
        safe = xp.where(there, area.reshape(pairs), whole * whole)
        first = xp.minimum(safe / xp.where(there, length.reshape(pairs), whole), whole)
        lengths = xp.stack([first, xp.minimum(safe / first, whole)], -1)
        offsets = array_offset_of_share(aside.reshape((*pairs, 2)), lengths, whole[..., None] + 0.0 * lengths)
        closed = xp.where(touching.reshape(pairs), 1.0 + 0.0 * whole, 0.0 * whole)
        several = closed.sum(-1) > 1
        chosen = None
        if self.objects > SHARED:
            chosen = _largest(closed, lengths[..., 0] * lengths[..., 1])
            empty = 1.0 - chosen.sum(-1)[..., None]
            lengths = (chosen[..., None] * lengths[..., None, :, :]).sum(-2) + empty * self.width[
                :, None, None
            ]
            offsets = (chosen[..., None] * offsets[..., None, :, :]).sum(-2)
            closed = chosen.sum(-1)
        made = SharedFaces(chosen, pairs, own + besides, [])
        rows = self._rows(closed, lengths, offsets, made.of_face(own), made.of_face(besides), several)
        return SharedFaces(chosen, pairs, own + besides, rows)

    def _rows(
        self, closed: Array, lengths: Array, offsets: Array, own: Array, besides: Array, several: Array
    ) -> Rows:
        """L of shared.py, row by row, (B, F, K) each; without what contacts have of one another where there are not
        several (B, F)."""
        xp, count = namespace_of(own), own.shape[-2]
        width = self.width[:, None, None] + 0.0 * lengths
        offsets = self._sided(closed, lengths, offsets)
        waves = [_waves(lengths[..., i, :], offsets[..., i, :], width[..., i, :]) for i in range(count)]
        squares = []
        for i in range(count):
            alone = own[..., i, :]
            known = self._coupled(waves[i], waves[i])
            in_end, by_waves = (alone / self.decay).sum(-1), (known / self.decay).sum(-1)
            told = by_waves > 0
            less = (in_end / xp.where(told, by_waves, 1.0 + 0.0 * by_waves)).clip(None, 1.0)
            waves[i] = waves[i][0] * root_of(less)[..., None], waves[i][1]
            known = less[..., None] * known
            more = (alone - known).clip(0.0)
            beyond = (more / self.decay).sum(-1)
            some = beyond > 0
            rest = (in_end - less * by_waves).clip(0.0) / xp.where(some, beyond, 1.0 + 0.0 * beyond)
            rest = xp.where(some, rest, 0.0 * rest)
            whole = (known + rest[..., None] * more + besides[..., i, :]) * FIRM
            squares.append(xp.where(several[..., None], whole, alone + besides[..., i, :]))
        rows: Rows = []
        for i in range(count):
            row, rest = [], squares[i]
            for j in range(i):
                value = self._coupled(waves[i], waves[j])
                for n in range(j):
                    value = value - row[n] * rows[j][n]
                held = several[..., None] & (rows[j][j] > 0)
                value = xp.where(held, value / xp.where(held, rows[j][j], 1.0 + 0.0 * value), 0.0 * value)
                row.append(value)
                rest = rest - value * value
            row.append(root_of(rest.clip(0.0)))
            rows.append(row)
        return rows

    def _coupled(self, one: tuple[Array, Array], other: tuple[Array, Array]) -> Array:
        """(B, F, K) K/J that contacts of these waves have of one another."""
        along, across = one[0] * other[0], one[1] * other[1]
        both = (along[..., :, None] * across[..., None, :])[..., None] * self.modes
        return both.sum(-2).sum(-2)

    def _sided(self, closed: Array, lengths: Array, offsets: Array) -> Array:
        """The offsets m (B, F, S, 2) with signs: closed contacts (B, F, S) lie on either side of the face's middle."""
        xp, count = namespace_of(offsets), offsets.shape[-2]
        if count == 1:
            return offsets
        flips = [(1.0, *signs) for signs in product((1.0, -1.0), repeat=count - 1)]
        flips = [tuple(reversed(signs[1:])) for signs in flips]  # the second contact's flips first
        ways = np.array([list(zip((1.0, *a), (1.0, *b), strict=True)) for b in flips for a in flips])
        signs: Array = as_like(ways, offsets)
        cost: Array = 0.0
        sided = offsets[:, :, None] * signs
        wide = self.width[:, None]
        for i in range(count):
            for j in range(i):
                off = abs(sided[..., i, :] - sided[..., j, :])
                reach = (lengths[..., i, :] + lengths[..., j, :])[:, :, None] / 2
                overlap = (reach - off).clip(0.0)
                both = (closed[..., i] * closed[..., j])[..., None]
                cost = cost + both * (overlap[..., 0] * overlap[..., 1] - SPREAD * wide * off.sum(-1))
        number = as_like(np.arange(len(ways)), offsets)
        least = xp.where(number == cost.argmin(-1)[..., None], cost, 0.0 * cost).sum(-1)[..., None]
        good = xp.where(cost <= least + ALIKE * wide * wide, 1.0 + 0.0 * cost, 0.0 * cost)
        first = good * xp.where(good.cumsum(-1) == 1, 1.0 + 0.0 * good, 0.0 * good)
        return (first[..., None, None] * sided).sum(2)


@dataclass(frozen=True, slots=True)
class SharedFaces:
    """L of shared.py. chosen: (B, F, S, O) of numbers, 1 where an object is the S-th of those that share a face; None
    where all do. pairs: (B, F, O). alone: (B, N, K), squares of contacts that no other knows of. rows: (B, F, K)
    each."""

    chosen: Array | None
    pairs: tuple[int, int, int]
    alone: Array
    rows: Rows

    def of_face(self, values: Array) -> Array:
        """(B, F, S, ...) of (B, N, ...)."""
        each = values.reshape((*self.pairs, *values.shape[2:]))
        if self.chosen is None:
            return each
        chosen = self.chosen.reshape((*self.chosen.shape, *(1 for _ in values.shape[2:])))
        return (chosen * each[:, :, None]).sum(3)

    def of_pairs(self, values: Sequence[Array], others: Array) -> Array:
        """(B, N, ...) of S values (B, F, ...), and of those of others where no contact shares a face."""
        xp = namespace_of(values[0])
        each = xp.stack(list(values), 2)
        if self.chosen is not None:
            chosen = self.chosen.reshape((*self.chosen.shape, *(1 for _ in each.shape[3:])))
            each = (chosen * each[:, :, :, None]).sum(2)
        found = each.reshape((self.pairs[0], self.pairs[1] * self.pairs[2], *each.shape[3:]))
        if self.chosen is None:
            return found
        rest = 1.0 - self.chosen.sum(2).reshape((*found.shape[:2], *(1 for _ in found.shape[2:])))
        return found + rest * others

    def behind(self, states: Array, mean: Array) -> Array:
        """K (B, N) that states (B, N, K) put against the flow over a step, of which they keep that mean (K,)."""
        there = self.of_face(states)
        falls = [
            sum((each * mean * there[..., j, :]).sum(-1) for j, each in enumerate(row)) for row in self.rows
        ]
        return self.of_pairs(falls, (root_of(self.alone) * mean * states).sum(-1))

    def series(self, lag: Array) -> Array:
        """K/W (B, N) that a contact's flow that has begun with the step meets, of which states have that lag s (K,)."""
        each = [sum((part * part * lag).sum(-1) for part in row) for row in self.rows]
        return self.of_pairs(each, (self.alone * lag).sum(-1))

    def mutual(self, lag: Array) -> Array:
        """K/W (B, N, N) by which such a flow is felt at the others of its face."""
        xp, (rows, tips, objects) = namespace_of(lag), self.pairs
        count = len(self.rows)
        none = 0.0 * self.rows[0][0].sum(-1)
        table = [[none] * count for _ in range(count)]
        for i, row in enumerate(self.rows):
            for j in range(i):
                both = sum(row[n] * self.rows[j][n] for n in range(j + 1))
                table[i][j] = table[j][i] = (both * lag).sum(-1)
        each = xp.stack([xp.stack(row, -1) for row in table], -2)
        if self.chosen is not None:
            each = (self.chosen[..., None] * each[:, :, :, None]).sum(2)
            each = (each[..., None] * self.chosen[:, :, None, :, :]).sum(3)
        turned = each[:, :, :, None] * as_like(np.eye(tips), each)[:, None, :, None]
        return turned.reshape((rows, tips * objects, tips * objects))

    def sent(self, flow: Array) -> Array:
        """What all flows W (B, N) send to the states (B, N, K)."""
        there = self.of_face(flow)
        taken = [
            sum(self.rows[i][j] * there[..., i, None] for i in range(j, len(self.rows)))
            for j in range(len(self.rows))
        ]
        return self.of_pairs(taken, root_of(self.alone) * flow[..., None])


def root_of(squares: Array) -> Array:
    """Roots of numbers from 0 on; that of 0 has no slope, and derivatives take it for 0."""
    xp = namespace_of(squares)
    some = squares > 0
    return xp.where(some, xp.where(some, squares, 1.0 + 0.0 * squares) ** 0.5, 0.0 * squares)


def _waves(length: Array, offset: Array, width: Array) -> tuple[Array, Array]:
    """(B, F, MODES) along both axes: means of normalised cosines over a contact (B, F, 2) of that length and offset
    m."""
    xp = namespace_of(length)
    half_waves = as_like(np.arange(1, MODES) * math.pi, length)
    found = []
    for axis in range(2):
        half = half_waves * (length / (2 * width))[..., axis, None]
        turn = half_waves * (offset / width + 0.5)[..., axis, None]
        each = math.sqrt(2.0) * xp.cos(turn) * xp.sin(half) / half
        found.append(xp.concatenate((1.0 + 0.0 * each[..., :1], each), -1))
    return found[0], found[1]


def _largest(closed: Array, area: Array) -> Array:
    """(B, F, S, O) of numbers, 1 where an object (B, F, O) is the S-th, in their order, of the largest that a fingertip
    touches."""
    xp = namespace_of(area)
    one, other = area[..., :, None], area[..., None, :]
    before = as_like(np.tri(area.shape[-1], k=-1), area)
    larger = xp.where(other > one, 1.0 + 0.0 * one * other, 0.0 * one * other)
    larger = larger + xp.where(other == one, before + 0.0 * one * other, 0.0 * one * other)
    rank = (larger * closed[..., None, :]).sum(-1)
    there = closed * xp.where(rank < SHARED, 1.0 + 0.0 * rank, 0.0 * rank)
    number = there.cumsum(-1)
    return xp.stack([there * xp.where(number == s + 1, 1.0, 0.0) for s in range(SHARED)], -2)
