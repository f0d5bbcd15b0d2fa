"""Networks of meshes from their modes beside grids that are fine at the patch.

A sensor of the paper touches a body at one place, or at two at once. The drop of its temperature follows from the
network that environments use (thermal/meshes/placed.py), and from one whose states are fields of a grid that is fine at
the patches (body_network), which has another grid, other states and no local kernel. Compared are the drops at
CONDUCTANCES over TIMES. Mugs with contents that are held at its first temperature behind a film of FILMS are compared
with a grid that is finer still, whose states are fields with that film. So are drawn places of the
library's vessels, at FELT over LONG.

    python studies/meshes/mesh_places.py                  every case, some minutes
    python studies/meshes/mesh_places.py rim --json       those with "rim" in their name
    python studies/meshes/mesh_places.py --filled         places of mugs with contents instead
    python studies/meshes/mesh_places.py --vessels        drawn places of the library's vessels with contents instead
    python studies/meshes/mesh_places.py --pairs          drawn pairs of fingertips at vessels' rims and feet
    python studies/meshes/mesh_places.py --times          how long modes and networks take instead
"""

# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass

import numpy as np
import trimesh

from thermograsp import thermal
from thermograsp.envs.bodies.library import library_object
from thermograsp.envs.bodies.object_solids import object_solid
from thermograsp.thermal import Solid, SurfacePatch
from thermograsp.thermal.meshes import body_network, surface_normal
from thermograsp.thermal.meshes.film import Film, film_of, held_apart
from thermograsp.thermal.meshes.grid import MeshGridding
from thermograsp.thermal.meshes.modes import body_modes
from thermograsp.thermal.meshes.network import patch_fields
from thermograsp.thermal.meshes.placed import _fields as placed_fields
from thermograsp.thermal.meshes.placed import centred_tip, face_patterns, placed_network
from thermograsp.thermal.network import ThermalNetwork
from thermograsp.thermal.surfaces import SolidPart, crossings

CONDUCTANCES = 1e3, 1e4, 1e5  # W/(m2 K)
TIMES = 0.02 * np.arange(3, 300)  # s
DIFFERENCE = 12.0  # K
MATERIALS = "wood", "ceramic", "stainless_steel", "aluminium"
STACK = thermal.sensor("seed")
AREA = STACK.width**2
TIP = centred_tip(STACK, AREA)

Vector = tuple[float, float, float]


def _mug(radius: float = 0.03, wall: float = 0.003) -> trimesh.Trimesh:
    """80 mm high, its foot as thick as its wall."""
    inner, foot = radius - wall, wall - 0.04
    profile = [(0, -0.04), (radius, -0.04), (radius, 0.04), (inner, 0.04), (inner, foot), (0, foot)]
    return trimesh.creation.revolve(profile, sections=128)


def _block(*size: float) -> Callable[[], trimesh.Trimesh]:
    return lambda: trimesh.creation.box(size)


def _round(radius: float, height: float) -> Callable[[], trimesh.Trimesh]:
    return lambda: trimesh.creation.cylinder(radius, height, sections=96)


def _egg() -> trimesh.Trimesh:
    return trimesh.creation.icosphere(subdivisions=4).apply_transform(np.diag([0.02, 0.02, 0.028, 1]))


def _at(centre: Vector, normal: Vector) -> SurfacePatch:
    return SurfacePatch(centre, normal, AREA)


def _beside(angle: float, height: float, radius: float = 0.03) -> SurfacePatch:
    """On a mug's wall."""
    x, y = math.cos(angle), math.sin(angle)
    return _at((radius * x, radius * y, height), (x, y, 0.0))


def _on(axis: int, x: float, y: float, z: float) -> SurfacePatch:
    at = [x, y, z]
    return _at((x, y, z), tuple(np.sign(at[axis]) * np.eye(3)[axis]))


BODIES: dict[str, Callable[[], trimesh.Trimesh]] = {
    "mug": _mug,
    "pot of 1 mm": lambda: _mug(0.045, 0.001),
    "cup of .6 mm": lambda: _mug(0.03, 0.0006),
    "tube of .2 mm": lambda: _mug(0.02, 0.0002),
    "cube": _block(0.04, 0.04, 0.04),
    "small cube": _block(0.012, 0.012, 0.012),
    "bar": _block(0.01, 0.07, 0.024),
    "sheet of 1 mm": _block(0.04, 0.04, 0.001),
    "sheet of .3 mm": _block(0.06, 0.03, 0.0003),
    "cylinder": _round(0.015, 0.05),
    "can": _round(0.025, 0.05),
    "rod": _round(0.006, 0.06),
    "ball": lambda: trimesh.creation.icosphere(subdivisions=4, radius=0.02),
    "egg": _egg,
    "cone": lambda: trimesh.creation.cone(0.02, 0.05, sections=96),
    "ring": lambda: trimesh.creation.torus(0.025, 0.006),
}
SLANT = math.sqrt(0.5)
ONE: dict[str, tuple[str, SurfacePatch]] = {
    "mug, wall": ("mug", _beside(0.0, 0.0)),
    "mug, low": ("mug", _beside(0.0, -0.0352)),
    "mug, just above the foot": ("mug", _beside(0.0, -0.031)),
    "mug, just below the rim": ("mug", _beside(0.0, 0.0353)),
    "mug, over the rim": ("mug", _beside(0.0, 0.0365)),
    "mug, half over the rim": ("mug", _beside(0.0, 0.04)),
    "mug, over the foot's edge": ("mug", _beside(0.0, -0.036)),
    "mug, on the rim": ("mug", _at((0.0285, 0.0, 0.04), (0.0, 0.0, 1.0))),
    "mug, foot": ("mug", _at((0.0, 0.0, -0.04), (0.0, 0.0, -1.0))),
    "mug, foot below the wall": ("mug", _at((0.024, 0.0, -0.04), (0.0, 0.0, -1.0))),
    "pot of 1 mm": ("pot of 1 mm", _beside(0.0, 0.0, 0.045)),
    "cup of .6 mm": ("cup of .6 mm", _beside(0.0, 0.0)),
    "tube of .2 mm": ("tube of .2 mm", _beside(0.0, 0.0, 0.02)),
    "cube": ("cube", _on(0, 0.02, 0.0, 0.0)),
    "cube, corner": ("cube", _on(0, 0.02, 0.0154, 0.0153)),
    "cube, half over an edge": ("cube", _on(0, 0.02, 0.02, 0.0)),
    "cube, on an edge": ("cube", _at((0.02, 0.02, 0.0), (SLANT, SLANT, 0.0))),
    "small cube": ("small cube", _on(0, 0.006, 0.0, 0.0)),
    "bar": ("bar", _on(0, 0.005, 0.02, 0.0)),
    "sheet of 1 mm": ("sheet of 1 mm", _on(2, 0.0, 0.0, 0.0005)),
    "sheet of .3 mm": ("sheet of .3 mm", _on(2, 0.02, 0.0, 0.00015)),
    "cylinder": ("cylinder", _on(0, 0.015, 0.0, 0.0)),
    "cylinder, near its end": ("cylinder", _on(0, 0.015, 0.0, 0.0204)),
    "cylinder, end": ("cylinder", _on(2, 0.0, 0.0, 0.025)),
    "cylinder, side of its end": ("cylinder", _on(2, 0.009, 0.0, 0.025)),
    "can, slanted": ("can", _at((0.02, 0.015, 0.01), (0.8, 0.6, 0.0))),
    "rod": ("rod", _on(0, 0.006, 0.0, 0.0)),
    "ball": ("ball", _on(0, 0.02, 0.0, 0.0)),
    "ball, slanted": ("ball", _at((0.012, 0.012, 0.0105), (0.6, 0.6, 0.53))),
    "egg": ("egg", _on(0, 0.02, 0.0, 0.0)),
    "egg, slanted": ("egg", _at((0.012, 0.0, 0.022), (0.6, 0.0, 0.6))),
    "cone": ("cone", _at((0.01, 0.0, 0.025), (0.9285, 0.0, 0.3714))),
    "ring": ("ring", _on(0, 0.031, 0.0, 0.0)),
}
"""One place: body, and patch."""
TWO: dict[str, tuple[str, SurfacePatch, SurfacePatch]] = {
    "cube, opposite": ("cube", _on(0, 0.02, 0.0, 0.0), _on(0, -0.02, 0.0, 0.0)),
    "cube, overlapping": ("cube", _on(0, 0.02, -0.006, 0.0), _on(0, 0.02, 0.0, 0.003)),
    "cube, on either side of an edge": ("cube", _on(0, 0.02, 0.014, 0.0), _on(1, 0.014, 0.02, 0.0)),
    "bar, opposite": ("bar", _on(0, 0.005, 0.01, 0.0), _on(0, -0.005, 0.005, 0.0)),
    "mug, opposite": ("mug", _beside(0.0, 0.0), _beside(math.pi, 0.0)),
    "pot, round it": ("pot of 1 mm", _beside(0.0, 0.0, 0.045), _beside(0.3, 0.002, 0.045)),
    "cup, round it": ("cup of .6 mm", _beside(0.0, 0.0), _beside(0.4, 0.002)),
    "tube, round it": ("tube of .2 mm", _beside(0.0, 0.0, 0.02), _beside(0.6, 0.002, 0.02)),
    "mug, above each other": ("mug", _beside(0.0, 0.0), _beside(0.0, 0.006)),
    "mug, a quarter round": ("mug", _beside(0.0, 0.0), _beside(math.pi / 2, 0.0)),
    "mug, over and below the rim": ("mug", _beside(0.0, 0.037), _beside(0.0, 0.03)),
}
_UP = _on(2, 0.0, 0.0, 0.02)
PARTS: dict[str, tuple[str, tuple[str, str], SurfacePatch, SurfacePatch]] = {
    "glass on aluminium, opposite": ("slab", ("glass", "aluminium"), _UP, _on(2, 0.0, 0.0, -0.02)),
    "glass on aluminium, overlapping": ("slab", ("glass", "aluminium"), _UP, _on(2, 0.006, 0.003, 0.02)),
    "aluminium on wood, overlapping": ("slab", ("aluminium", "wood"), _UP, _on(2, 0.006, 0.003, 0.02)),
    "aluminium on wood, beside": ("slab", ("aluminium", "wood"), _UP, _on(0, 0.02, 0.003, 0.0)),
    "wood round aluminium": ("core", ("wood", "aluminium"), _on(0, 0.02, 0.0, 0.0), _on(0, -0.02, 0.0, 0.0)),
}
"""Two places of a body of two materials, the outer or upper first."""


FILMS = 50.0, 500.0, 3000.0  # W/(m2 K), of air, of still water, of water that boils
FILLED = [
    name for name, (body, _) in ONE.items() if body in ("mug", "pot of 1 mm", "cup of .6 mm", "tube of .2 mm")
]
"""Places of ONE, with contents."""
_FINEST = MeshGridding(growth=0.3, largest=1e-3, relief=24)


@dataclass(frozen=True, slots=True)
class Row:
    """error: K of DIFFERENCE, with its sign, at time s and conductance W/(m2 K), the largest. drop: K there."""

    case: str
    material: str
    error: float
    drop: float
    time: float
    conductance: float


def whole(name: str, material: str) -> Solid:
    """A body of BODIES."""
    return Solid((_part(BODIES[name](), material),))


def parted(name: str, materials: tuple[str, str]) -> Solid:
    """A slab of 4 mm on a block, or a shell of 3 mm round a ball."""
    outer, inner = materials
    if name == "core":
        shells = (trimesh.creation.icosphere(subdivisions=4, radius=r) for r in (0.02, 0.017))
        return Solid(tuple(_part(mesh, of) for mesh, of in zip(shells, materials, strict=True)))
    slab, block = _block(0.04, 0.04, 0.004)(), _block(0.04, 0.04, 0.036)()
    slab.apply_translation((0.0, 0.0, 0.018))
    block.apply_translation((0.0, 0.0, -0.002))
    return Solid((_part(slab, outer), _part(block, inner)))


def _part(mesh: trimesh.Trimesh, material: str) -> SolidPart:
    return SolidPart(np.array(mesh.vertices), np.array(mesh.faces), thermal.material(material))


def drops(network: ThermalNetwork, conductance: float) -> np.ndarray:
    """(TIMES, patches) K: a fingertip on each of the network's patches from time 0 on."""
    side, patterns = TIP.side, TIP.side.ports.shape[1]
    fingertips, order = network.ports.shape[1] // patterns, len(network.rates)
    rates = np.concatenate([network.rates, *[side.rates] * fingertips])
    ports, rows = np.zeros((len(rates), network.ports.shape[1])), np.zeros((fingertips, len(rates)))
    ports[:order] = network.ports
    for tip in range(fingertips):
        own = slice(order + tip * len(side.rates), order + (tip + 1) * len(side.rates))
        ports[own, tip * patterns : (tip + 1) * patterns] = -side.ports
        rows[tip, own] = side.outputs["drop"]
    matrix = np.diag(rates) + conductance * AREA * ports @ ports.T
    drive = conductance * AREA * DIFFERENCE * ports[:, ::patterns].sum(axis=1)
    fades, turn = np.linalg.eigh(matrix)
    fades = np.maximum(fades, 1e-14)
    return -np.expm1(-np.outer(TIMES, fades)) / fades * (turn.T @ drive) @ (rows @ turn).T


def compared(case: str, material: str, body: Solid, patches: Sequence[SurfacePatch]) -> Row:
    """The network that environments use beside the fine grid's, for each patch with one whose axes are along it."""
    fast = placed_network(body, patches, STACK).network
    worst = Row(case, material, 0.0, 0.0, 0.0, 0.0)
    for n, patch in enumerate(patches):
        others = [other for other in patches if other is not patch]
        fine = body_network(body, [*others, patch], patterns=face_patterns(TIP))
        for conductance in CONDUCTANCES:
            expected = drops(fine, conductance)[:, -1]
            error = drops(fast, conductance)[:, n] - expected
            at = int(np.abs(error).argmax())
            if abs(error[at]) > abs(worst.error):
                worst = Row(
                    case, material, float(error[at]), float(expected[at]), float(TIMES[at]), conductance
                )
    return worst


def with_contents(name: str, material: str) -> list[Row]:
    """A place of FILLED, the largest error behind each of FILMS."""
    kind, patch = ONE[name]
    body = whole(kind, material)
    one = film_of(body, 1.0)
    assert one is not None
    found = []
    for film in FILMS:
        inside = Film(film * one.area, one.walls)
        fast = _held(placed_network(body, [patch], STACK, inside.conductance).network, inside.conductance)
        held = patch_fields(body, [patch], face_patterns(TIP), _FINEST, inside)
        fine = ThermalNetwork(held.rates, held.ports, np.zeros((held.ports.shape[1],) * 2))
        worst = Row(f"{name}, {film:g} W/(m2 K) to contents", material, 0.0, 0.0, 0.0, 0.0)
        for conductance in CONDUCTANCES:
            expected = drops(fine, conductance)[:, 0]
            error = drops(fast, conductance)[:, 0] - expected
            at = int(np.abs(error).argmax())
            if abs(error[at]) > abs(worst.error):
                told = float(error[at]), float(expected[at]), float(TIMES[at])
                worst = Row(worst.case, material, *told, conductance)
        found.append(worst)
    return found


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


def vessel_rows(chosen: str) -> list[VesselRow]:
    """Of the vessels with this in their name."""
    found = []
    for name in VESSELS:
        if chosen in name:
            preset = library_object(name)
            body = object_solid(preset.spec(), thermal.material(preset.material))
            rng = np.random.default_rng([7, *name.encode()])
            for _ in range(DRAWN):
                found += _vessel(name, body, _drawn(body, rng))
    return found


def _vessel(name: str, body: Solid, patch: SurfacePatch) -> list[VesselRow]:
    one = film_of(body, 1.0)
    assert one is not None
    grid, found = _FINEST if len(body.parts) == 1 else _LAYERED, []
    for film in VESSEL_FILMS:
        inside = Film(film * one.area, one.walls)
        body_modes(body, inside)
        fine = patch_fields(body, [patch], face_patterns(TIP), grid, inside)
        begin = time.process_time()
        network = placed_network(body, [patch], STACK, inside.conductance).network
        seconds = time.process_time() - begin
        held = _held(network, inside.conductance)
        errors = [_drop((held.rates, held.ports), h) - _drop((fine.rates, fine.ports), h) for h in FELT]
        worst = tuple(float(error[np.abs(error).argmax()]) for error in errors)
        found.append(VesselRow(name, patch.centre, film, worst, seconds, network.order))
    return found


PAIRED = 4  # pairs of each, one of each kind
PAIR_FILM = 500.0  # W/(m2 K), of every second pair


@dataclass(frozen=True, slots=True)
class PairRow:
    """Error of a drawn pair, K of DIFFERENCE, with its sign, the largest over TIMES at CONDUCTANCES of either tip.
    film: W/(m2 K) to contents, or 0. seconds: of processor time that the network took. grids: whether a grid was made
    for it."""

    vessel: str
    kind: str
    places: tuple[Vector, Vector]
    film: float
    error: float
    seconds: float
    grids: bool


def pair_rows(chosen: str) -> list[PairRow]:
    """Of the vessels with this in their name."""
    found = []
    for name in VESSELS:
        if chosen not in name:
            continue
        preset = library_object(name)
        body = object_solid(preset.spec(), thermal.material(preset.material))
        rng = np.random.default_rng([11, *name.encode()])
        for n in range(PAIRED):
            kind, one, other = _pair(body, n, rng)
            found.append(_paired(name, kind, body, (one, other), PAIR_FILM * (n % 2 == len(name) % 2)))
    return found


def _pair(body: Solid, kind: int, rng: np.random.Generator) -> tuple[str, SurfacePatch, SurfacePatch]:
    """Two fingertips near each other. The handle, if any, is along y; they are far from it."""
    (_, _, low), (_, _, high) = body.bounds
    at, beside = rng.uniform(-0.6, 0.6), rng.uniform(-2e-3, 2e-3)
    depth, deeper = rng.uniform(0.0, 9e-3, 2)
    width = body.bounds[1, 0]
    apart = rng.uniform(9e-3, 14e-3) / width
    if kind == 0 and (inner := _on_wall(body, at + beside / width, high - deeper, inside=True)) is not None:
        return "pinched at the rim", _outer(body, at, high - depth), inner
    if kind <= 1:
        return (
            "side by side at the rim",
            _outer(body, at, high - depth),
            _outer(body, at + apart, high - deeper),
        )
    if kind == 2:
        return (
            "side by side at the foot",
            _outer(body, at, low + depth),
            _outer(body, at + apart, low + deeper),
        )
    inner = _on_wall(body, at + beside / width, (low + high) / 2 + deeper, inside=True)
    if inner is None:
        return "above each other", _outer(body, at, low + depth), _outer(body, at, low + depth + 9.5e-3)
    return "pinched at the wall", _outer(body, at, (low + high) / 2 + depth), inner


def _outer(body: Solid, angle: float, height: float) -> SurfacePatch:
    found = _on_wall(body, angle, height, inside=False)
    assert found is not None
    return found


def _on_wall(body: Solid, angle: float, height: float, *, inside: bool) -> SurfacePatch | None:
    """On the outside of a wall round z, or on its inside if it is open at the top."""
    out = np.array([math.cos(angle), math.sin(angle), 0.0])
    low, high = body.bounds[:, 2]
    height = float(np.clip(height, low + 0.2e-3, high - 0.2e-3))
    centre = np.array([0.0, 0.0, height])
    if inside:
        met = -crossings(body.outside, centre, -out)
        up = crossings(body.outside, centre + [1e-5, 2e-5, 0.0], np.array([0.0, 0.0, 1.0]))
        if (up > 0).any() or not (met > AREA**0.5).any():
            return None
        place = centre + met[met > 0].min() * out
    else:
        place = centre + crossings(body.outside, centre, out).max() * out
    x, y, z = surface_normal(body, place).tolist()
    return _at(tuple(place.tolist()), (x, y, z))


def _paired(
    name: str, kind: str, body: Solid, patches: tuple[SurfacePatch, SurfacePatch], through: float
) -> PairRow:
    one = film_of(body, 1.0)
    assert one is not None
    inside = Film(through * one.area, one.walls) if through else None
    film = through * one.area
    body_modes(body, inside)
    misses = placed_fields.cache_info().misses
    begin = time.process_time()
    network = placed_network(body, patches, STACK, film).network
    seconds = time.process_time() - begin
    grids = placed_fields.cache_info().misses > misses
    fast, worst = _held(network, film) if film else network, 0.0
    for n in range(2):
        fine = patch_fields(
            body, (patches[1 - n], patches[n]), face_patterns(TIP), MeshGridding(relief=16), inside
        )
        told = ThermalNetwork(fine.rates, fine.ports, np.zeros((fine.ports.shape[1],) * 2))
        for conductance in CONDUCTANCES:
            error = drops(fast, conductance)[:, n] - drops(told, conductance)[:, 1]
            worst = max(worst, float(error[np.abs(error).argmax()]), key=abs)
    return PairRow(name, kind, (patches[0].centre, patches[1].centre), through, worst, seconds, grids)


def _print_pairs(found: Sequence[PairRow]) -> None:
    for row in found:
        places = "; ".join(" ".join(f"{1e3 * x:.1f}" for x in place) for place in row.places)
        grid = ", with a grid" if row.grids else ""
        print(
            f"{row.vessel:20}{row.kind:26}{row.film:5g}  {row.error:+.3f} K in {1e3 * row.seconds:.0f} ms at "
            f"{places}{grid}"
        )
    served = [row for row in found if not row.grids]
    errors, seconds = [abs(row.error) for row in served], [row.seconds for row in served]
    middle, ninth = np.quantile(errors, [0.5, 0.9])
    print(
        f"{len(served)} of {len(found)} pairs without a grid: half within {middle:.3f} K, nine of ten {ninth:.3f} K, "
        f"all {max(errors):.3f} K; half in {1e3 * float(np.median(seconds)):.0f} ms, all in {1e3 * max(seconds):.0f}"
    )


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
    return _at(tuple(place.tolist()), tuple(outward.tolist()))


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


def _held(network: ThermalNetwork, film: float) -> ThermalNetwork:
    """With its contents held at one temperature. film: W/K."""
    rates, turn = held_apart(network, film)
    return ThermalNetwork(rates, turn.T @ network.ports, network.direct)


def rows(chosen: str) -> list[Row]:
    """Of the cases with this in their name."""
    found = []
    for name, (body, *patches) in (ONE | TWO).items():
        if chosen in name:
            found += [compared(name, material, whole(body, material), patches) for material in MATERIALS]
    for name, (body, materials, *patches) in PARTS.items():
        if chosen in name:
            found.append(compared(name, " and ".join(materials), parted(body, materials), patches))
    return found


def filled_rows(chosen: str) -> list[Row]:
    """The same with contents."""
    names = [name for name in FILLED if chosen in name]
    return [row for name in names for material in MATERIALS for row in with_contents(name, material)]


@dataclass(frozen=True, slots=True)
class Times:
    """s of processor time: modes of a body of so many cells, once, and networks of a new place beside 0, 1 and 4 known
    ones, medians of NEW."""

    body: str
    cells: int
    modes: float
    network: tuple[float, float, float]


NEW = 12
ROUND: dict[str, tuple[str, Callable[[float], SurfacePatch]]] = {
    "mug": ("mug", lambda angle: _beside(angle, 0.01)),
    "pot, over the rim": ("pot of 1 mm", lambda angle: _beside(angle, 0.037, 0.045)),
    "cube": ("cube", lambda angle: _on(0, 0.02, 0.01 * math.cos(angle), 0.01 * math.sin(angle))),
    "egg": (
        "egg",
        lambda angle: _at(
            (0.02 * math.cos(angle), 0.02 * math.sin(angle), 0.0), (math.cos(angle), math.sin(angle), 0.0)
        ),
    ),
}
"""Body, and patches by an angle rad."""


def timed(name: str) -> Times:
    """Of a case of ROUND, of ceramic."""
    kind, patch = ROUND[name]
    body = whole(kind, "ceramic")
    begin = time.process_time()
    cells = len(body_modes(body, cache=False).grid.capacity)
    modes = time.process_time() - begin
    body_modes(body)
    angles, medians = iter(0.37 * n for n in range(10_000)), []
    for known in (0, 1, 4):
        taken = []
        for _ in range(NEW):
            patches = [patch(next(angles)) for _ in range(known + 1)]
            if known:
                placed_network(body, patches[:-1], STACK)
            begin = time.process_time()
            placed_network(body, patches, STACK)
            taken.append(time.process_time() - begin)
        medians.append(float(np.median(taken)))
    return Times(name, cells, modes, (medians[0], medians[1], medians[2]))


def _print_vessels(found: Sequence[VesselRow]) -> None:
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


def main() -> int:
    parser = argparse.ArgumentParser(description=str(__doc__).split("\n", 1)[0])
    parser.add_argument("case", nargs="?", default="", help="part of a case's name")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--times", action="store_true", help="how long modes and networks take")
    parser.add_argument("--filled", action="store_true", help="places of mugs with contents")
    parser.add_argument("--vessels", action="store_true", help="drawn places of vessels with contents")
    parser.add_argument("--pairs", action="store_true", help="drawn pairs of fingertips near each other")
    chosen = parser.parse_args()
    if chosen.pairs:
        pairs = pair_rows(chosen.case)
        if chosen.json:
            print(json.dumps([asdict(row) for row in pairs], indent=2))
        else:
            _print_pairs(pairs)
        return 0
    if chosen.vessels:
        vessels = vessel_rows(chosen.case)
        if chosen.json:
            print(json.dumps([asdict(row) for row in vessels], indent=2))
        else:
            _print_vessels(vessels)
        return 0
    if chosen.times:
        taken = [timed(name) for name in ROUND]
        if chosen.json:
            print(json.dumps([asdict(each) for each in taken], indent=2))
        else:
            for each in taken:
                first, second, fifth = (1e3 * seconds for seconds in each.network)
                print(
                    f"{each.body:20}modes of {each.cells} cells {each.modes:.1f} s; first place {first:.1f} ms, "
                    f"second {second:.1f} ms, fifth {fifth:.1f} ms"
                )
        return 0
    found = (filled_rows if chosen.filled else rows)(chosen.case)
    if not found:
        parser.error(f"no case has {chosen.case!r} in its name: {', '.join(ONE | TWO | PARTS)}")
    if chosen.json:
        print(json.dumps([asdict(row) for row in found], indent=2))
        return 0
    for row in found:
        print(
            f"{row.case:52}{row.material:22}{row.error:+.3f} K of {row.drop:.2f} K at {row.time:.2f} s, "
            f"{row.conductance:.0e} W/(m2 K)"
        )
    worst = max(found, key=lambda row: abs(row.error))
    middle, ninth = np.quantile([abs(row.error) for row in found], [0.5, 0.9])
    print(f"{len(found)} touches, half within {middle:.3f} K and nine of ten within {ninth:.3f} K")
    print(f"at most {abs(worst.error):.3f} K: {worst.case}, {worst.material}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
