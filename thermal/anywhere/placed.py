"""A body touched anywhere: its network from its modes and from what lies beneath a place.

The heat kernel between patches is that of the body's slow modes once heat has spread over a few millimetres, and before
that the local one: of a box as thick as the body is there and as wide as its face goes on, curved as it is (the terms
of first and second order in the curvature, from the impedances of cylinder and sphere). So a network is a function of
place in milliseconds. Where that box would not be the body (rims, edges, feet, layers of other materials), the kernel
is that of cells along the face, unrolled, in a few more (unrolled/), between places that feel each other there too.
Where the surface is curved too much for that, as rods below 9 mm of radius are, or contents wet it, or heat goes too
far along another material, a patch's own impedance is a grid's that is fine there, in tenths of a second. Its states
are the body's slowest modes, whatever the place, and what fades sooner, at rates that are the same for all places, its
residues positive semidefinite. Contents behind a film on the walls of a hollow make modes of their own, and a wall that
they wet has a film at its other side.

P: patches, M: patterns, R: modes, T: times, S: moments.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import NamedTuple

import numpy as np

from ..kernels import OF_GRASP, TIMES, TO_MOMENTS, Tip, at_rates, before
from ..matter import SensorStack
from ..meshes import PLATE, PLATE_MATERIAL, BodyModes, Film, TouchedBody, body_modes, film_of, geometry_of
from ..network import ThermalNetwork
from ..plates import Geometry
from ..surfaces import Solid, SurfacePatch
from .beneath import Beneath
from .box import box_kernels
from .pairs import are_close, between_on_cells, between_on_grids
from .place import EMPTY, FILLED, GridFineness, Placed, placed_at
from .ports import LEVEL, centred_tip
from .slow import (
    SlowStates,
    crossover_time,
    modal_impedance,
    modal_kernel,
    modal_share,
    slow_states,
    state_count,
)

PLACED_SHARE = 3.2e-3
"""Error of the drop of a touch, as a share of the first difference, at most: 0.034 K of 12 K in 181 touches of blocks,
bars, sheets, cylinders, balls, cones, rings, mugs and cans of wood, ceramic, steel and aluminium, and of bodies of two
materials, at 1e3 to 1e5 W/(m2 K) in the first 6 s (studies/meshes/mesh_places.py)."""
FILLED_SHARE = 4.4e-3
"""The same with contents: 0.44 % in 144 drawn touches of twelve vessels behind films of 50 to 1e4 W/(m2 K), at 1e3 to
1e4 W/(m2 K) in the first 20 s, nine of ten within 0.2 %; behind films of up to 500 W/(m2 K) all within 0.26 %
(studies/meshes/mesh_places.py --vessels). At 1e5 W/(m2 K) all were within 0.47 %."""


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
    reported: np.ndarray | None = None,
    cache: bool = True,
) -> PlacedNetwork:
    """film: W/K between the walls of the body's hollow, if it has one, and contents. reported: (P M,) bool, the ports
    whose heat has states that fade sooner than the body's own; None: all of them. Raises MeshError where a patch meets
    no surface, or the body is no solid in one piece."""
    inside = film_of(body, film)
    found = face_impedance(body, patches, stack, inside, cache)
    seen = np.concatenate([place.seen for place in found.places])
    slow = slow_states(found.modes, seen, inside)
    level = EMPTY if inside is None else FILLED
    return PlacedNetwork(
        _fitted(found, slow, found.impedance, level, reported),
        [place.below for place in found.places],
        len(slow.fades),
    )


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
    level = EMPTY if inside is None else FILLED
    modes = body_modes(body, inside, cache=cache)
    one = centred_tip(stack, patches[0].area)
    places = [placed_at(body, patch, stack, inside, level, cache) for patch in patches]
    below = [place.below for place in places]
    seen = np.concatenate([place.seen for place in places])
    taus = modes.diffusivity * TIMES
    slow = slow_states(modes, seen, inside)
    kernel = modal_kernel(seen, modes.rates, taus)
    over = modal_share(crossover_time(modes, len(body.parts)))[:, None, None]
    if len(body.parts) == 1:
        conductivity = body.parts[0].material.conductivity
        local = box_kernels(below, one, modes.diffusivity, conductivity, inside) / modes.capacity
        kernel = over * kernel + (1 - over) * local
    count, early = LEVEL.patterns, over[:, 0, 0] < 1
    at = [slice(n * count, (n + 1) * count) for n in range(len(places))]
    soon = np.zeros(kernel.shape[1:])  # K/W, before the first time
    for place, ports in zip(places, at, strict=True):
        if place.local is not None:
            modal = modal_kernel(place.seen, modes.rates, taus)
            modal[early] += (1 - over[early]) * (place.local.kernel - modal[early])
            kernel[:, ports, ports] = modal
            soon[ports, ports] = np.sqrt(np.pi * TIMES[0]) * before(1.0) * modal[0]
        else:
            soon[ports, ports] = before(modes.diffusivity) / (modes.capacity * one.area) * np.eye(count)
    grids = []
    for n, m in combinations(range(len(places)), 2):
        if not are_close(places[n], places[m]):
            continue
        crossing = between_on_cells(body, places[n], places[m], stack, inside, cache)
        if crossing is None:
            grids.append((n, m, between_on_grids(body, patches[n], patches[m], stack, inside, level, cache)))
            continue
        late = modal_kernel(places[n].seen, modes.rates, taus, places[m].seen)
        late[early] += (1 - over[early]) * (crossing - late[early])
        kernel[:, at[n], at[m]], kernel[:, at[m], at[n]] = late, late.transpose(0, 2, 1)
    kernel -= modal_kernel(slow.held.T, slow.fades, TIMES)
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
    reported: np.ndarray | None = None,
) -> tuple[ThermalNetwork, int]:
    """Of an empty body's faces and of J other ports behind them, of even flows; and how many of its states are slow.
    seen: (J, R) of the modes by these. kernel: (T, P M + J, P M + J) 1/J K of the boxes beneath, at TIMES, before the
    modes tell; that of faces is known better. early: (J,) K/W of these before then. reported: (P M + J,), as in
    placed_network."""
    modes, faces = found.modes, found.impedance.shape[1]
    every = np.concatenate((*(place.seen for place in found.places), seen))
    slow = slow_states(modes, every, None, len(seen))
    taus = modes.diffusivity * TIMES
    over = modal_share(crossover_time(modes))[:, None, None]
    kernel = over * modal_kernel(every, modes.rates, taus) + (1 - over) * kernel
    kernel -= modal_kernel(slow.held.T, slow.fades, TIMES)
    impedance = np.tensordot(TO_MOMENTS[OF_GRASP], kernel, axes=1)
    others = np.arange(faces, len(every))
    impedance[:, others, others] += early
    impedance[:, :faces, :faces] = found.impedance
    return _fitted(found, slow, impedance, EMPTY, reported), len(slow.fades)


def _fitted(
    found: FaceImpedance,
    slow: SlowStates,
    impedance: np.ndarray,
    level: GridFineness,
    reported: np.ndarray | None,
) -> ThermalNetwork:
    """The slow states and what fades sooner, of an impedance less that of the former: of the faces, then of others."""
    modes, one, count = found.modes, found.one, LEVEL.patterns
    faces = slice(0, len(found.places) * count, count)
    alone = impedance[:, faces, faces] + modal_impedance(slow.held.T[faces], slow.fades)
    weight = np.min([1 / (1 / one.weight + alone[:, n, n]) for n in range(len(found.places))], axis=0)
    slowest = max(modes.diffusivity * modes.rates[: state_count(modes)][-1], LEVEL.slowest)
    number = max(4, math.ceil(math.log(LEVEL.fastest / slowest) / math.log(level.pitch)) + 1)
    fading, ports = at_rates(impedance, replace(LEVEL, rates=number, slowest=slowest), weight, reported)
    none = np.zeros(len(fading))
    return ThermalNetwork(
        np.concatenate((slow.network.rates, fading)),
        np.concatenate((slow.network.ports, ports)),
        slow.network.direct,
        {name: np.concatenate((row, none)) for name, row in slow.network.outputs.items()},
    )
