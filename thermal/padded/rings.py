"""Rings of a pad's front around the element's face: where they lie, and how a box sees them.

A box knows even flows over rectangles. A ring is what a square has more than the one before it, the face first.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..matter import Surround

RINGS = 3
WIDTHS = np.cumsum([1.0, 2.0, 4.0]) / 7.0
"""(RINGS,) of the way from the face's edge to the pad's, where each ring ends."""
RING_PORTS = slice(1, 1 + RINGS)
"""Of the ports of a padded contact, flows into the pad around the face, the first of them even. Before them is an even
flow into the face, and behind them what is crowded toward its edges."""
_SEEN = 1e-6  # of a ring and what is in it, below which nothing of the ring touches


def ring_sides(width: float, surround: Surround) -> tuple[float, ...]:
    """(RINGS,) m, the outer sides of the rings of a pad's front around an element of that width m."""
    return nested_sides(width, surround.width)


def nested_sides(face: float, front: float) -> tuple[float, ...]:
    """(RINGS,) m, the outer sides of rings from a square face of that side to a front of that side m."""
    return tuple((face + (front - face) * WIDTHS).tolist())


def to_rings(
    impedance: np.ndarray,
    turn: np.ndarray,
    face: tuple[slice, np.ndarray],
    squares: Sequence[int],
    areas: Sequence[float],
    early: float,
    first: int,
) -> None:
    """Makes columns of turn (rows, ports) flows into rings, of one pad: from number `first` on, zeros for a ring of
    which nothing touches. Adds to the impedance (S, rows, rows) K/W of the box what heat has done between a square and
    what lies in it before kernels are known. face: rows of its patterns and their means. squares: rows of the even
    flows over the squares, ascending. areas: m2 of the face, then of these. early: K m2/W, of a half-space before
    then."""
    rows, means = face
    inner = [(row, np.ones(1)) for row in (slice(square, square + 1) for square in squares)]
    inner.insert(0, (rows, means))
    for ring, square in enumerate(squares):
        whole, within = areas[ring + 1], areas[ring]
        for row, mean in inner[: ring + 1]:
            # a half-space under the square's even flow
            impedance[:, row, square] += early / whole * mean
            impedance[:, square, row] += early / whole * mean
        if whole - within > _SEEN * whole:
            turn[square, first + ring] = whole / (whole - within)
            turn[inner[ring][0].start, first + ring] = -within / (whole - within)
