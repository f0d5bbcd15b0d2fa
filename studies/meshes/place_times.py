"""How long a body's modes and the networks of new places take."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from place_drops import STACK, at
from place_shapes import beside, on, whole

from thermograsp.thermal import Solid, SurfacePatch
from thermograsp.thermal.anywhere.place import place_fields
from thermograsp.thermal.anywhere.placed import placed_network
from thermograsp.thermal.meshes.modes import _modes, body_modes


@dataclass(frozen=True, slots=True)
class Times:
    """s of processor time: modes of a body of so many cells, once, and networks of a new place beside 0, 1 and 4 known
    ones, medians of NEW. slides: of a new place by a fingertip that has slid on by each of STEPS, beside the last four
    places. grids: that were made for these."""

    body: str
    cells: int
    modes: float
    network: tuple[float, float, float]
    slides: tuple[float, ...]
    grids: int


NEW = 12
KNOWN = 4
STEPS = 1.7e-3, 3.4e-3, 5e-3  # m
ROUND: dict[str, tuple[str, Callable[[float], SurfacePatch]]] = {
    "mug": ("mug", lambda angle: beside(angle, 0.01)),
    "mug, at the rim": ("mug", lambda angle: beside(angle, 0.0365)),
    "mug, at the foot": ("mug", lambda angle: beside(angle, -0.0365)),
    "pot, over the rim": ("pot of 1 mm", lambda angle: beside(angle, 0.037, 0.045)),
    "handle": ("handle", lambda angle: beside(angle, 0.002, 0.01)),
    "cube": ("cube", lambda angle: on(0, 0.02, 0.01 * math.cos(angle), 0.01 * math.sin(angle))),
    "egg": (
        "egg",
        lambda angle: at(
            (0.02 * math.cos(angle), 0.02 * math.sin(angle), 0.0), (math.cos(angle), math.sin(angle), 0.0)
        ),
    ),
}
"""Body, and patches by an angle rad."""


def timed(name: str) -> Times:
    """Of a case of ROUND, of ceramic."""
    kind, patch = ROUND[name]
    body = whole(kind, "ceramic")
    _modes.cache_clear()
    begin = time.process_time()
    cells = len(body_modes(body, cache=False).grid.capacity)
    modes = time.process_time() - begin
    body_modes(body)
    angles, medians = iter(0.37 * n for n in range(10_000)), []
    for known in (0, 1, KNOWN):
        taken = []
        for _ in range(NEW):
            patches = [patch(next(angles)) for _ in range(known + 1)]
            if known:
                placed_network(body, patches[:-1], STACK)
            begin = time.process_time()
            placed_network(body, patches, STACK)
            taken.append(time.process_time() - begin)
        medians.append(float(np.median(taken)))
    misses = place_fields.cache_info().misses
    radius = float(np.linalg.norm(patch(0.0).centre[:2]))
    slides = tuple(_slid(body, patch, step / radius) for step in STEPS)
    grids = place_fields.cache_info().misses - misses
    return Times(name, cells, modes, (medians[0], medians[1], medians[2]), slides, grids)


def _slid(body: Solid, patch: Callable[[float], SurfacePatch], step: float) -> float:
    """step: rad."""
    patches, taken = [], []
    for n in range(KNOWN + NEW):
        patches = [*patches[-KNOWN:], patch(1.0 + step * n)]
        begin = time.process_time()
        placed_network(body, patches, STACK)
        taken.append(time.process_time() - begin)
    return float(np.median(taken[KNOWN:]))


def print_times(found: Sequence[Times]) -> None:
    """A line each."""
    for each in found:
        first, second, fifth = (1e3 * seconds for seconds in each.network)
        print(
            f"{each.body:20}modes of {each.cells} cells {each.modes:.1f} s; first place {first:.1f} ms, "
            f"second {second:.1f} ms, fifth {fifth:.1f} ms"
        )
        steps = ", ".join(
            f"{1e3 * step:.1f} mm {1e3 * taken:.1f} ms"
            for step, taken in zip(STEPS, each.slides, strict=True)
        )
        print(f"{'':20}slid on by {steps}; {each.grids} grids")
