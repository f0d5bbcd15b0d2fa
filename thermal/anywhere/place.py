"""A place on a body, and what tells its heat kernel there before the modes do: the box beneath, cells along the face,
or a grid that is fine at the patch.

M: patterns, R: modes, S: moments.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from thermograsp.errors import MeshError

from ..kernels import TIMES
from ..matter import SensorStack
from ..meshes import Film, MeshGridding, PatchFields, body_modes, film_of, patch_fields
from ..surfaces import Solid, SurfacePatch
from ..unrolled import Face, Fineness, LocalCells, LocalKernel, Place, local_cells
from .beneath import FLAT, ROUND, Beneath, beneath
from .ports import centred_tip, face_patterns, seen_by_face
from .slow import crossover_time, modal_impedance, modal_share, slow_states

_REACH = 9e-3  # m beyond a patch, that its heat is followed until then at least
_FARTHEST = 25e-3  # m, at most
_ROD = 0.5  # curvature times half width, up to which a rod of one material without contents is unrolled, and
_THINNEST = 9e-3  # m, its radius at least, round which heat does not go before the modes tell
_BOTH_WAYS = 0.01  # product of a face's curvatures times half widths, up to which it is unrolled
_KEPT = 256  # places
_CELLS = 8  # places whose cells are kept, for what other places nearby feel of them
_CORNER = 6e-3  # m beyond a patch, within which the wall of a hollow may go on round its face's end
_FIELDS = 64  # grids of such places, 2 to 8 MB each: two fingertips in eight worlds have 48


class GridFineness(NamedTuple):
    """alone: the grid of a place where no box stands for the body, of one material, and layered: of several, which is
    as fine through all of the outer one where that is curved. pitch: between rates."""

    alone: MeshGridding
    layered: MeshGridding
    pitch: float


# within 0.006 K of 12 K of the usual grid, in half of the time
_COARSE = MeshGridding(depth=40e-6, side=0.1e-3, growth=0.8)
EMPTY = GridFineness(_COARSE, _COARSE, 2.7)
# within 0.1 % of the difference of grids of three times as many cells
FILLED = GridFineness(
    MeshGridding(depth=30e-6, side=0.1e-3, growth=0.6, relief=16), replace(_COARSE, relief=8), 1.8
)


@dataclass(frozen=True, slots=True, eq=False)
class Placed:
    """A patch on a body. below: what lies there. seen: (M, R) of the modes by its patterns, 1/sqrt(J/K). local: its
    kernel on cells, at those of TIMES at which they tell anything. impedance: (S, M, M) K/W at GRASP, less that of the
    slow modes, from a grid that is fine there. None where another of them or the box tells."""

    below: Beneath
    seen: np.ndarray
    local: LocalKernel | None
    impedance: np.ndarray | None


@lru_cache(maxsize=_KEPT)
def placed_at(
    body: Solid, patch: SurfacePatch, stack: SensorStack, film: Film | None, level: GridFineness, cache: bool
) -> Placed:
    """Raises MeshError where the patch meets no surface that can be touched, or the body is no solid in one piece."""
    modes, one = body_modes(body, film, cache=cache), centred_tip(stack, patch.area)
    below = beneath(body.outside, patch, None if film is None else film.triangles)
    patterns = face_patterns(one)
    seen = seen_by_face(modes, body.outside, below.placed, patterns) / np.sqrt(modes.capacity)
    rounds = film is not None and below.ends.min() < below.placed.half_width + _CORNER
    hollow = below.curvature.min() <= -FLAT  # heat goes outward there, and no box widens as such a wall does
    if below.plain and len(body.parts) == 1 and not rounds and not hollow:
        return Placed(below, seen, None, None)
    crossover = crossover_time(modes, len(body.parts))
    if (cells := unrolled_cells(body, below, stack, film, crossover)) is not None:
        return Placed(below, seen, cells.kernel(TIMES[modal_share(crossover) < 1]), None)
    fine, slow = place_fields(body, patch, stack, film, level), slow_states(modes, seen, film)
    fading = slice(1 if film is None else 0, None)  # the body's mean is on both grids
    impedance = modal_impedance(fine.ports[fading].T, fine.rates[fading])
    impedance -= modal_impedance(slow.held[fading].T, slow.fades[fading])
    return Placed(below, seen, None, impedance)


def is_touchable(
    body: Solid, patch: SurfacePatch, stack: SensorStack, film: float = 0.0, *, cache: bool = True
) -> bool:
    """Whether a body has a surface at a patch that can be touched. What is found out about the place is kept for its
    network. film: W/K to contents."""
    inside = film_of(body, film)
    try:
        placed_at(body, patch, stack, inside, EMPTY if inside is None else FILLED, cache)
    except MeshError:
        return False
    return True


@lru_cache(maxsize=_CELLS)
def unrolled_cells(
    body: Solid, below: Beneath, stack: SensorStack, film: Film | None, crossover: float
) -> LocalCells | None:
    """What lies beneath a place that is no box, until the modes tell, told s. None where the surface is curved too
    much or contents wet it, or heat goes too far along another material."""
    farthest = max(part.material.diffusivity for part in body.parts) * crossover
    reach = _REACH if len(body.parts) == 1 else math.sqrt(farthest)
    bent = below.curvature * below.placed.half_width
    rod = film is None and len(body.parts) == 1 and below.curvature.max() < 1 / _THINNEST
    most = _ROD if rod else ROUND
    curved = bent.max() > most or bent.min() < -ROUND or abs(bent.prod()) > _BOTH_WAYS
    if curved or reach > _FARTHEST or below.within:
        return None
    bend = np.where(np.abs(below.curvature) < FLAT, 0.0, below.curvature)
    face = Face(below.placed.centre, np.stack((*below.placed.sides, below.placed.normal)), bend)
    half = below.placed.half_width
    place, one = Place(face, half, below.ends, below.depth), centred_tip(stack, 4 * half**2)
    reach = max(reach, _REACH)
    through = 0.0 if film is None else film.conductance / film.area
    return local_cells(body, _wetted(body, film), through, place, one, Fineness(reach, reach))


@lru_cache(maxsize=16)
def _wetted(body: Solid, film: Film | None) -> list[np.ndarray]:
    """(F,) of each part, whether its triangles are wet."""
    if film is None:
        return [np.zeros(len(part.faces), bool) for part in body.parts]
    walls = {each.tobytes() for each in film.triangles}
    return [np.array([each.tobytes() in walls for each in part.triangles]) for part in body.parts]


@lru_cache(maxsize=_FIELDS)
def place_fields(
    body: Solid, patch: SurfacePatch, stack: SensorStack, film: Film | None, level: GridFineness
) -> PatchFields:
    """The states of a grid that is fine at a patch, with their fields."""
    gridding = level.alone if len(body.parts) == 1 else level.layered
    return patch_fields(body, [patch], face_patterns(centred_tip(stack, patch.area)), gridding, film)
