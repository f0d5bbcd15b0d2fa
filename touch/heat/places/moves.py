"""What becomes of an object's places when fingertips come to others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from .bodies import BodyField
from .forgetting import forgotten
from .place import NEAR, Place, near


class Moved(NamedTuple):
    """places and whole: of the object's network from now on. current: (F,) each fingertip's among these, -1 without."""

    places: tuple[Place, ...]
    whole: tuple[bool, ...]
    current: tuple[int, ...]


def moved(
    before: BodyField,
    current: Sequence[int],
    wanted: Mapping[int, Place],
    widths: Sequence[float] | np.ndarray,
    patterns: int,
    states: np.ndarray,
    most: int,
) -> Moved:
    """Of fingertips that are wanted at other places: such as are known near there, or new ones. current: (F,) and
    states: (n,) before. widths: (F,) m of the sensors. most: places besides those in use; beyond, others are
    forgotten. Wholly known are the places in use and those that a fingertip has just left: a place close by sees much
    of them. Where no fingertip's place is another, nothing changes."""
    now, places, left = list(current), list(before.places), set[int]()
    for f, place in wanted.items():
        reach = NEAR * float(widths[f])
        known = (number for number, one in enumerate(places) if near(one, place, reach))
        number = next(known, len(places))
        if number == len(places):
            places.append(place)
        if number != now[f]:
            left.add(now[f])
            now[f] = number
    if not left:
        return Moved(before.places, before.whole, tuple(current))
    idle = [number for number in range(len(before.places)) if number not in now]
    gone = forgotten(before, patterns, states, idle, len(idle) - most)
    kept = [number for number in range(len(places)) if number not in gone]
    return Moved(
        tuple(places[number] for number in kept),
        tuple(number in now or number in left for number in kept),
        tuple(kept.index(number) if number >= 0 else -1 for number in now),
    )
