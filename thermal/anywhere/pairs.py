"""Two places near each other: what the one feels of the other's heat before the modes tell, by cells or by grids.

M: patterns, T: times, S: moments.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..kernels import TIMES, Tip
from ..matter import SensorStack
from ..meshes import Film, PlacedPatch, body_modes
from ..surfaces import Solid, SurfacePatch
from ..unrolled import Between, Face, SensedPatch, Spread, overlapped, sensed_patch, spread_beneath
from .place import GridFineness, Placed, place_fields, placed_at, unrolled_cells
from .ports import centred_tip, face_patterns
from .slow import crossover_time, modal_impedance, modal_share, slow_states

_NEAR = 6e-3  # m between patches, across which heat goes before the modes tell
_KEPT = 256  # places
_PAIRS = 4096  # of places, a few kB each
_ALIKE = 0.8  # cosine between the normals of two places on one face
_FARTHER = 0.35  # of a place, that may be near the end of what is cut into cells beneath another
_SPREADS = 64  # places whose heat is kept on the cells beneath


def are_close(one: Placed, other: Placed) -> bool:
    """Whether one feels the other before the modes tell, where no box stands for the body beneath both."""
    if all(each.impedance is None and each.local is None for each in (one, other)):
        return False
    offset = one.below.placed.centre - other.below.placed.centre
    return float(np.linalg.norm(offset)) < 2 * one.below.placed.half_width + _NEAR


@lru_cache(maxsize=_PAIRS)
def between_on_cells(
    body: Solid, one: Placed, other: Placed, stack: SensorStack, film: Film | None, cache: bool
) -> np.ndarray | None:
    """(T, M, M) K/J between two places as the cells beneath both tell it, at those of TIMES at which they tell
    anything; as those alone that reach clearly farther beyond the other place. None where neither do."""
    first, second = (each.below.placed for each in (one, other))
    along = np.abs(first.sides @ (second.centre - first.centre))
    overlap = first.normal @ second.normal > _ALIKE and along.max() < 2 * first.half_width
    seen_between: list[Between] = []
    for place, beside in ((one, other), (other, one)):
        if (spread := _spread(body, place, stack, film, cache)) is None:
            continue
        if overlap:
            found = overlapped(spread, _flat(beside.below.placed), _tip_at(stack, beside))
        else:
            sensed = _felt_patch(body, beside, stack)
            found = (
                None
                if sensed is None
                else spread.sensed_by(sensed, None if beside.local is None else beside.local.turn)
            )
        if found is not None:
            seen_between.append(found if place is other else found.turned_round)
    nearest = min((each.far for each in seen_between), default=0.0) + _FARTHER
    kernels = [each.kernel for each in seen_between if each.far < nearest]
    return np.mean(kernels, axis=0) if seen_between else None


@lru_cache(maxsize=_KEPT)
def between_on_grids(
    body: Solid,
    one: SurfacePatch,
    other: SurfacePatch,
    stack: SensorStack,
    film: Film | None,
    level: GridFineness,
    cache: bool,
) -> np.ndarray:
    """(S, M, M) K/W at GRASP between two patches, less the slow modes': as the grid of the one has it of which no box
    tells, or the mean of both."""
    modes, patterns = body_modes(body, film, cache=cache), face_patterns(centred_tip(stack, one.area))
    first, second = (placed_at(body, patch, stack, film, level, cache) for patch in (one, other))
    curves, fading = [], slice(1 if film is None else 0, None)
    for place, patch, beside, turned in ((first, one, other, False), (second, other, one, True)):
        if place.impedance is not None or place.local is not None:
            fine = place_fields(body, patch, stack, film, level)
            seen = fine.seen(body, beside, patterns)[fading].T
            between = modal_impedance(fine.ports[fading].T, fine.rates[fading], seen)
            curves.append(between.transpose(0, 2, 1) if turned else between)
    count = len(first.seen)
    slow = slow_states(modes, np.concatenate((first.seen, second.seen)), film)
    held = slow.held[fading].T
    return np.mean(curves, axis=0) - modal_impedance(held[:count], slow.fades[fading], held[count:])


@lru_cache(maxsize=_SPREADS)
def _spread(body: Solid, place: Placed, stack: SensorStack, film: Film | None, cache: bool) -> Spread | None:
    """What flows through a place leaves on the cells beneath it, at those of TIMES at which they tell anything."""
    crossover = crossover_time(body_modes(body, film, cache=cache), len(body.parts))
    cells = unrolled_cells(body, place.below, stack, film, crossover)
    return None if cells is None else spread_beneath(cells, TIMES[modal_share(crossover) < 1])


@lru_cache(maxsize=_KEPT)
def _felt_patch(body: Solid, place: Placed, stack: SensorStack) -> SensedPatch | None:
    """A place as cells beneath others feel it."""
    placed = place.below.placed
    return sensed_patch(body.outside, _flat(placed), placed.half_width, _tip_at(stack, place))


def _flat(placed: PlacedPatch) -> Face:
    return Face(placed.centre, np.stack((*placed.sides, placed.normal)), np.zeros(2))


def _tip_at(stack: SensorStack, place: Placed) -> Tip:
    return centred_tip(stack, 4 * place.below.placed.half_width**2)
