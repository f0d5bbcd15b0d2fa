"""Where fingertips touch a box: rectangles on its faces, and which of them it remembers.

F: fingertips. Places are in m.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermograsp.compiled import njit

MOST_PLACES = 4
"""Of a box that are remembered, those under fingertips among them."""
NEAR, EDGE = 1 / 9, 1 / 15
"""Of the sensor's width: how far a fingertip may slide, and an edge of what is covered of its face, on one place."""
_LEAST = 1 / 16  # of the sensor's width, that a place covers at least where the box is as wide
_LATTICE, _FINE_LATTICE = 5e-4, 1e-4
"""m, on which later grasps share a network. Coarse: of places half a sensor's width and more from their face's edges,
counted from its middle, in a box that nothing has warmed. How far a place is from a warm one counts for .1 K a mm in
glass."""

_SIDES = (1, 2), (0, 2), (0, 1)  # axes of a face, by its normal

Rectangle = tuple[tuple[float, float], tuple[float, float]]
"""(low, high) along both axes of a face."""

BOX_ROW = np.dtype(
    [
        ("size", "f8", (3,)),
        ("pad", "f8", (2, 2)),
        ("face", "i8", (2,)),
        ("normal", "i8"),
        ("boxed", "u1"),
        ("middled", "u1"),
    ]
)
"""Of a row, for compiled code. size: m. pad, face: of each fingertip's place, see Place; face -1 for none. normal: the
axis on which the fingers close. boxed: whether it is a box at all. middled: wherever a fingertip touches, its place is
the middle of the face."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where a pad touches. face: of the box, 2 axis + side. middle: of the pad along the other two axes, from the box's
    corner."""

    face: int
    middle: tuple[float, float]

    def sides(self, size: Sequence[float]) -> tuple[float, float]:
        """m, the face's."""
        first, second = _SIDES[self.face // 2]
        return size[first], size[second]

    def covered(self, size: Sequence[float], width: float) -> Rectangle:
        """What the face covers of a sensor's of that width, from the sensor's corner, to a nanometre: of two places as
        far from their face's ends it is the same."""
        (x, y), (first, second) = self.middle, _SIDES[self.face // 2]
        return _covered(x, size[first], width), _covered(y, size[second], width)

    def serves(self, other: Place, size: Sequence[float], width: float) -> bool:
        """Whether a pad at the other place is on this one too."""
        if other.face != self.face:
            return False
        (x, y), (x0, y0) = self.middle, other.middle
        if abs(x - x0) > NEAR * width or abs(y - y0) > NEAR * width:
            return False
        (a, b), (c, d) = self.covered(size, width)
        (a0, b0), (c0, d0) = other.covered(size, width)
        return max(abs(a - a0), abs(b - b0), abs(c - c0), abs(d - d0)) <= EDGE * width


def _covered(middle: float, side: float, width: float) -> tuple[float, float]:
    low, high = width / 2 - middle, side - middle + width / 2
    return (max(round(low, 9), 0.0) if low > 0 else 0.0), (
        min(round(high, 9), width) if high < width else width
    )


def opposite(place: Place, places: Sequence[Place], width: float) -> Place | None:
    """The one on the face behind that a sensor of that width at the place is most nearly over; None for none."""
    behind = [other for other in places if other.face == (place.face ^ 1)]

    def distance(other: Place) -> float:
        return max(abs(a - b) for a, b in zip(place.middle, other.middle, strict=True))

    # of two as near, the same one in whatever order they come
    nearest = min(behind, key=lambda other: (distance(other), other.middle), default=None)
    return nearest if nearest is not None and distance(nearest) < width else None


@dataclass(frozen=True, slots=True)
class Touched:
    """Where a box has been touched; picklable. places: by number. contacts: (F,) the number of each fingertip's, -1 for
    none."""

    places: tuple[Place, ...]
    contacts: tuple[int, ...]

    @property
    def pressed(self) -> int:
        """How many of the places are under fingertips."""
        return sum(number >= 0 for number in self.contacts)

    def numbers(self) -> list[int]:
        """Of the places, those under fingertips first."""
        under = sorted(number for number in self.contacts if number >= 0)
        return [*under, *(number for number in range(len(self.places)) if number not in under)]

    def moved(
        self, fingertip: int, place: Place, warmth: Sequence[float], size: Sequence[float], width: float
    ) -> tuple[Touched, tuple[int, int] | None]:
        """(the same with the fingertip there, numbers of a place that is given up and of its heir, or None). Its place
        is one that serves; or replaces its last if nothing has flowed there; or another that no fingertip is on, if
        there would be too many. That is the one whose heat is least far from its heir by warmth, the nearest on its
        face; the heir is -1 where none is within a sensor's width, and the place itself where it is the new one that
        has taken its number. warmth: K of each place, 0 where nothing has flowed."""
        contacts, places = list(self.contacts), list(self.places)
        last, given_up = contacts[fingertip], None
        others = (*contacts[:fingertip], *contacts[fingertip + 1 :])
        free = [number for number in range(len(places)) if number not in others]
        serving = next((number for number in free if places[number].serves(place, size, width)), None)
        if serving is not None:
            number = serving
        elif last in free and warmth[last] == 0:
            number = last
        elif len(places) < MOST_PLACES:
            number = len(places)
        else:
            heirs = {number: _heir(number, places, place, width) for number in free}
            number = min(free, key=lambda number: warmth[number] * heirs[number][0] ** 2)
            given_up = number, heirs[number][1]
        if serving is None:
            places[number : number + 1] = [_on_lattice(place, size, width, coarse=not any(warmth))]
        contacts[fingertip] = number
        return Touched(tuple(places), tuple(contacts)), given_up


def _heir(number: int, places: Sequence[Place], new: Place, width: float) -> tuple[float, int]:
    """(m, at most a sensor's width, and whose) of the place nearest to that one on its face, with the new one in its
    number."""
    given_up, rest = places[number], [*places[:number], new, *places[number + 1 :]]
    nearest = width, -1
    for other, place in enumerate(rest):
        if place.face == given_up.face:
            distance = math.dist(place.middle, given_up.middle)
            nearest = min(nearest, (distance, other))
    return nearest


def place_of(size: Sequence[float], normal: int, width: float, middle: Sequence[float]) -> Place | None:
    """Of a pad across that axis whose middle (3,) m is there in the box's frame; None where the face ends before the
    sensor begins."""
    along = []
    for axis in _SIDES[normal]:
        side = size[axis]
        at = middle[axis] + side / 2
        if not -width / 2 < at < side + width / 2:
            return None
        beyond = width / 2 - min(_LEAST * width, side)
        along.append(min(max(at, -beyond), side + beyond))
    return Place(2 * normal + (middle[normal] > 0), (along[0], along[1]))


def _on_lattice(place: Place, size: Sequence[float], width: float, *, coarse: bool) -> Place:
    """coarse: that one is asked for, where the sensor's face lies well within the box's."""
    (x, y), (first, second) = place.middle, place.sides(size)
    return Place(place.face, (_nearest(x, first, width, coarse), _nearest(y, second, width, coarse)))


def _nearest(at: float, side: float, width: float, coarse: bool) -> float:
    """The same along one side."""
    off, room = at - side / 2, side / 2 - width
    if coarse and abs(off) <= room:
        rough = _LATTICE * round(off / _LATTICE)
        if abs(rough) <= room:
            return side / 2 + rough
    # over the face's end as much of the sensor's face as in another box
    low, high = at < width / 2, side - at < width / 2
    start = side / 2 if low == high else side * high
    return start + _FINE_LATTICE * round((at - start) / _FINE_LATTICE)


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
            if pressed and (row.face[f] < 0 if row.middled else _away(row, f, place[b, f], width)):
                found[count, 0], found[count, 1] = b, f
                count += 1
    return count


@njit(cache=True, inner=True, error_model="numpy")
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
