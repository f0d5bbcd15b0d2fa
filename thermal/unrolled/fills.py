"""How much of each cell beneath a face its rays find filled, and where contents wet what they find.

A, B: rays along u and v, two a column each way. K: cells along w.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

from ..numerics import graded_cells
from .columns import Fineness
from .rays import Hits

_BIN = 50e-6  # m, of heights that are looked for where many rays enter or leave
_NEXT = 1.5  # bins from a plane of cells, within which a height is moved into it
_MANY = 0.03  # of the rays
_SLANTED = 0.5  # least cosine by which a wet face is as much larger
_THICK = 4.0  # cells at the other side of a wall, thinner than which it has none that are finer
_SLIVER = 20e-6  # m
_ON = 1e-9  # m, from a plane


def planes(hits: Sequence[Hits], above: float, fine: Fineness) -> np.ndarray:
    """(K + 1,) m edges of cells along w, with planes where many rays enter or leave. Heights next to these are moved
    into them. above: m, as far above the face as there may be material."""
    for each in hits:  # slivers hold no heat to speak of
        each.heights[np.abs(each.heights) < _SLIVER] = 0.0
    bins, high = np.zeros(int((fine.deep + above) / _BIN) + 2, np.int64), 0.0
    for each in hits:
        within = (each.heights > -fine.deep) & (each.heights <= above) & (np.abs(each.heights) > _ON)
        heights = each.heights[(each.surfaces != 0) & within]
        high = max(high, float(heights.max(initial=0.0)))
        bins += np.bincount(((heights + fine.deep) / _BIN).astype(np.int64), minlength=len(bins))
    breaks = [-fine.deep, 0.0, high] if high > _BIN else [-fine.deep, 0.0]
    around = np.convolve(bins, [1, 1, 1], "same")
    while around.max() >= _MANY * hits[0].surfaces[..., 0].size:
        most = int(around.argmax())
        within = np.arange(max(most - 1, 0), min(most + 2, len(bins)))
        middle = _BIN * float((within + 0.5) @ bins[within] / bins[within].sum()) - fine.deep
        around[max(most - 3, 0) : most + 4] = 0
        covers = [
            (np.abs(each.heights - middle) < _NEXT * _BIN)
            & (np.abs(each.heights) > _ON)
            & (each.surfaces != 0)
            for each in hits
        ]
        at = float(np.mean(np.concatenate([each.heights[m] for each, m in zip(hits, covers, strict=True)])))
        if abs(at) < 2 * _BIN:  # not the other side of a wall that is as thin
            at, covers = 0.0, [m & (each.surfaces > 0) for each, m in zip(hits, covers, strict=True)]
        elif min(abs(at - other) for other in breaks) > 2 * _BIN:
            breaks.append(at)
        else:
            continue
        for each, m in zip(hits, covers, strict=True):
            each.heights[m] = at
    sizes = {0.0: fine.first}
    for at in breaks[1:]:  # no cell is thinner than the first
        if at and min(abs(at - other) for other in breaks if other != at) > _THICK * fine.beyond:
            sizes[at] = fine.beyond
    return graded_cells(sorted(breaks), sizes, fine.growth, fine.largest)


class Fill(NamedTuple):
    """solid: (A, B, K) of each ray in each cell that is filled. void: that is empty and wet. ends: (A, B, K) of wet
    faces that a ray meets, over the cosine to it."""

    solid: np.ndarray
    void: np.ndarray
    ends: np.ndarray


def fill(hits: Hits, w: np.ndarray) -> Fill:
    """w: (K + 1,) m edges of cells. What is wet has number 2."""
    shape = (*hits.surfaces.shape[:2], len(w) - 1)
    found = Fill(np.zeros(shape), np.zeros(shape), np.zeros(shape))
    _fill(*hits, w, *found)
    return found


def wet_area(
    solid: np.ndarray, fills: Sequence[Fill], w: np.ndarray, du: np.ndarray, dv: np.ndarray
) -> np.ndarray:
    """(A, B, K) m2 of each ray in each cell that is wet, along a flat face: what rays meet, and what is beside them
    where a wall is so steep that they do not. du: (A,), dv: (B,) m between rays."""
    void = np.minimum(sum(each.void for each in fills), 1 - solid)
    wet = sum(each.ends for each in fills) * du[:, None, None] * dv[:, None]
    for axis, (step, other) in enumerate(((du, dv), (dv, du))):
        full, empty, found = (np.moveaxis(each, axis, 0) for each in (solid, void, wet))
        for here, far_side in ((slice(None, -1), slice(1, None)), (slice(1, None), slice(None, -1))):
            beside = np.minimum(full[here], empty[far_side]) * np.diff(w)
            steep = beside.sum(axis=-1, keepdims=True) > np.maximum(step[1:], step[:-1])[:, None, None]
            found[here] += np.where(steep, beside, 0.0) * other[:, None]
    return wet


@njit(cache=True, error_model="numpy")
def _fill(heights, surfaces, slopes, w, solid, void, ends):
    cells = len(w) - 1
    for a in range(heights.shape[0]):
        for b in range(heights.shape[1]):
            inside, top, wet = 0, w[cells], False
            for n in range(heights.shape[2]):
                code = surfaces[a, b, n]
                last = code == 0
                at = w[0] if last else heights[a, b, n]
                was = inside > 0
                inside += 1 if code > 0 else (-1 if code < 0 else 0)
                filled, meets_wet = inside > 0, abs(code) == 2
                if filled == was and not last:
                    continue
                low, high = max(at, w[0]), min(top, w[cells])
                if high > low and (was or wet or meets_wet):
                    for k in range(cells):
                        part = min(high, w[k + 1]) - max(low, w[k])
                        if part > 0 and was:
                            solid[a, b, k] += part / (w[k + 1] - w[k])
                        elif part > 0:
                            void[a, b, k] += part / (w[k + 1] - w[k])
                if meets_wet and w[0] < at <= w[cells] + _ON:
                    k = 0  # the cell on the body's side
                    while w[k + 1] < at - _ON if filled else w[k + 1] <= at + _ON:
                        k += 1
                    ends[a, b, min(k, cells - 1)] += 1 / max(slopes[a, b, n], _SLANTED)
                top, wet = at, meets_wet
                if last:
                    break
