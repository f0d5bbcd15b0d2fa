"""Columns of cells beneath a patch: where they begin and end along an unrolled face."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..numerics import graded_cells
from .rays import Face, cast

_ANGLE = 1.3  # rad, as far round as columns go
_LEAST_COVER = 0.1  # of a patch's width
_STEP = 0.1e-3  # m, between rays that look for where a body gets thicker or thinner
_JUMP = 0.3  # of the thickness, by which it changes from one to the next there
_DISTINCT = 0.2e-3  # m, between planes at least
_ASIDE = 1.3e-6  # m, beside edges of triangles


class Fineness(NamedTuple):
    """Of cells, m. first: under the face. side: along it at the patch's ends. least: where the thickness changes.
    growth: per distance from there, and largest. reach: beyond the patch, and deep below it, as far as they go.
    beyond: at the other side of a wall."""

    reach: float
    deep: float
    first: float = 0.25e-3
    side: float = 0.5e-3
    least: float = 0.3e-3
    growth: float = 0.45
    largest: float = 3e-3
    beyond: float = 0.3e-3


class Piece(NamedTuple):
    """A part of a body. triangles: (F, 3, 3) m along a face's axes. wet: (F,) whether contents wet them. conductivity:
    W/(m K). capacity: J/(m3 K). host: the number of the one that it lies in, or None."""

    triangles: np.ndarray
    wet: np.ndarray
    conductivity: float
    capacity: float
    host: int | None

    @property
    def surfaces(self) -> np.ndarray:
        """(F,) numbers of what rays meet: 2 where it is wet, 1 elsewhere."""
        return np.where(self.wet, 2, 1)


class Place(NamedTuple):
    """A square patch in the middle of a face. half: m, half its side, seen along the normal. ends: (2, 2) m from the
    middle along u and v, either way, to where the face ends. depth: m of the body below the middle."""

    face: Face
    half: float
    ends: np.ndarray
    depth: float


class Columns(NamedTuple):
    """Along u or v. edges: (n + 1,) m. face: m, from where to where the face goes, and covered: the patch on it."""

    edges: np.ndarray
    face: tuple[float, float]
    covered: tuple[float, float]


def columns(place: Place, pieces: Sequence[Piece], axis: int, fine: Fineness) -> Columns | None:
    """None where the patch hardly touches the face."""
    face = place.face
    bend, wide = abs(float(face.bend[axis])), face.along(place.half, axis)
    reach = min(wide + fine.reach, _ANGLE / bend if bend else np.inf)
    ends = [float(end) for end in place.ends[axis]]
    below, above = (reach if end * bend >= 1 else min(face.along(end, axis), reach) for end in ends)
    # no column is a sliver
    below, above = (reach if reach - end < _DISTINCT else end for end in (below, above))
    low, high = (end if end - wide < _DISTINCT else wide for end in (below, above))
    low = -low
    if high - low < _LEAST_COVER * wide:
        return None
    breaks = [-reach, *sorted({-below, low, high, above} - {-reach, reach}), reach]
    sizes = {low: fine.side, high: fine.side}
    for at in _jumps(place, pieces, axis, (low + high) / 2, reach):
        distance = min(abs(at - other) for other in breaks)
        if distance > _DISTINCT:
            breaks.append(at)
            sizes[at] = float(np.clip(distance / 2, fine.least, fine.side))
    return Columns(
        graded_cells(sorted(breaks), sizes, fine.growth, fine.largest), (-below, above), (low, high)
    )


def _jumps(place: Place, pieces: Sequence[Piece], axis: int, middle: float, reach: float) -> list[float]:
    """m along an axis of the face, where the body beneath it gets thicker or thinner at once."""
    places = np.arange(-reach, reach, _STEP) + _ASIDE
    across = np.array([_ASIDE if place.face.bend[axis] else middle + _ASIDE])
    u, v = (places, across) if axis == 0 else (across, places)
    thickness = np.zeros(len(places))
    for piece in pieces:
        if piece.host is None:
            hits = cast(place.face, piece.triangles, piece.surfaces, u, v, 2 * place.half, 2 * reach)
            heights, surfaces = (each.reshape(len(places), -1) for each in (hits.heights, hits.surfaces))
            bottom = np.where(surfaces[:, 1] < 0, heights[:, 1], -reach)
            thickness = np.maximum(thickness, np.where(surfaces[:, 0] > 0, heights[:, 0] - bottom, 0.0))
    thickness = np.minimum(thickness, reach)
    thinner = np.minimum(thickness[1:], thickness[:-1])
    jump = np.abs(np.diff(thickness)) > _JUMP * thinner + _STEP
    return ((places[1:] + places[:-1]) / 2)[jump].tolist()
