"""A body touched anywhere by sensors in pads: its network through their faces, and through rings of the pads around.

Heat through a ring passes the pad's silicone, which resists more than most bodies do. What the body is to a ring may
thus be known less exactly than under the face (placed.py): even flow into what the ring covers of the surface, on the
modes of the whole body once heat has spread, and before that on the box beneath the place.

P: patches, M: patterns, R: rings, T: times.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.linalg import block_diag

from ..kernels import TIMES, before
from ..matter import SensorStack
from ..meshes import (
    BodyModes,
    PlacedPatch,
    area_within,
    body_modes,
    nearest_surface,
    patch_on_grid,
    patch_sides,
    place_patch,
    uniform_pattern,
)
from ..network import ThermalNetwork
from ..surfaces import FACING, Solid, SurfacePatch, crossings, depths, twice_areas
from .beneath import Beneath
from .box import bent_room, box_beneath
from .place import is_touchable
from .placed import FaceImpedance, face_impedance, placed_network, ringed_network
from .ports import LEVEL, seen_on_grid

_UPRIGHT = math.cos(math.radians(10.0))  # a surface this near to an axis is taken as across it
_FARTHER = 2.0  # than the nearest point, that a place may be on the line across the surface
_SAMPLED = np.array(
    [[x, y] for x in np.linspace(-0.9, 0.9, 7) for y in np.linspace(-0.9, 0.9, 7)]
)  # half sides
_LEAST = 1e-3  # of a square, below which nothing of the ring around it touches


@dataclass(frozen=True, slots=True, eq=False)
class _Squares:
    """Squares around a place, the face first, and rings between. placed: where. areas: (1 + R,) m2 of the body's
    surface in the squares. rings: (R, modes) of the body's modes by even flows into the rings."""

    placed: tuple[PlacedPatch, ...]
    areas: np.ndarray
    rings: np.ndarray


def body_in_pads(
    body: Solid,
    patches: Sequence[SurfacePatch],
    stack: SensorStack,
    sides: tuple[float, ...],
    *,
    whole: Sequence[bool] | None = None,
    film: float = 0.0,
    cache: bool = True,
) -> tuple[ThermalNetwork, np.ndarray, int]:
    """The body's network of P M ports, in orthonormal patterns of the sensor's whole face, its output "heat" the J that
    it has gained; (n, P R) ports of even flows into rings of the pads around; and how many of its states, the first
    ones, are the body's own wherever it is touched. sides: (R,) m, the rings' outer sides, none without pads. whole:
    whether rings are told of a place, and of all its ports what fades sooner, or of the face's even one alone; None: of
    all places. film: W/K to contents, of sensors without pads. Raises MeshError where a patch meets no surface, or the
    body is no solid in one piece."""
    if not sides:
        alone = placed_network(body, patches, stack, film, whole=whole, cache=cache)
        return alone.network, np.zeros((len(alone.network.rates), 0)), alone.slow
    found = face_impedance(body, patches, stack, None, cache, whole)
    around = {
        n: _squares(body, patch, (stack.width, *sides), cache)
        for n, patch in enumerate(patches)
        if not found.told.even[n]
    }
    modes, faces, rings = found.modes, len(patches) * LEVEL.patterns, len(sides)
    kernel = _local(found, around, modes.diffusivity * TIMES) / modes.capacity
    areas = np.array([np.diff(each.areas) for each in around.values()]).ravel()
    some = areas > _LEAST * stack.face_area
    early = some * before(modes.diffusivity) / (modes.capacity * np.where(some, areas, 1.0))
    seen = np.concatenate([found.places[0].seen[:0], *(each.rings for each in around.values())])
    made, slow = ringed_network(found, seen, kernel, early)
    ports, beside = made.ports, np.zeros((len(made.rates), len(patches) * rings))
    beside[:, [n * rings + r for n in around for r in range(rings)]] = ports[:, faces:]
    network = replace(made, ports=ports[:, :faces], direct=made.direct[:faces, :faces])
    return network, beside, slow


def surface_patch(
    body: Solid,
    centre: np.ndarray,
    outward: np.ndarray,
    stack: SensorStack,
    film: float = 0.0,
    *,
    cache: bool = True,
) -> SurfacePatch:
    """The sensor's face on the surface that looks along an outward unit vector, across it: where a line that way
    through a place (3,) m leaves the body, or at the nearest point where the line meets it far from there. Where
    nothing of the surface there can be touched, since the body covers it or it is too steep, at the nearest point of
    all the surface, or else where the body reaches farthest that way: simulations touch a mesh's hull, which spans
    openings. film: W/K to contents."""
    places = _places(body.outside, centre, outward, stack.width / 2)
    patches = (SurfacePatch(*place, stack.face_area) for place in places)
    patch = next(patches)
    while not is_touchable(body, patch, stack, film, cache=cache):
        following = next(patches, None)
        if following is None:
            break
        patch = following
    return patch


_Triple = tuple[float, float, float]


def _places(
    triangles: np.ndarray, centre: np.ndarray, outward: np.ndarray, half: float
) -> Iterator[tuple[_Triple, _Triple]]:
    """Places on the surface and their normals, as surface_patch tries them."""
    across = twice_areas(triangles)
    facing = triangles[across @ outward > FACING * np.linalg.norm(across, axis=1)]
    facing = facing if len(facing) else triangles
    at, normal = nearest_surface(facing, centre)
    crossed = crossings(triangles, centre, outward)
    if len(crossed):
        along = crossed[np.argmin(np.abs(crossed))]
        if abs(along) < _FARTHER * np.linalg.norm(at - centre) + half:
            at, normal = nearest_surface(facing, centre + along * outward)
    yield _triple(at), _triple(outward if normal @ outward > _UPRIGHT else normal)
    at, normal = nearest_surface(triangles, centre)
    yield _triple(at), _triple(normal)
    middles = facing.mean(axis=1)
    yield _triple(middles[np.argmax(middles @ outward)]), _triple(outward)


def wall_below(body: Solid, patch: SurfacePatch) -> tuple[float, float]:
    """Of a patch's square, the share where there is a surface that looks its way, within half a side of its middle; and
    how thick m the body is below it, the median: inf where there is none."""
    half, outward, centre = patch.half_width, patch.direction, np.array(patch.centre)
    sides, triangles = patch_sides(outward), body.outside
    local = (triangles - centre) @ np.stack((*sides, outward)).T
    across = (local.min(axis=1) <= half) & (local.max(axis=1) >= -half)
    near = triangles[across[:, :2].all(axis=1)]
    thick = depths(near, centre + half * _SAMPLED @ sides, outward, half)
    areas = twice_areas(triangles)
    facing = across.all(axis=1) & (areas @ outward > FACING * np.linalg.norm(areas, axis=1))
    over = (
        across[:, :2].all(axis=1)
        & (local[..., 2].max(axis=1) >= -half)
        & (local[..., 2].min(axis=1) <= 2 * half)
    )
    share = area_within(local[facing], local[over], half) / (2 * half) ** 2
    return min(share, 1.0), float(np.median(thick)) if len(thick) else math.inf


def _triple(values: np.ndarray) -> _Triple:
    x, y, z = values.tolist()
    return x, y, z


@lru_cache(maxsize=256)
def _squares(body: Solid, patch: SurfacePatch, sides: tuple[float, ...], cache: bool) -> _Squares:
    modes = body_modes(body, None, cache=cache)
    triangles = body.outside @ modes.grid.frame.T
    first = place_patch(triangles, patch, modes.grid.frame)
    placed = tuple(replace(first, half_width=side / 2) for side in sides)
    on_grid = [patch_on_grid(modes.grid, triangles, each, uniform_pattern()) for each in placed]
    seen = np.array([seen_on_grid(modes, each.shares, first.normal)[0] for each in on_grid])
    areas = np.array([each.area for each in on_grid])
    areas = np.maximum.accumulate(areas)
    return _Squares(placed, areas, _between(areas, seen, _even(modes)) / np.sqrt(modes.capacity))


def _even(modes: BodyModes) -> np.ndarray:
    """(modes,) of the modes by a flow that is even in all of the body."""
    return modes.fields.T @ modes.grid.capacity / modes.grid.capacity.sum()


def _between(areas: np.ndarray, squares: np.ndarray, nothing: np.ndarray) -> np.ndarray:
    """(R, k) what is even over rings between squares (1 + R, k), each even over its area; `nothing` (k,) where there is
    nothing of a ring."""
    found = []
    for n in range(1, len(areas)):
        whole, within = areas[n], areas[n - 1]
        some = whole - within > _LEAST * whole
        found.append((whole * squares[n] - within * squares[n - 1]) / (whole - within) if some else nothing)
    return np.array(found)


def _local(found: FaceImpedance, around: Mapping[int, _Squares], taus: np.ndarray) -> np.ndarray:
    """(T, F + J, F + J) 1/m3, of unit material, between faces' ports and rings, by the boxes beneath the places.
    around: by place, of those that have rings."""
    faces, rings = len(found.told.columns), len(next(iter(around.values())).rings) if around else 0
    total, after = faces + len(around) * rings, {n: faces + k * rings for k, n in enumerate(around)}
    kernel, known = np.zeros((len(taus), total, total)), np.zeros((total, total))
    for n, place in enumerate(found.places):
        each = place.below
        if min(each.size) <= 0 or each.own is None:
            continue
        on = {m: _on_box(each, other.below, around.get(m)) for m, other in enumerate(found.places)}
        on = {m: rectangles for m, rectangles in on.items() if rectangles is not None}
        if n not in on:
            continue
        order = [n, *(m for m in on if m != n)]
        even = [square > 0 or bool(found.told.even[m]) for m in order for square in range(len(on[m]))]
        local = box_beneath(
            *(each, [one for m in order for one in on[m]], found.one, taus), wanted=len(on[n]), even=even
        )
        turns, ports = zip(*(_turn(found, on[m], m, after) for m in order), strict=True)
        turn, at = block_diag(*turns), np.concatenate(ports)
        local = bent_room(each, taus) * (turns[0].T @ local @ turn)
        own = len(ports[0])
        rows, columns = at[:own], at[own:]
        for one, other, between in (
            (rows, at, local),
            (columns, rows, local[:, :, own:].swapaxes(1, 2)),
        ):
            kernel[:, one[:, None], other] += between
            known[one[:, None], other] += 1
    return kernel / np.maximum(known, 1)


def _turn(
    found: FaceImpedance,
    on: Sequence[tuple[int, np.ndarray, np.ndarray]],
    place: int,
    after: Mapping[int, int],
) -> tuple[np.ndarray, np.ndarray]:
    """How a place's ports are made of flows over rectangles on a box, the face's patterns first; and which ports these
    are. after: by place, the number of its first ring."""
    face = found.told.of(place)
    own, ports = face.stop - face.start, np.arange(face.start, face.stop)
    if len(on) == 1:
        return np.eye(own), ports
    squares = np.eye(own + len(on) - 1)[[0, *range(own, own + len(on) - 1)]]
    areas = np.array([4 * float(half.prod()) for _, _, half in on])
    turn = np.concatenate((np.eye(own, len(squares.T)), _between(areas, squares, 0 * squares[0])))
    return turn.T, np.concatenate((ports, after[place] + np.arange(len(on) - 1)))


def _on_box(
    each: Beneath, other: Beneath, squares: _Squares | None
) -> list[tuple[int, np.ndarray, np.ndarray]] | None:
    """The rectangles of a place's face and of the squares around it on the box; None where they lie on no face of
    it."""
    if squares is None:
        own = each.own if other is each else each.on_box(other.placed)
        return None if own is None else [own]
    found = [each.on_box(placed) for placed in squares.placed]
    if any(one is None for one in found):
        return None
    return [one for one in found if one is not None]
