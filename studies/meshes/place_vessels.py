"""Drawn places of the library's vessels with contents, beside grids that are finer still."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from place_drops import AREA, STACK, TIP, at, held
from place_films import FINEST

from thermograsp import thermal
from thermograsp.envs.bodies.library import library_object
from thermograsp.envs.bodies.object_solids import object_solid
from thermograsp.thermal import Solid, SurfacePatch
from thermograsp.thermal.anywhere.placed import placed_network
from thermograsp.thermal.anywhere.ports import face_patterns
from thermograsp.thermal.meshes.film import Film, film_of
from thermograsp.thermal.meshes.grid import MeshGridding
from thermograsp.thermal.meshes.modes import body_modes
from thermograsp.thermal.meshes.network import patch_fields

VESSELS = (
    "mug_of_coffee",
    "espresso_cup",
    "paper_cup_of_tea",
    "glass_of_ice_water",
    "travel_mug",
    "plastic_cup",
    "beer_bottle",
    "jam_jar",
    "bottle_of_water",
    "food_tin",
    "drinks_can",
    "sleeved_mug",
)
DRAWN = 3  # places of each
VESSEL_FILMS = (
    50.0,
    500.0,
    3e3,
    1e4,
)  # W/(m2 K), of air, of still and stirred water, of what boils or condenses
FELT = 1e3, 3e3, 1e4, 1e5  # W/(m2 K)
LONG = np.unique(np.concatenate((np.arange(0.05, 0.5, 0.01), np.arange(0.5, 20, 0.1))))  # s
_LAYERED = MeshGridding(growth=0.2, largest=0.7e-3)


@dataclass(frozen=True, slots=True)
class VesselRow:
    """Errors of a drawn place, shares of the difference with their signs, the largest over LONG, at each of FELT.
    seconds: of processor time that the network took. states: of it."""

    vessel: str
    place: tuple[float, float, float]
    film: float
    errors: tuple[float, ...]
    seconds: float
    states: int


def vessel(name: str) -> Solid:
    """Of the library."""
    preset = library_object(name)
    return object_solid(preset.spec(), thermal.material(preset.material))


def vessel_rows(chosen: str) -> list[VesselRow]:
    """Of the vessels with this in their name."""
    found = []
    for name in VESSELS:
        if chosen in name:
            body = vessel(name)
            rng = np.random.default_rng([7, *name.encode()])
            for _ in range(DRAWN):
                found += _vessel(name, body, _drawn(body, rng))
    return found


def _vessel(name: str, body: Solid, patch: SurfacePatch) -> list[VesselRow]:
    one = film_of(body, 1.0)
    assert one is not None
    grid, found = FINEST if len(body.parts) == 1 else _LAYERED, []
    for film in VESSEL_FILMS:
        inside = Film(film * one.area, one.walls)
        body_modes(body, inside)
        fine = patch_fields(body, [patch], face_patterns(TIP), grid, inside)
        begin = time.process_time()
        network = placed_network(body, [patch], STACK, inside.conductance).network
        seconds = time.process_time() - begin
        told = held(network, inside.conductance)
        errors = [_drop((told.rates, told.ports), h) - _drop((fine.rates, fine.ports), h) for h in FELT]
        worst = tuple(float(error[np.abs(error).argmax()]) for error in errors)
        found.append(VesselRow(name, patch.centre, film, worst, seconds, network.order))
    return found


def _drawn(body: Solid, rng: np.random.Generator) -> SurfacePatch:
    """Anywhere on the surface by its area, not in the hollow."""
    a, b, c = body.outside.transpose(1, 0, 2)
    areas = np.cross(b - a, c - a)
    walls = film_of(body, 1.0)
    assert walls is not None
    wet = {each.tobytes() for each in np.round(walls.triangles.mean(axis=1), 7)}
    inside = np.array([each.tobytes() in wet for each in np.round((a + b + c) / 3, 7)])
    inside |= (areas * (a + b + c))[:, :2].sum(axis=1) < 0
    sizes = np.where(inside, 0.0, np.linalg.norm(areas, axis=1))
    n = rng.choice(len(sizes), p=sizes / sizes.sum())
    u, v = rng.random(2)
    u, v = (1 - u, 1 - v) if u + v > 1 else (u, v)
    outward = areas[n] / np.linalg.norm(areas[n])
    place = a[n] + u * (b[n] - a[n]) + v * (c[n] - a[n])
    return at(tuple(place.tolist()), tuple(outward.tolist()))


def _drop(body: tuple[np.ndarray, np.ndarray], conductance: float) -> np.ndarray:
    """(LONG,) of the difference, of one fingertip from time 0 on. body: rates and ports."""
    side = TIP.side
    rates = np.concatenate((body[0], side.rates))
    ports = np.concatenate((body[1], -side.ports))
    row = np.concatenate((np.zeros(len(body[0])), side.outputs["drop"]))
    fades, turn = np.linalg.eigh(np.diag(rates) + conductance * AREA * ports @ ports.T)
    fades = np.maximum(fades, 1e-14)
    drive = conductance * AREA * turn.T @ ports[:, 0]
    return -np.expm1(-np.outer(LONG, fades)) / fades * drive @ (row @ turn)


def print_vessels(found: Sequence[VesselRow]) -> None:
    """A line each, and what all are within."""
    for row in found:
        errors = " ".join(f"{100 * share:+.2f}" for share in row.errors)
        place = " ".join(f"{1e3 * x:.0f}" for x in row.place)
        took = f"{row.states} states in {1e3 * row.seconds:.0f} ms"
        print(f"{row.vessel:20}{place:12}{row.film:6g}  {errors} %, {took}")
    for film in VESSEL_FILMS:
        for n, felt in enumerate(FELT):
            shares = [100 * abs(row.errors[n]) for row in found if row.film == film]
            middle, ninth = np.quantile(shares, [0.5, 0.9])
            print(
                f"{film:6g} W/(m2 K) inside, {felt:.0e} W/(m2 K): half within {middle:.3f} %, nine of ten "
                f"{ninth:.3f} %, all {max(shares):.3f} %"
            )
