"""Where fingertips touch a box: rectangles on its faces, and which of them it remembers.

F: fingertips. Places are in m.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermograsp.compiled import njit

MOST_PLACES = 4
"""Of a box that are remembered, those under fingertips among them."""
NEAR, EDGE = 1 / 4, 1 / 15
"""Of the sensor's width: how far a fingertip may slide, and an edge of what is covered of its face, on one place."""
_LEAST = 1 / 16  # of the sensor's width, that a place covers at least where the box is as wide
_LATTICE, _FINE_LATTICE = 2e-3, 1e-4
"""m, on which later grasps share a network: of places half a sensor's width and more from their face's edges, counted
from its middle, where the coarse one changes drops by under .005 K, and of others."""

Rectangle = tuple[tuple[float, float], tuple[float, float]]
"""(low, high) along both axes of a face."""

BOX_ROW = np.dtype(
    [
        ("size", "f8", (3,)),
        ("pad", "f8", (2, 2)),
        ("face", "i8", (2,)),
        ("normal", "i8"),
        ("boxed", "u1"),
    ]
)
"""Of a row, for compiled code. size: m. pad, face: of each fingertip's place, see Place; face -1 for none. normal: the
axis on which the fingers close. boxed: whether it is a box at all."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where a pad touches. face: of the box, 2 axis + side. middle: of the pad along the other two axes, from the box's
    corner."""

    face: int
    middle: tuple[float, float]

    def sides(self, size: Sequence[float]) -> tuple[float, float]:
        """m, the face's."""
        first, second = (side for axis, side in enumerate(size) if axis != self.face // 2)
        return first, second

    def covered(self, size: Sequence[float], width: float) -> Rectangle:
        """What the face covers of a sensor's of that width, from the sensor's corner."""
        first, second = (
            (max(width / 2 - middle, 0.0), min(side - middle + width / 2, width))
            for middle, side in zip(self.middle, self.sides(size), strict=True)
        )
        return first, second

    def serves(self, other: Place, size: Sequence[float], width: float) -> bool:
        """Whether a pad at the other place is on this one too."""
        if other.face != self.face:
            return False
        apart = max(abs(a - b) for a, b in zip(self.middle, other.middle, strict=True))
        mine, theirs = np.array(self.covered(size, width)), np.array(other.covered(size, width))
        return apart <= NEAR * width and bool(np.abs(mine - theirs).max() <= EDGE * width)


@dataclass(frozen=True, slots=True)
class Touched:
    """Where a box has been touched; picklable. places: by number. contacts: (F,) the number of each fingertip's, -1 for
    none. order: of the numbers, first that which was taken up the longest ago."""

    places: tuple[Place, ...]
    contacts: tuple[int, ...]
    order: tuple[int, ...]

    def moved(self, fingertip: int, place: Place, idle: Sequence[bool], size: Sequence[float], width: float):
        """(the same with the fingertip there, the number whose field is lost or None). Its place is one that serves; or
        replaces its last if that is idle, its field and all; or the one taken up the longest ago by nobody who is
        still there, if there would be too many."""
        contacts, places = list(self.contacts), list(self.places)
        others = {number for f, number in enumerate(contacts) if f != fingertip}
        last, lost = contacts[fingertip], None
        free = [number for number in range(len(places)) if number not in others]
        serving = [number for number in free if places[number].serves(place, size, width)]
        if serving:
            number = serving[0]
        elif last in free and idle[last]:
            number = last
        elif len(places) < MOST_PLACES:
            number = len(places)
        else:
            number = lost = next(number for number in self.order if number in free)
        if not serving:
            places[number : number + 1] = [_on_lattice(place, size, width)]
        contacts[fingertip] = number
        order = (*(each for each in self.order if each != number), number)
        return Touched(tuple(places), tuple(contacts), order), lost


def place_of(row: np.void, width: float, middle: np.ndarray) -> Place | None:
    """Of a pad whose middle (3,) m is there in the box's frame; None where the face ends before the sensor begins.
    row: BOX_ROW."""
    normal, size = int(row["normal"]), row["size"]
    along = []
    for axis in range(3):
        if axis != normal:
            at, side = float(middle[axis] + size[axis] / 2), float(size[axis])
            beyond = width / 2 - min(_LEAST * width, side)
            if not -width / 2 < at < side + width / 2:
                return None
            along.append(min(max(at, -beyond), side + beyond))
    return Place(2 * normal + int(middle[normal] > 0), (along[0], along[1]))


def _on_lattice(place: Place, size: Sequence[float], width: float) -> Place:
    """Where the sensor's face lies well within the box's, its distance to edges hardly counts."""
    along = []
    for at, side in zip(place.middle, place.sides(size), strict=True):
        off, room = at - side / 2, side / 2 - width
        coarse, fine = (side / 2 + step * round(off / step) for step in (_LATTICE, _FINE_LATTICE))
        along.append(coarse if abs(coarse - side / 2) <= room and abs(off) <= room else fine)
    return Place(place.face, (along[0], along[1]))


@njit(cache=True, error_model="numpy")
def strayed(rows, force, place, tips, width, found):
    """Writes (row, fingertip) of those of `tips` fingertips that press on a box away from their place, or have none,
    into found (n, 2). Returns how many. rows: (B,) BOX_ROW. force: (B, S, F) N. place: (B, F, 3) m in its frame."""
    count = 0
    for b in range(len(rows)):
        row = rows[b]
        if row.boxed == 0:
            continue
        for f in range(tips):
            pressed = False
            for s in range(force.shape[1]):
                pressed |= force[b, s, f] > 0
            if pressed and _away(row, f, place[b, f], width):
                found[count, 0], found[count, 1] = b, f
                count += 1
    return count


@njit(cache=True, error_model="numpy")
def _away(row, f, middle, width):
    other, along = False, 0
    face = 2 * row.normal + (1 if middle[row.normal] > 0 else 0)
    other = face != row.face[f]
    for axis in range(3):
        if axis == row.normal:
            continue
        side, known = row.size[axis], row.pad[f, along]
        at = middle[axis] + side / 2
        along += 1
        if not -width / 2 < at < side + width / 2:
            return False  # the face ends before the sensor begins
        low = max(width / 2 - at, 0.0) - max(width / 2 - known, 0.0)
        high = min(side - at + width / 2, width) - min(side - known + width / 2, width)
        other |= max(abs(low), abs(high)) > EDGE * width or abs(at - known) > NEAR * width
    return other
