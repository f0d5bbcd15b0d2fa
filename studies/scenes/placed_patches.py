"""Contacts at the edge of a face under ThermalTouch beside finite volumes in three dimensions.

A fingertip, most with the usual skin, touches a block by a rectangle of even conductance: a part of the sensor's face
that the block covers, or a narrow patch such as a rod or a ball leaves, in the middle, at the face's edge or at the
block's. The heat of ThermalTouch takes the rectangle as its columns tell it; the volumes (cells of touch_volumes.py)
conduct from each cell of the fingertip's face that lies on the rectangle into the block's cell below it, and nowhere
else. Compared is the temperature drop after TIMES s; two grids tell what the volumes are good to.

    python studies/scenes/placed_patches.py               every case, some minutes
    python studies/scenes/placed_patches.py half --json
"""

# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import mujoco
import numpy as np
from scipy import sparse
from scipy.sparse.linalg import cg
from touch_volumes import Grid, body, lines

from thermograsp import Fingertip, ThermalTouch
from thermograsp.thermal import SensorStack, material
from thermograsp.thermal.contact import patch_ends, patch_offset
from thermograsp.touch.contacts import (
    AREA,
    ASIDE,
    CLOSED,
    COLUMNS,
    CONDUCTANCE,
    ENDS,
    LENGTH,
    NORMAL,
    PLACE,
)
from thermograsp.touch.heat import JoinedHeat

TIMES, WARM, COOL = (0.5, 2.0), 36.0, 24.0
"""s, and °C of the thermostat and of the block at first."""
SIDE = 0.04  # m, of the block
MATERIALS = ("steel", "aluminium", "glass", "wood")
_STEPS = (
    (1e-3, 10),
    (1e-2, 19),
    (0.05, 6),
    (0.05, 10),
    (0.1, 10),
)  # s, how many; the first three are TIMES[0]
_GAMMA = 1 - 1 / math.sqrt(2)

Span = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Case:
    """A rectangle on the sensor's face: y and z m from its middle, W/(m2 K), and the y m of the block's middle; along z
    all is symmetric. skin: of the fingertip. thick, breadth: m, of the block, along x and y."""

    y: Span
    half_z: float
    conductance: float
    block: float
    skin: str | None = "filled_silicone"
    thick: float = SIDE
    breadth: float = SIDE


_H = 0.0045
CASES = {
    "quarter": Case((-_H, -_H / 2), _H, 3.4e5, -_H / 2 - SIDE / 2),
    "half": Case((-_H, 0.0), _H, 2.5e5, -SIDE / 2),
    "three quarters": Case((-_H, _H / 2), _H, 2.1e5, _H / 2 - SIDE / 2),
    "rod in the middle": Case((-0.0008, 0.0008), _H, 5e5, 0.0),
    "line of a bare rod": Case((-0.00015, 0.00015), _H, 1.4e5, 0.0, None),
    "rod off the middle": Case((0.0022, 0.0038), _H, 5e5, 0.0),
    "rod at the face's edge": Case((0.0029, _H), _H, 5e5, 0.0),
    "rod that ends": Case((-_H, 0.0), 0.0008, 5e5, -SIDE / 2),
    "ball in the middle": Case((-0.0014, 0.0014), 0.0014, 5e5, 0.0),
    "ball off the middle": Case((0.0011, 0.0039), 0.0014, 5e5, 0.0),
    "ball at the face's edge": Case((0.0017, _H), 0.0014, 5e5, 0.0),
    "ball at the block's edge": Case((-0.0014, 0.0014), 0.0014, 5e5, 0.0014 - SIDE / 2),
    "rod on a wall of 4 mm": Case((-0.0008, 0.0008), _H, 5e5, 0.0, thick=0.004),
    "rod on a wall of 1.5 mm": Case((-0.0008, 0.0008), _H, 5e5, 0.0, thick=0.0015),
    "rod on a wall of 0.6 mm": Case((-0.0008, 0.0008), _H, 5e5, 0.0, thick=0.0006),
    "rod on a wall of 0.2 mm": Case((-0.0008, 0.0008), _H, 5e5, 0.0, thick=0.0002),
    "ball on a wall of 1.5 mm": Case((-0.0014, 0.0014), 0.0014, 5e5, 0.0, thick=0.0015),
    "narrow pad": Case((-0.003, 0.003), 0.003, 2.5e5, 0.0),
    "half of a narrow pad": Case((-0.003, 0.0), 0.003, 2.5e5, -SIDE / 2),
    "ball on a wall of 0.6 mm": Case((-0.0014, 0.0014), 0.0014, 5e5, 0.0, thick=0.0006),
    "bar of 8 mm": Case((-0.004, 0.004), _H, 2e5, 0.0, breadth=0.008),
    "bar of 8 mm, 1 mm aside": Case((-0.003, _H), _H, 2.1e5, 0.001, breadth=0.008),
    "bar of 8 mm, 2 mm aside": Case((-0.002, _H), _H, 2.2e5, 0.002, breadth=0.008),
    "bar of 8 mm, 4 mm aside": Case((0.0, _H), _H, 2.5e5, 0.004, breadth=0.008),
    "bar of 9 mm, 2.5 mm aside": Case((-0.002, _H), _H, 2.2e5, 0.0025, breadth=0.009),
    "bar of 5 mm, 3 mm aside": Case((0.0005, _H), _H, 2.4e5, 0.003, breadth=0.005),
}


@lru_cache
def touch_on(made_of: str, skin: str | None, thick: float, breadth: float) -> ThermalTouch:
    """Of a fingertip above a block that looks down."""
    model = mujoco.MjModel.from_xml_string(f"""
      <mujoco><worldbody>
        <body name="block"><geom name="block" type="box" size="{breadth / 2} {SIDE / 2} {thick / 2}"/></body>
        <body name="tip" pos="0 0 .1"><geom name="tip" type="box" size=".01 .01 .004"/></body>
      </worldbody></mujoco>""")
    tip = Fingertip("tip", (0, 0, -0.004), (0, 0, -1), (0.02, 0.02), temperature=WARM, skin=skin)
    return ThermalTouch(
        model, fingertips={"tip": tip}, objects={"block": made_of}, air=0.0, ambient=COOL, chain="ideal"
    )


def by_network(case: Case, made_of: str) -> tuple[float, ...]:
    """K of drop after TIMES."""
    touch = touch_on(made_of, case.skin, case.thick, case.breadth)
    width = touch._pads[0].stack.width
    heat = JoinedHeat(
        touch._pads, (), touch._shapes, worlds=1, dt=0.01, tolerance=0.05, film=0.0, ambient=COOL
    )
    broad, long = case.y[1] - case.y[0], 2 * case.half_z
    area, middle = broad * long, sum(case.y) / 2
    touches = np.zeros((1, 1, 2, COLUMNS))
    row = touches[0, 0, 0]
    row[[CONDUCTANCE, CLOSED, AREA, LENGTH]] = case.conductance * area, 1.0, area, area * long
    row[ASIDE] = area * patch_offset(abs(middle), broad, width)
    row[ENDS] = area * patch_ends(middle - case.block, case.block, broad, case.breadth, width)
    row[PLACE : PLACE + 3], row[NORMAL : NORMAL + 3] = (-case.block, 0.0, case.thick / 2), (0.0, 0.0, -1.0)
    found = []
    for n in range(1, round(TIMES[-1] / 0.01) + 1):
        heat.advance(touches, 1)
        if any(abs(n * 0.01 - time) < 1e-9 for time in TIMES):
            found.append(float(heat.drop[0, 0]))
    return tuple(found)


def _both(start: float, end: float, count: int, first: float) -> np.ndarray:
    """Lines from start to end, finest at both."""
    middle = (start + end) / 2
    half = lines(start, middle, max(count // 2, 1), first)
    return np.concatenate((half, (start + end - half[:-1])[::-1]))


def _beside(start: float, end: float, count: int, first: float) -> np.ndarray:
    """Lines beyond start up to end, finest at the start; none where there is no room."""
    return lines(start, end, count, first)[1:] if abs(end - start) > 1e-9 else np.zeros(0)


def _lines_of(
    low: float, high: float, patches: Sequence[Span], refine: float
) -> tuple[np.ndarray, list[int]]:
    """Of an axis from low to high with patches, and the numbers of the patches' first cells."""
    first = min(1.2e-4, *((end - start) / 12 for start, end in patches)) / refine
    found, starts = _beside(patches[0][0], low, round(9 * refine), first)[::-1], []
    for n, patch in enumerate(patches):
        starts.append(len(found))
        following = patches[n + 1][0] if n + 1 < len(patches) else None
        between = _beside(patch[1], high, round(9 * refine), first)
        if following is not None:
            apart = following - patch[1] > 1e-9
            between = _both(patch[1], following, 2 * round(5 * refine), first)[1:-1] if apart else np.zeros(0)
        within = _both(*patch, 2 * round(5 * refine), first)
        if following is not None and following - patch[1] <= 1e-9:
            within = within[:-1]
        found = np.concatenate((found, within, between))
    return found, starts


def by_volumes(case: Case, made_of: str, refine: float) -> tuple[float, ...]:
    """K of drop after TIMES in half of both bodies."""
    stack = touch_on(made_of, case.skin, case.thick, case.breadth)._pads[0].stack
    patch = Patch(case.y, case.block, case.conductance, made_of, case.thick, case.breadth)
    return volumes_of(stack, [patch], case.half_z, refine)


@dataclass(frozen=True, slots=True)
class Patch:
    """On the sensor's face, as a Case has it, of a block of that material."""

    y: Span
    block: float
    conductance: float
    made_of: str
    thick: float = SIDE
    breadth: float = SIDE


def volumes_of(
    stack: SensorStack, patches: Sequence[Patch], half_z: float, refine: float
) -> tuple[float, ...]:
    """K of drop after TIMES of a sensor on patches that do not overlap, in order along y."""
    first = min(1.2e-4, half_z / 6) / refine
    patch_z = half_z - lines(0.0, half_z, round(5 * refine), first)[::-1]
    z_of = lambda deep: np.concatenate((patch_z, _beside(half_z, deep, round(9 * refine), first)))  # noqa: E731
    wide, across, half = 2 * round(5 * refine), len(patch_z) - 1, stack.width / 2
    y, starts = _lines_of(-half, half, [patch.y for patch in patches], refine)
    x, k, c = [np.zeros(1)], [], []
    for layer in stack.layers[::-1]:
        count = max(round(refine * layer.thickness / 2e-4), round(3 * refine))
        x.append(x[-1][-1] + np.linspace(0.0, layer.thickness, count + 1)[1:])
        k += [layer.conductivity] * count
        c += [layer.volumetric_heat_capacity] * count
    tip = body(Grid((np.concatenate(x), y, z_of(half)), np.array(k), np.array(c), held=WARM - COOL))
    bodies, total, joins, above, below = [tip], len(tip.capacity), [], [], []
    for patch, start in zip(patches, starts, strict=True):
        matter = material(patch.made_of)
        deep = lines(0.0, patch.thick, round(14 * refine), min(1e-4, patch.thick / 15) / refine)
        ends = patch.block - patch.breadth / 2, patch.block + patch.breadth / 2
        along, (first_cell,) = _lines_of(*ends, [patch.y], refine)
        alike = np.ones(len(deep) - 1)
        block = body(
            Grid(
                (deep, along, z_of(SIDE / 2)),
                matter.conductivity * alike,
                matter.volumetric_heat_capacity * alike,
            )
        )
        areas = np.outer(np.diff(y)[start : start + wide], np.diff(patch_z)).ravel()
        resist = tip.grid.edges[0][1] / (2 * tip.grid.k[0]) + deep[1] / (2 * matter.conductivity)
        joins.append(areas / (1 / patch.conductance + resist))
        above.append(_front(tip.grid, start, wide, across))
        below.append(total + _front(block.grid, first_cell, wide, across))
        bodies.append(block)
        total += len(block.capacity)
    placed = np.concatenate(above), np.concatenate(below)
    coupled = sparse.csr_matrix((np.concatenate(joins), placed), shape=(total, total))
    coupled = coupled + coupled.T
    matrix = sparse.block_diag([each.conduction for each in bodies]) - coupled
    matrix = (matrix + sparse.diags(np.asarray(coupled.sum(axis=1)).ravel())).tocsr()
    capacity = np.concatenate([each.capacity for each in bodies])
    source = np.concatenate([each.source for each in bodies])
    state = np.zeros(total)
    state[: len(tip.capacity)] = WARM - COOL
    row, found, now = _drop(tip.grid, stack), [], 0.0
    first_rate = np.zeros(total)
    for step, times in _STEPS:
        implicit = (sparse.diags(capacity) + _GAMMA * step * matrix).tocsr()
        scale = sparse.diags(1 / implicit.diagonal())
        for _ in range(times):
            first_rate, _ = cg(implicit, source - matrix @ state, x0=first_rate, rtol=1e-6, M=scale)
            between = state + (1 - _GAMMA) * step * first_rate
            second, _ = cg(implicit, source - matrix @ between, x0=first_rate, rtol=1e-6, M=scale)
            state = state + step * ((1 - _GAMMA) * first_rate + _GAMMA * second)
            now += step
            if any(abs(now - time) < 1e-9 for time in TIMES):
                found.append(float(row @ state[: len(tip.capacity)]))
    return tuple(found)


def _front(grid: Grid, start: int, wide: int, across: int) -> np.ndarray:
    """The cells of its face from number start along y on, of which so many are in a patch."""
    cells = np.arange(math.prod(grid.shape)).reshape(grid.shape)
    return cells[0, start : start + wide, :across].ravel()


def extrapolated(coarse: np.ndarray, fine: np.ndarray) -> np.ndarray:
    """From grids of 1 and 1.5, whose error falls with the square of the cells."""
    return fine + (fine - coarse) / (1.5**2 - 1)


def _drop(grid: Grid, stack: SensorStack) -> np.ndarray:
    """Row of the drop over the sensed layer, mean over the face."""
    near = sum(layer.thickness for layer in stack.layers[stack.sensed + 1 :])
    row, along = np.zeros(grid.shape), grid.k / np.diff(grid.edges[0])
    width = np.outer(*(np.diff(edge) for edge in grid.edges[1:]))
    for plane, sign in ((near + stack.layers[stack.sensed].thickness, 1.0), (near, -1.0)):
        at = int(np.argmin(abs(grid.edges[0] - plane)))
        for cell in (at - 1, at):
            row[cell] += sign * along[cell] / (along[at - 1] + along[at]) * width / width.sum()
    return row.ravel()


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description="Patches at the edge of a face beside finite volumes.")
    parser.add_argument("case", nargs="?", default="", help="part of a case's name")
    parser.add_argument("--material", default="", help="part of a material's name")
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    options = parser.parse_args(arguments)
    for name in (name for name in CASES if options.case in name):
        for made_of in (each for each in MATERIALS if options.material in each):
            coarse, fine = (np.array(by_volumes(CASES[name], made_of, refine)) for refine in (1.0, 1.5))
            found = {
                "network": by_network(CASES[name], made_of),
                "volumes": extrapolated(coarse, fine),
                "grid": fine - coarse,
            }
            record = {"case": name, "material": made_of}
            record |= {key: [round(float(x), 3) for x in each] for key, each in found.items()}
            print(json.dumps(record) if options.json else record, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
