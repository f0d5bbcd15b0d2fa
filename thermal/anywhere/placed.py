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

from ..kernels import OF_GRASP, TIMES, TO_MOMENTS, Tip, Told, at_rates, before, ports_told
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
    whole: Sequence[bool] | None = None,
    cache: bool = True,
) -> PlacedNetwork:
    """film: W/K between the walls of the body's hollow, if it has one, and contents. whole: (P,) of which patches all
    ports have states that fade sooner than the body's own, or the even one alone; None: of all. Raises MeshError where
    a patch meets no surface, or the body is no solid in one piece."""
    inside = film_of(body, film)
    found = face_impedance(body, patches, stack, inside, cache, whole)
    seen = np.concatenate([place.seen for place in found.places])
    slow = slow_states(found.modes, seen, inside)
    level = EMPTY if inside is None else FILLED
    return PlacedNetwork(
        _fitted(found, slow, found.impedance, level),
        [place.below for place in found.places],
        len(slow.fades),
    )


class FaceImpedance(NamedTuple):
    """Of sensors' faces on a body. modes: the body's. one: the sensor's element under its contact. places: where the
    patches are. told: their ports that are told, F of them. impedance: (S, F, F) K/W of these at GRASP, less that of
    the slow modes."""

    modes: BodyModes
    one: Tip
    places: list[Placed]
    told: Told
    impedance: np.ndarray


def face_impedance(
    body: Solid,
    patches: Sequence[SurfacePatch],
    stack: SensorStack,
    inside: Film | None,
    cache: bool,
    whole: Sequence[bool] | None,
) -> FaceImpedance:
    """Arguments and errors as placed_network's."""
    level = EMPTY if inside is None else FILLED
    modes = body_modes(body, inside, cache=cache)
    one = centred_tip(stack, patches[0].area)
    places = [placed_at(body, patch, stack, inside, level, cache) for patch in patches]
    told = ports_told(len(places), LEVEL.patterns, whole)
    every = np.concatenate([place.seen for place in places])
    seen, slow = every[told.columns], slow_states(modes, every, inside)
    taus = modes.diffusivity * TIMES
    kernel = modal_kernel(seen, modes.rates, taus)
    over = modal_share(crossover_time(modes, len(body.parts)))[:, None, None]
    at = [told.of(n) for n in range(len(places))]
    if len(body.parts) == 1:
        conductivity = body.parts[0].material.conductivity
        below = [place.below for place in places]
        local = box_kernels(below, at, one, modes.diffusivity, conductivity, inside) / modes.capacity
        kernel = over * kernel + (1 - over) * local
    early, soon = over[:, 0, 0] < 1, np.zeros(kernel.shape[1:])  # K/W, before the first time
    for place, ports in zip(places, at, strict=True):
        few = slice(ports.stop - ports.start)
        if place.local is not None:
            modal = modal_kernel(place.seen[few], modes.rates, taus)
            modal[early] += (1 - over[early]) * (place.local.kernel[:, few, few] - modal[early])
            kernel[:, ports, ports] = modal
            soon[ports, ports] = np.sqrt(np.pi * TIMES[0]) * before(1.0) * modal[0]
        else:
            soon[ports, ports] = before(modes.diffusivity) / (modes.capacity * one.area) * np.eye(few.stop)
    grids = []
    for n, m in combinations(range(len(places)), 2):
        if not are_close(places[n], places[m]):
            continue
        rows, columns = (slice(at[each].stop - at[each].start) for each in (n, m))
        crossing = between_on_cells(body, places[n], places[m], stack, inside, cache)
        if crossing is None:
            pair = between_on_grids(body, patches[n], patches[m], stack, inside, level, cache)
            grids.append((n, m, pair[:, rows, columns]))
            continue
        late = modal_kernel(places[n].seen[rows], modes.rates, taus, places[m].seen[columns])
        late[early] += (1 - over[early]) * (crossing[:, rows, columns] - late[early])
        kernel[:, at[n], at[m]], kernel[:, at[m], at[n]] = late, late.transpose(0, 2, 1)
    kernel -= modal_kernel(slow.held.T[told.columns], slow.fades, TIMES)
    impedance = np.tensordot(TO_MOMENTS[OF_GRASP], kernel, axes=1) + soon
    for place, ports in zip(places, at, strict=True):
        if place.impedance is not None:
            few = slice(ports.stop - ports.start)
            impedance[:, ports, ports] = place.impedance[:, few, few]
    for n, m, pair in grids:
        impedance[:, at[n], at[m]], impedance[:, at[m], at[n]] = pair, pair.transpose(0, 2, 1)
    return FaceImpedance(modes, one, places, told, impedance)


def ringed_network(
    found: FaceImpedance, seen: np.ndarray, kernel: np.ndarray, early: np.ndarray
) -> tuple[ThermalNetwork, int]:
    """Of an empty body's faces and of J other ports behind them, of even flows; and how many of its states are slow.
    seen: (J, R) of the modes by these. kernel: (T, F + J, F + J) 1/J K of the boxes beneath, at TIMES, before the modes
    tell; that of faces is known better. early: (J,) K/W of these before then."""
    modes, faces = found.modes, found.impedance.shape[1]
    every = np.concatenate((*(place.seen for place in found.places), seen))
    slow = slow_states(modes, every, None, len(seen))
    told = np.concatenate((found.told.columns, np.arange(len(every) - len(seen), len(every))))
    taus = modes.diffusivity * TIMES
    over = modal_share(crossover_time(modes))[:, None, None]
    kernel = over * modal_kernel(every[told], modes.rates, taus) + (1 - over) * kernel
    kernel -= modal_kernel(slow.held.T[told], slow.fades, TIMES)
    impedance = np.tensordot(TO_MOMENTS[OF_GRASP], kernel, axes=1)
    others = np.arange(faces, len(told))
    impedance[:, others, others] += early
    impedance[:, :faces, :faces] = found.impedance
    return _fitted(found, slow, impedance, EMPTY), len(slow.fades)


def _fitted(
    found: FaceImpedance, slow: SlowStates, impedance: np.ndarray, level: GridFineness
) -> ThermalNetwork:
    """The slow states and what fades sooner, of an impedance less that of the former: of the faces' F ports, then of
    others."""
    modes, one, ports, columns = found.modes, found.one, slow.network.ports, found.told.columns
    even, faces = found.told.first, len(columns)
    alone = impedance[:, even[:, None], even] + modal_impedance(slow.held.T[columns[even]], slow.fades)
    weight = np.min([1 / (1 / one.weight + alone[:, n, n]) for n in range(len(even))], axis=0)
    slowest = max(modes.diffusivity * modes.rates[: state_count(modes)][-1], LEVEL.slowest)
    number = max(4, math.ceil(math.log(LEVEL.fastest / slowest) / math.log(level.pitch)) + 1)
    fading, told = at_rates(impedance, replace(LEVEL, rates=number, slowest=slowest), weight)
    sooner = np.zeros((len(fading), ports.shape[1]))
    sooner[:, columns], sooner[:, len(found.places) * LEVEL.patterns :] = told[:, :faces], told[:, faces:]
    none = np.zeros(len(fading))
    return ThermalNetwork(
        np.concatenate((slow.network.rates, fading)),
        np.concatenate((ports, sooner)),
        slow.network.direct,
        {name: np.concatenate((row, none)) for name, row in slow.network.outputs.items()},
    )
