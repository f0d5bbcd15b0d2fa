"""Drawn pairs of fingertips near each other at the rims and feet of the library's vessels, beside grids."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from place_drops import AREA, STACK, TIP, Vector, at, held, largest, on_grid
from place_vessels import VESSELS, vessel

from thermograsp.thermal import Solid, SurfacePatch
from thermograsp.thermal.anywhere.place import place_fields
from thermograsp.thermal.anywhere.placed import placed_network
from thermograsp.thermal.anywhere.ports import face_patterns
from thermograsp.thermal.meshes import surface_normal
from thermograsp.thermal.meshes.film import Film, film_of
from thermograsp.thermal.meshes.grid import MeshGridding
from thermograsp.thermal.meshes.modes import body_modes
from thermograsp.thermal.meshes.network import patch_fields
from thermograsp.thermal.surfaces import crossings

PAIRED = 8  # pairs of each, one of each kind
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
    """Of the vessels, or of the kinds of pairs, with this in their name."""
    found = []
    for name in VESSELS:
        body, rng = vessel(name), np.random.default_rng([11, *name.encode()])
        for n in range(PAIRED):
            kind, one, other = _pair(body, n, rng)
            if chosen in name or chosen in kind:
                found.append(_paired(name, kind, body, (one, other), PAIR_FILM * (n % 2 == len(name) % 2)))
    return found


def _pair(body: Solid, kind: int, rng: np.random.Generator) -> tuple[str, SurfacePatch, SurfacePatch]:
    """Two fingertips near each other. The handle, if any, is along y; they are far from it."""
    (_, _, low), (_, _, high) = body.bounds
    angle, beside = rng.uniform(-0.6, 0.6), rng.uniform(-2e-3, 2e-3)
    depth, deeper = rng.uniform(0.0, 9e-3, 2)
    width = body.bounds[1, 0]
    apart = rng.uniform(9e-3, 14e-3) / width
    if kind >= 4:
        return _slid(body, kind, angle, depth, rng)
    if (
        kind == 0
        and (inner := _on_wall(body, angle + beside / width, high - deeper, inside=True)) is not None
    ):
        return "pinched at the rim", _outer(body, angle, high - depth), inner
    if kind <= 1:
        return (
            "side by side at the rim",
            _outer(body, angle, high - depth),
            _outer(body, angle + apart, high - deeper),
        )
    if kind == 2:
        return (
            "side by side at the foot",
            _outer(body, angle, low + depth),
            _outer(body, angle + apart, low + deeper),
        )
    inner = _on_wall(body, angle + beside / width, (low + high) / 2 + deeper, inside=True)
    if inner is None:
        return "above each other", _outer(body, angle, low + depth), _outer(body, angle, low + depth + 9.5e-3)
    return "pinched at the wall", _outer(body, angle, (low + high) / 2 + depth), inner


def _slid(
    body: Solid, kind: int, angle: float, depth: float, rng: np.random.Generator
) -> tuple[str, SurfacePatch, SurfacePatch]:
    """A fingertip that has slid on by less than its width."""
    (_, _, low), (_, _, high) = body.bounds
    on, across = rng.uniform(1.5e-3, 8e-3), rng.uniform(-1e-3, 1e-3)
    further = angle + on / body.bounds[1, 0]
    if kind == 4:
        return (
            "slid along the rim",
            _outer(body, angle, high - depth),
            _outer(body, further, high - depth + across),
        )
    if kind == 5:
        return (
            "slid down from the rim",
            _outer(body, angle, high - depth),
            _outer(body, angle + across / body.bounds[1, 0], high - depth - on),
        )
    inner = _on_wall(body, angle, high - depth, inside=True)
    if kind == 6 and inner is not None:
        beside = _on_wall(body, further, high - depth + across, inside=True)
        assert beside is not None
        return "slid along the rim, inside", inner, beside
    return (
        "slid along the foot",
        _outer(body, angle, low + depth),
        _outer(body, further, low + depth + across),
    )


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
    return at(tuple(place.tolist()), (x, y, z))


def _paired(
    name: str, kind: str, body: Solid, patches: tuple[SurfacePatch, SurfacePatch], through: float
) -> PairRow:
    one = film_of(body, 1.0)
    assert one is not None
    inside = Film(through * one.area, one.walls) if through else None
    film = through * one.area
    body_modes(body, inside)
    misses = place_fields.cache_info().misses
    begin = time.process_time()
    network = placed_network(body, patches, STACK, film).network
    seconds = time.process_time() - begin
    grids = place_fields.cache_info().misses > misses
    fast, errors = held(network, film) if film else network, []
    for n in range(2):
        ordered = patches[1 - n], patches[n]
        fine = patch_fields(body, ordered, face_patterns(TIP), MeshGridding(relief=16), inside)
        errors.append(largest(fast, n, on_grid(fine)).error)
    worst = max(errors, key=abs)
    return PairRow(name, kind, (patches[0].centre, patches[1].centre), through, worst, seconds, grids)


def print_pairs(found: Sequence[PairRow]) -> None:
    """A line each, and what those are within that need no grid."""
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
