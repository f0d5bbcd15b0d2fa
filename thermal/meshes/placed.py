"""A body touched anywhere: its network from its modes and from what lies beneath a place.

The heat kernel between patches is that of the body's slow modes once heat has spread over a few millimetres, and before
that the local one: of a box as thick as the body is there and as wide as its face goes on, curved as it is (the terms
of first and second order in the curvature, from the impedances of cylinder and sphere). So a network is a function of
place in milliseconds. Where that box would not be the body (rims, edges, feet, layers of other materials), the kernel
is that of cells along the face, unrolled, in a few more (unrolled/), between places that feel each other there too.
Where the surface is curved too much for that or contents wet it, or heat goes too far along another material, a patch's
own impedance is a grid's that is fine there, in tenths of a second. Its states are the body's slowest modes, whatever
the place, and what fades sooner, at rates that are the same for all places, its residues positive
semidefinite. Contents behind a film on the walls of a hollow make modes of their own, and a wall that they wet has a
film at its other side.

P: patches, M: patterns, R: modes, T: times, S: moments.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import combinations
from typing import NamedTuple

import numpy as np
from scipy.special import erf

from thermograsp.errors import MeshError

from ..kernels import (
    FUNCTIONS,
    GRASP,
    NODES,
    OF_GRASP,
    TIMES,
    TO_MOMENTS,
    Patches,
    Resolution,
    Tip,
    at_rates,
    basis_jumps,
    basis_terms,
    before,
    box_kernel,
    tip,
)
from ..matter import SensorStack
from ..network import ThermalNetwork
from ..plates import Geometry
from ..surfaces import Solid, SurfacePatch
from ..unrolled import (
    Between,
    Face,
    Felt,
    Fineness,
    LocalCells,
    LocalKernel,
    Place,
    Spread,
    felt_patch,
    filmed,
    local_cells,
    overlapped,
    spread_beneath,
)
from .beneath import FLAT, ROUND, Beneath, beneath
from .film import Film, film_of, held_apart
from .grid import MeshGridding
from .modes import BodyModes, body_modes
from .network import PatchFields, patch_fields
from .patch import PatchPatterns, patch_on_grid
from .place import PlacedPatch
from .touched import PLATE, PLATE_MATERIAL, TouchedBody, geometry_of

LEVEL = Resolution(12, 3, slowest=3e-3)
PLACED_SHARE = 3.2e-3
"""Error of the drop of a touch, as a share of the first difference, at most: 0.034 K of 12 K in 181 touches of blocks,
bars, sheets, cylinders, balls, cones, rings, mugs and cans of wood, ceramic, steel and aluminium, and of bodies of two
materials, at 1e3 to 1e5 W/(m2 K) in the first 6 s (studies/meshes/mesh_places.py)."""
FILLED_SHARE = 4.4e-3
"""The same with contents: 0.44 % in 144 drawn touches of twelve vessels behind films of 50 to 1e4 W/(m2 K), at 1e3 to
1e4 W/(m2 K) in the first 20 s, nine of ten within 0.2 %; behind films of up to 500 W/(m2 K) all within 0.26 %
(studies/meshes/mesh_places.py --vessels). At 1e5 W/(m2 K) all were within 0.47 %."""
_SLOW = 60  # modes that are states
_SWITCH = 1e-5  # m2, diffusivity times time in the middle of going over from the local kernel to the modes, at least
_TOLD = 3.0  # over the last mode's rate above the first one's, likewise
_LAYERED = 100.0  # s, the same where there are several materials, whose cells tell layers late
_REACH = 9e-3  # m beyond a patch, that its heat is followed until then at least
_FARTHEST = 25e-3  # m, at most
_BOTH_WAYS = 0.01  # product of a face's curvatures times half widths, up to which it is unrolled
_TAKEN = 0.2  # the slowest rate behind a film over heat's along a cell, from which on modes tell no places
_FELT = 6e-3  # m between patches, across which heat goes before the modes tell
_STILL = 1e-12  # m2, diffusivity times time before which heat has gone nowhere
_KEPT = 256  # places
_PAIRS = 4096  # of places, a few kB each
_CELLS = 8  # places whose cells are kept, for what other places nearby feel of them
_ALIKE = 0.8  # cosine between the normals of two places on one face
_FARTHER = 0.35  # of a place, that may be near the end of what is cut into cells beneath another
_CORNER = 6e-3  # m beyond a patch, within which the wall of a hollow may go on round its face's end


class _Fineness(NamedTuple):
    """alone: the grid of a place where no box stands for the body, of one material, and layered: of several, which is
    as fine through all of the outer one where that is curved. pitch: between rates."""

    alone: MeshGridding
    layered: MeshGridding
    pitch: float


# within 0.006 K of 12 K of the usual grid, in half of the time
_COARSE = MeshGridding(depth=40e-6, side=0.1e-3, growth=0.8)
_EMPTY = _Fineness(_COARSE, _COARSE, 2.7)
# within 0.1 % of the difference of grids of three times as many cells
_FILLED = _Fineness(
    MeshGridding(depth=30e-6, side=0.1e-3, growth=0.6, relief=16), replace(_COARSE, relief=8), 1.8
)
_FIELDS = 64  # grids of such places, 2 to 8 MB each: two fingertips in eight worlds have 48


@dataclass(frozen=True, slots=True, eq=False)
class Placed:
    """A patch on a body. below: what lies there. seen: (M, R) of the modes by its patterns, 1/sqrt(J/K). local: its
    kernel on cells, at those of TIMES at which they tell anything. impedance: (S, M, M) K/W at GRASP, less that of the
    slow modes, from a grid that is fine there. None where another of them or the box tells."""

    below: Beneath
    seen: np.ndarray
    local: LocalKernel | None
    impedance: np.ndarray | None


@dataclass(frozen=True, slots=True, eq=False)
class PlacedNetwork:
    """network: of a body with M ports a patch, in orthonormal patterns of the sensor's whole face. Its output "heat" is
    the J that the body has gained, "mean" K; with contents also film_rows'. below: what lies beneath each
    patch. slow: of its states, the first ones that are the body's own, whatever the patches."""

    network: ThermalNetwork
    below: list[Beneath]
    slow: int


def placed_network(
    body: Solid,
    patches: Sequence[SurfacePatch],
    stack: SensorStack,
    film: float = 0.0,
    *,
    told: np.ndarray | None = None,
    cache: bool = True,
) -> PlacedNetwork:
    """film: W/K between the walls of the body's hollow, if it has one, and contents. told: (P M,) bool, the ports whose
    heat has states that fade sooner than the body's own; None: all of them. Raises MeshError where a patch meets no
    surface, or the body is no solid in one piece."""
    inside = film_of(body, film)
    found = face_impedance(body, patches, stack, inside, cache)
    seen = np.concatenate([place.seen for place in found.places])
    slow = _slow(found.modes, seen, inside)
    level = _EMPTY if inside is None else _FILLED
    return PlacedNetwork(
        _fitted(found, slow, found.impedance, level, told),
        [place.below for place in found.places],
        len(slow.fades),
    )


def own_network(body: Solid, film: float, *, cache: bool = True) -> ThermalNetwork:
    """The states of placed_network that are the body's own wherever it is touched, with its outputs and without ports.
    Arguments and errors as its."""
    inside = film_of(body, film)
    modes = body_modes(body, inside, cache=cache)
    return _slow(modes, np.zeros((0, len(modes.rates))), inside).network


class FaceImpedance(NamedTuple):
    """Of sensors' faces on a body. modes: the body's. one: the sensor's element under its contact. places: where the
    patches are. impedance: (S, P M, P M) K/W at GRASP, less that of the slow modes."""

    modes: BodyModes
    one: Tip
    places: list[Placed]
    impedance: np.ndarray


def face_impedance(
    body: Solid, patches: Sequence[SurfacePatch], stack: SensorStack, inside: Film | None, cache: bool
) -> FaceImpedance:
    """Raises as placed_network does."""
    level = _EMPTY if inside is None else _FILLED
    modes = body_modes(body, inside, cache=cache)
    one = centred_tip(stack, patches[0].area)
    places = [_placed(body, patch, stack, inside, level, cache) for patch in patches]
    below = [place.below for place in places]
    seen = np.concatenate([place.seen for place in places])
    taus = modes.diffusivity * TIMES
    slow = _slow(modes, seen, inside)
    kernel = _faded(seen, modes.rates, taus)
    over = _over(_told_by(body, modes))[:, None, None]
    if len(body.parts) == 1:
        conductivity = body.parts[0].material.conductivity
        local = _local(below, one, modes.diffusivity, conductivity, inside) / modes.capacity
        kernel = over * kernel + (1 - over) * local
    count, early = LEVEL.patterns, over[:, 0, 0] < 1
    at = [slice(n * count, (n + 1) * count) for n in range(len(places))]
    soon = np.zeros(kernel.shape[1:])  # K/W, before the first time
    for place, ports in zip(places, at, strict=True):
        if place.local is not None:
            told = _faded(place.seen, modes.rates, taus)
            told[early] += (1 - over[early]) * (place.local.kernel - told[early])
            kernel[:, ports, ports] = told
            soon[ports, ports] = np.sqrt(np.pi * TIMES[0]) * before(1.0) * told[0]
        else:
            soon[ports, ports] = before(modes.diffusivity) / (modes.capacity * one.area) * np.eye(count)
    grids = []
    for n, m in combinations(range(len(places)), 2):
        if not _close(places[n], places[m]):
            continue
        told = _beside(body, places[n], places[m], stack, inside, cache)
        if told is None:
            grids.append((n, m, _pair(body, patches[n], patches[m], stack, inside, level, cache)))
            continue
        late = _faded(places[n].seen, modes.rates, taus, places[m].seen)
        late[early] += (1 - over[early]) * (told - late[early])
        kernel[:, at[n], at[m]], kernel[:, at[m], at[n]] = late, late.transpose(0, 2, 1)
    kernel -= _faded(slow.held.T, slow.fades, TIMES)
    impedance = np.tensordot(TO_MOMENTS[OF_GRASP], kernel, axes=1) + soon
    for place, ports in zip(places, at, strict=True):
        if place.impedance is not None:
            impedance[:, ports, ports] = place.impedance
    for n, m, pair in grids:
        impedance[:, at[n], at[m]], impedance[:, at[m], at[n]] = pair, pair.transpose(0, 2, 1)
    return FaceImpedance(modes, one, places, impedance)


def ringed_network(
    found: FaceImpedance,
    seen: np.ndarray,
    kernel: np.ndarray,
    early: np.ndarray,
    told: np.ndarray | None = None,
) -> tuple[ThermalNetwork, int]:
    """Of an empty body's faces and of J other ports behind them, of even flows; and how many of its states are slow.
    seen: (J, R) of the modes by these. kernel: (T, P M + J, P M + J) 1/J K of the boxes beneath, at TIMES, before the
    modes tell; that of faces is known better. early: (J,) K/W of these before then. told: (P M + J,), as in
    placed_network."""
    modes, faces = found.modes, found.impedance.shape[1]
    every = np.concatenate((*(place.seen for place in found.places), seen))
    slow = _slow(modes, every, None, len(seen))
    taus = modes.diffusivity * TIMES
    over = _over(max(_SWITCH, _TOLD / (modes.rates[-1] - modes.rates[0])) / modes.diffusivity)[:, None, None]
    kernel = over * _faded(every, modes.rates, taus) + (1 - over) * kernel
    kernel -= _faded(slow.held.T, slow.fades, TIMES)
    impedance = np.tensordot(TO_MOMENTS[OF_GRASP], kernel, axes=1)
    others = np.arange(faces, len(every))
    impedance[:, others, others] += early
    impedance[:, :faces, :faces] = found.impedance
    return _fitted(found, slow, impedance, _EMPTY, told), len(slow.fades)


def _fitted(
    found: FaceImpedance, slow: _Slow, impedance: np.ndarray, level: _Fineness, told: np.ndarray | None
) -> ThermalNetwork:
    """The slow states and what fades sooner, of an impedance less that of the former: of the faces, then of others."""
    modes, one, count = found.modes, found.one, LEVEL.patterns
    faces = slice(0, len(found.places) * count, count)
    alone = impedance[:, faces, faces] + _impedance(slow.held.T[faces], slow.fades)
    weight = np.min([1 / (1 / one.weight + alone[:, n, n]) for n in range(len(found.places))], axis=0)
    slowest = max(modes.diffusivity * modes.rates[: _told(modes)][-1], LEVEL.slowest)
    number = max(4, math.ceil(math.log(LEVEL.fastest / slowest) / math.log(level.pitch)) + 1)
    fading, ports = at_rates(impedance, replace(LEVEL, rates=number, slowest=slowest), weight, told)
    none = np.zeros(len(fading))
    return ThermalNetwork(
        np.concatenate((slow.network.rates, fading)),
        np.concatenate((slow.network.ports, ports)),
        slow.network.direct,
        {name: np.concatenate((row, none)) for name, row in slow.network.outputs.items()},
    )


class _Slow(NamedTuple):
    """The states that are a body's own. network: by its ports. fades: (K,) 1/s and held: (K, M), its rates and ports
    while contents are held at one temperature; without any just those."""

    network: ThermalNetwork
    fades: np.ndarray
    held: np.ndarray


def _slow(modes: BodyModes, seen: np.ndarray, film: Film | None, others: int = 0) -> _Slow:
    """seen: (M, R) of the modes by the ports, of which the last `others` have one pattern."""
    even = np.tile(
        np.eye(LEVEL.patterns)[0], (len(seen) - others) // LEVEL.patterns
    )  # the mean of the first pattern alone is not 0
    even = np.concatenate((even, np.ones(others)))
    network = modes.network(seen[:, : _told(modes)], even, 0.0 if film is None else film.conductance)
    if film is None:
        return _Slow(network, network.rates, network.ports)
    fades, turn = held_apart(network, film.conductance)
    return _Slow(network, fades, turn.T @ network.ports)


def _told(modes: BodyModes) -> int:
    """How many modes are states. Where contents take the heat before it has gone a cell along, modes tell cells apart
    and no places, and the first alone is one."""
    cell = max(float(np.median(np.diff(edges))) for edges in modes.grid.edges)
    return 1 if modes.sink.any() and modes.rates[0] * cell**2 > _TAKEN else _SLOW


@lru_cache(maxsize=_KEPT)
def _placed(
    body: Solid, patch: SurfacePatch, stack: SensorStack, film: Film | None, level: _Fineness, cache: bool
) -> Placed:
    modes, one = body_modes(body, film, cache=cache), centred_tip(stack, patch.area)
    below = beneath(body.outside, patch, None if film is None else film.triangles)
    patterns = face_patterns(one)
    seen = _seen(modes, body.outside, below.placed, patterns) / np.sqrt(modes.capacity)
    rounds = film is not None and below.ends.min() < below.placed.half_width + _CORNER
    hollow = below.curvature.min() <= -FLAT  # heat goes outward there, and no box widens as such a wall does
    if below.plain and len(body.parts) == 1 and not rounds and not hollow:
        return Placed(below, seen, None, None)
    told = _told_by(body, modes)
    if (cells := _unrolled(body, below, stack, film, told)) is not None:
        return Placed(below, seen, cells.kernel(TIMES[_over(told) < 1]), None)
    fine, slow = _fields(body, patch, stack, film, level), _slow(modes, seen, film)
    fading = slice(1 if film is None else 0, None)  # the body's mean is on both grids
    impedance = _impedance(fine.ports[fading].T, fine.rates[fading])
    impedance -= _impedance(slow.held[fading].T, slow.fades[fading])
    return Placed(below, seen, None, impedance)


def is_touchable(
    body: Solid, patch: SurfacePatch, stack: SensorStack, film: float = 0.0, *, cache: bool = True
) -> bool:
    """Whether a body has a surface at a patch that can be touched. What is found out about the place is kept for its
    network. film: W/K to contents."""
    inside = film_of(body, film)
    try:
        _placed(body, patch, stack, inside, _EMPTY if inside is None else _FILLED, cache)
    except MeshError:
        return False
    return True


@lru_cache(maxsize=_CELLS)
def _unrolled(
    body: Solid, below: Beneath, stack: SensorStack, film: Film | None, told: float
) -> LocalCells | None:
    """What lies beneath a place that is no box, until the modes tell, told s. None where the surface is curved too
    much or contents wet it, or heat goes too far along another material."""
    farthest = max(part.material.diffusivity for part in body.parts) * told
    reach = _REACH if len(body.parts) == 1 else math.sqrt(farthest)
    bent = np.abs(below.curvature) * below.placed.half_width
    if bent.max() > ROUND or bent.prod() > _BOTH_WAYS or reach > _FARTHEST or below.within:
        return None
    bend = np.where(np.abs(below.curvature) < FLAT, 0.0, below.curvature)
    face = Face(below.placed.centre, np.stack((*below.placed.sides, below.placed.normal)), bend)
    half = below.placed.half_width
    place, one = Place(face, half, below.ends, below.depth), centred_tip(stack, 4 * half**2)
    reach = max(reach, _REACH)
    through = 0.0 if film is None else film.conductance / film.area
    return local_cells(body, _wetted(body, film), through, place, one, Fineness(reach, reach))


@lru_cache(maxsize=_FIELDS)
def _spread(body: Solid, place: Placed, stack: SensorStack, film: Film | None, cache: bool) -> Spread | None:
    """What flows through a place leaves on the cells beneath it, at those of TIMES at which they tell anything."""
    told = _told_by(body, body_modes(body, film, cache=cache))
    cells = _unrolled(body, place.below, stack, film, told)
    return None if cells is None else spread_beneath(cells, TIMES[_over(told) < 1])


@lru_cache(maxsize=_KEPT)
def _felt(body: Solid, place: Placed, stack: SensorStack) -> Felt | None:
    """A place as cells beneath others feel it."""
    placed = place.below.placed
    return felt_patch(body.outside, _flat(placed), placed.half_width, _tip_at(stack, place))


def _flat(placed: PlacedPatch) -> Face:
    return Face(placed.centre, np.stack((*placed.sides, placed.normal)), np.zeros(2))


def _tip_at(stack: SensorStack, place: Placed) -> Tip:
    return centred_tip(stack, 4 * place.below.placed.half_width**2)


@lru_cache(maxsize=_PAIRS)
def _beside(
    body: Solid, one: Placed, other: Placed, stack: SensorStack, film: Film | None, cache: bool
) -> np.ndarray | None:
    """(T, M, M) K/J between two places as the cells beneath both tell it, at those of TIMES at which they tell
    anything; as those alone that reach clearly farther beyond the other place. None where neither do."""
    first, second = (each.below.placed for each in (one, other))
    along = np.abs(first.sides @ (second.centre - first.centre))
    overlap = first.normal @ second.normal > _ALIKE and along.max() < 2 * first.half_width
    told: list[Between] = []
    for place, beside in ((one, other), (other, one)):
        if (spread := _spread(body, place, stack, film, cache)) is None:
            continue
        if overlap:
            found = overlapped(spread, _flat(beside.below.placed), _tip_at(stack, beside))
        else:
            felt = _felt(body, beside, stack)
            found = (
                None
                if felt is None
                else spread.felt(felt, None if beside.local is None else beside.local.turn)
            )
        if found is not None:
            told.append(found if place is other else found.turned_round)
    nearest = min((each.far for each in told), default=0.0) + _FARTHER
    kernels = [each.kernel for each in told if each.far < nearest]
    return np.mean(kernels, axis=0) if told else None


@lru_cache(maxsize=16)
def _wetted(body: Solid, film: Film | None) -> list[np.ndarray]:
    """(F,) of each part, whether its triangles are wet."""
    if film is None:
        return [np.zeros(len(part.faces), bool) for part in body.parts]
    walls = {each.tobytes() for each in film.triangles}
    return [np.array([each.tobytes() in walls for each in part.triangles]) for part in body.parts]


def _told_by(body: Solid, modes: BodyModes) -> float:
    """s, in the middle of going over from the local kernel to the modes."""
    if len(body.parts) > 1:
        return _LAYERED
    return max(_SWITCH, _TOLD / (modes.rates[-1] - modes.rates[0])) / modes.diffusivity


def _close(one: Placed, other: Placed) -> bool:
    """Whether one feels the other before the modes tell, where no box stands for the body beneath both."""
    if all(each.impedance is None and each.local is None for each in (one, other)):
        return False
    apart = one.below.placed.centre - other.below.placed.centre
    return float(np.linalg.norm(apart)) < 2 * one.below.placed.half_width + _FELT


@lru_cache(maxsize=_KEPT)
def _pair(
    body: Solid,
    one: SurfacePatch,
    other: SurfacePatch,
    stack: SensorStack,
    film: Film | None,
    level: _Fineness,
    cache: bool,
) -> np.ndarray:
    """(S, M, M) K/W at GRASP between two patches, less the slow modes': as the grid of the one has it of which no box
    tells, or the mean of both."""
    modes, patterns = body_modes(body, film, cache=cache), face_patterns(centred_tip(stack, one.area))
    first, second = (_placed(body, patch, stack, film, level, cache) for patch in (one, other))
    told, fading = [], slice(1 if film is None else 0, None)
    for place, patch, beside, turned in ((first, one, other, False), (second, other, one, True)):
        if place.impedance is not None or place.local is not None:
            fine = _fields(body, patch, stack, film, level)
            seen = fine.seen(body, beside, patterns)[fading].T
            between = _impedance(fine.ports[fading].T, fine.rates[fading], seen)
            told.append(between.transpose(0, 2, 1) if turned else between)
    count = len(first.seen)
    slow = _slow(modes, np.concatenate((first.seen, second.seen)), film)
    held = slow.held[fading].T
    return np.mean(told, axis=0) - _impedance(held[:count], slow.fades[fading], held[count:])


@lru_cache(maxsize=_FIELDS)
def _fields(
    body: Solid, patch: SurfacePatch, stack: SensorStack, film: Film | None, level: _Fineness
) -> PatchFields:
    gridding = level.alone if len(body.parts) == 1 else level.layered
    return patch_fields(body, [patch], face_patterns(centred_tip(stack, patch.area)), gridding, film)


def _faded(
    seen: np.ndarray, rates: np.ndarray, taus: np.ndarray, others: np.ndarray | None = None
) -> np.ndarray:
    """(T, M, M) of ports (M, R) whose states fade at these rates, or between these and others."""
    others = seen if others is None else others
    return np.einsum("ir,tr,jr->tij", seen, np.exp(-np.outer(taus, rates)), others, optimize=True)


def _impedance(seen: np.ndarray, rates: np.ndarray, others: np.ndarray | None = None) -> np.ndarray:
    """(S, M, M) K/W at GRASP of ports (M, R), or between these and others."""
    others = seen if others is None else others
    return np.einsum("ir,sr,jr->sij", seen, 1 / (GRASP[:, None] + rates), others, optimize=True)


def _over(told: float) -> np.ndarray:
    """(T,) how far the kernel at TIMES is the modes', from 0 to 1 within a factor of four around told, s."""
    over = np.clip((np.log2(TIMES / told) + 1) / 2, 0.0, 1.0)
    return over * over * (3 - 2 * over)


def placed_body(
    body: Solid,
    patches: Sequence[SurfacePatch],
    stack: SensorStack,
    difference: float,
    *,
    fingertips: int = 2,
    film: float = 0.0,
    cache: bool = True,
) -> TouchedBody:
    """As touched_body's, in milliseconds a place once its modes are known. difference: K between sensor and body at
    first, of which the error is PLACED_SHARE. film: W/K to contents, which it is FILLED_SHARE with. Raises as
    placed_network does."""
    patches = tuple(patches)
    placed = placed_network(body, patches, stack, film, cache=cache)
    one = centred_tip(stack, patches[0].area).side
    count = one.ports.shape[1]
    sensor = ThermalNetwork(one.rates, one.ports, np.zeros((count, count)), one.outputs)
    plate = Geometry(stack, PLATE_MATERIAL, "T", patches[0].area, "square", PLATE)
    geometry = geometry_of(plate, placed.network, body, fingertips)
    centres = np.array([each.placed.centre for each in placed.below])
    error = (FILLED_SHARE if film else PLACED_SHARE) * abs(difference)
    return TouchedBody(geometry, sensor, placed.network, patches, centres, error, placed.slow)


def centred_tip(stack: SensorStack, area: float) -> Tip:
    """The sensor's element under a square contact of m2 in the middle of its face."""
    low = (stack.width - min(area**0.5, stack.width)) / 2
    side = low, stack.width - low
    return tip(stack, (side, side), LEVEL)


def _seen(
    modes: BodyModes, triangles: np.ndarray, placed: PlacedPatch, patterns: PatchPatterns
) -> np.ndarray:
    """(M, R) of the modes by a patch's patterns, at the surface: a field that is level at the wall is a parabola from
    there to the first two nodes."""
    return seen_on_grid(modes, patch_on_grid(modes.grid, triangles, placed, patterns).shares, placed.normal)


def seen_on_grid(modes: BodyModes, shares: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """(M, R) of the modes by flows across that normal, spread over the cells of their grid by shares (N, M)."""
    grid = modes.grid
    cells = np.flatnonzero(shares.any(axis=1))
    each = shares[cells]
    seen = each.T @ modes.fields[cells]
    for axis, along in enumerate(normal):
        inward = grid.neighbours[cells, 2 * axis + (0 if along > 0 else 1)]
        met = inward >= 0
        rise = modes.fields[cells[met]] - modes.fields[inward[met]]
        seen += along**2 / 8 * each[met].T @ rise
    return seen


def face_patterns(one: Tip) -> PatchPatterns:
    """The tip's, by their integrals from the middle."""
    half = len(NODES) // 2
    edges = NODES[half:]
    flows = np.concatenate(
        (np.zeros((len(FUNCTIONS), 1)), np.cumsum(FUNCTIONS[:, half:] * np.diff(edges), axis=1)), axis=1
    )
    first = np.concatenate((one.basis[: len(FUNCTIONS)].T @ flows, np.zeros((0, len(edges)))))
    second = one.basis[len(FUNCTIONS) :].T @ flows[1:]
    sums = first.T[:, None] * edges[None, :, None] + edges[:, None, None] * second.T[None]
    return PatchPatterns(edges, sums)


def _local(
    below: Sequence[Beneath], one: Tip, diffusivity: float, conductivity: float, film: Film | None
) -> np.ndarray:
    """(T, P M, P M) 1/m3 at TIMES, of unit material: of patches by themselves and of those on the faces of one box;
    zero where no box stands for the body. diffusivity: m2/s. conductivity: W/(m K)."""
    count, taus = LEVEL.patterns, diffusivity * TIMES
    kernel = np.zeros((len(taus), len(below) * count, len(below) * count))
    at = [slice(n * count, (n + 1) * count) for n in range(len(below))]
    for n, each in enumerate(below):
        if not each.plain:
            continue
        bent = bent_room(each, taus)
        if each.wet and film is not None:
            through = film.conductance / film.area / conductivity
            round_ = each.depth * each.curvature.sum()
            through *= (1 - round_) / (1 - round_ / 2)  # what is wet of a round wall, by its middle
            bent = bent * filmed(taus, each.depth, through)[:, None, None]
        for m, other in enumerate(below):
            if (other.plain and m > n) or (met := _met(each, other, one, diffusivity)) is None:
                continue
            pair = bent * met
            kernel[:, at[n], at[m]], kernel[:, at[m], at[n]] = pair, pair.transpose(0, 2, 1)
    return kernel


@lru_cache(maxsize=_PAIRS)
def _met(each: Beneath, other: Beneath, one: Tip, diffusivity: float) -> np.ndarray | None:
    """(T, M, M) 1/m3 at TIMES of two patches on the box beneath the first, or of that one by itself; None where the
    second is not on it."""
    on, far = each.on_box(each.placed), each.on_box(other.placed)
    if on is None or far is None:
        return None
    count, taus = LEVEL.patterns, diffusivity * TIMES
    if other is each:
        return box_beneath(each, [on], one, taus)
    return box_beneath(each, [on, far], one, taus)[:, :count, count:]


def box_beneath(
    each: Beneath, others: Sequence[tuple[int, np.ndarray, np.ndarray]], one: Tip, taus: np.ndarray
) -> np.ndarray:
    """(T, M N, M N) 1/m3 between N patches of the box beneath one of them: a face, middle and half widths of each."""
    faces, middles, halves = zip(*others, strict=True)
    jumps = np.array([basis_jumps(one.basis)] * len(others))
    patches = Patches(np.array(faces), np.array(middles), np.array(halves))
    terms = basis_terms(LEVEL.patterns)
    kernel, _, port, _, _ = box_kernel(each.size, 1.0, 1.0, 0.0, patches, jumps, terms, len(others), taus)
    return kernel + np.outer(port, port)


def bent_room(each: Beneath, taus: np.ndarray) -> np.ndarray:
    """(T, 1, 1) of a flat body's kernel, by the surface's curvature: heat has less room under a round one. Through a
    wall's thickness, no further."""
    first, second = each.curvature
    reach = np.minimum(np.sqrt(np.pi * taus), each.depth)
    bend = (first + second) / 2 * reach
    bend = bend + (0.75 * (first**2 + second**2) + 0.5 * first * second) / np.pi * reach**2
    # heat that is even seen along the normal is thinner where the surface is slanted
    level = 1 - (first**2 + second**2) * each.placed.half_width**2 / 6
    across = _across(taus - each.depth**2 / np.pi, 2 * each.placed.half_width)
    return (level * (1 + bend * across))[:, None, None]


def _across(taus: np.ndarray, width: float) -> np.ndarray:
    """(T,) how much less heat stays under a patch of that width, m, per how much wider it is, after taus m2 along a
    wall: 1 at first. A round wall has less room than a flat one as long as heat goes through it; it goes along as far
    as along a flat one, unrolled in its middle."""
    part = width / np.sqrt(4 * np.maximum(taus, _STILL))
    lost = -np.expm1(-(part**2)) / (part * np.sqrt(np.pi))
    return 1 - lost / (erf(part) - lost)
