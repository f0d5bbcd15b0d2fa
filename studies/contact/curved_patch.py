"""The drop of a sensor on a ball or a cylinder whose contact conducts place by place, beside the even patch that stands
for it.

Finite volumes about an axis: sensor and plate as discs of equal areas, the plate of the ball's thickness and volume as
in the environments. Where the ball touches, rough faces conduct at Hertz's mean pressure; beside it gas, in Hertz's own
gap. Heat is constricted by itself: the cells are an eighth of the contact's radius at its edge. Under a skin springs
press, the most in the middle, and beside what touches the gap is the body's own. The other run is of the same grid with
one conductance over a disc of `even_patch`'s area, whose product is `conduction`'s. Of a cylinder that lies across the
whole face all is the same in a plane, without what flows along it.

    python studies/contact/curved_patch.py                  steel, copper, glass, plastic and wood
    python studies/contact/curved_patch.py glass --json
    python studies/contact/curved_patch.py abs wood cork --cylinders
    python studies/contact/curved_patch.py glass wood --skin filled_silicone
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix, diags
from scipy.sparse.linalg import splu

from thermograsp.thermal import Layer, Pad, Surface, material, sensor
from thermograsp.thermal.contact import conductance, conduction, even_patch, footprint, round_footprint
from thermograsp.thermal.matter import skin as dressed

TIMES = np.array([0.5, 1.0, 2.0, 4.0])
CASES = ((0.02, 10.0), (0.02, 1.0), (0.02, 0.01), (0.005, 10.0), (0.005, 0.01), (0.05, 10.0), (0.05, 0.01))
"""(radius m, force N)"""
CYLINDERS = ((0.02, 0.05), (0.02, 1.0), (0.02, 5.0), (0.02, 20.0), (0.02, 60.0))
DIFFERENCE = 12.0  # K
CELLS = 8
"""Along half the contact's width, and through a skin."""
_GAMMA = 1 - 1 / np.sqrt(2)
_STEPS = ((1e-4, 10), (1e-3, 9), (1e-2, 9), (0.05, 18), (0.1, 31))  # s, how many
_MIDDLE = np.zeros(3)
_LONG = 0.08  # m of a cylinder


def edges(points: Sequence[float], finest: Sequence[float], growth: float, longest: float) -> np.ndarray:
    """Cell boundaries m, as fine at the points as told, longer between them."""
    every = [points[0]]
    for start, end, fine, last in zip(points[:-1], points[1:], finest[:-1], finest[1:], strict=True):
        left, right = [start], [end]
        while right[-1] - left[-1] > fine + last:
            if fine <= last:
                left.append(left[-1] + fine)
                fine = min(fine * growth, longest)
            else:
                right.append(right[-1] - last)
                last = min(last * growth, longest)
        every += [*left[1:], *right[::-1]]
    return np.unique(np.round(every, 12))


class Disc:
    """Layers, the touched one first, on a grid. matrix: W/K between cells; capacity: J/K; face: m2 of the rings;
    half: m2 K/W from the face to the first cells' middles. length: m of strips to both sides of a middle line, which
    take the rings' place; None for rings."""

    def __init__(
        self,
        rings: np.ndarray,
        layers: Sequence[Layer],
        finest: Sequence[float],
        longest: float,
        length: float | None = None,
    ) -> None:
        bounds = np.cumsum([0.0, *(layer.thickness for layer in layers)])
        self.depths = edges(list(bounds), finest, 1.25, longest)
        self.thick = np.diff(self.depths)
        self.layer = np.searchsorted(bounds, self.depths[:-1] + self.thick / 2) - 1
        self.conducts = np.array([layers[n].conductivity for n in self.layer])
        holds = np.array([layers[n].volumetric_heat_capacity for n in self.layer])
        self.face = np.pi * np.diff(rings**2) if length is None else 2 * length * np.diff(rings)
        self.capacity = np.outer(holds * self.thick, self.face).ravel()
        self.half = self.thick[0] / (2 * self.conducts[0])
        middles = (rings[1:] + rings[:-1]) / 2
        number = np.arange(self.capacity.size).reshape(len(self.thick), -1)
        edges_long = 2 * np.pi * rings[1:-1] if length is None else 2 * length
        sideways = np.outer(self.conducts * self.thick, edges_long / np.diff(middles))
        resistance = self.thick / (2 * self.conducts)
        along = self.face[None] / (resistance[1:] + resistance[:-1])[:, None]
        first = np.concatenate((number[:, :-1].ravel(), number[:-1].ravel()))
        second = np.concatenate((number[:, 1:].ravel(), number[1:].ravel()))
        self.matrix = joined(first, second, np.concatenate((sideways.ravel(), along.ravel())), number.size)


def joined(first: np.ndarray, second: np.ndarray, watts: np.ndarray, count: int) -> csr_matrix:
    """W/K of conductances between cells."""
    rows, columns = np.concatenate((first, second)), np.concatenate((second, first))
    between = coo_matrix((np.concatenate((watts, watts)), (rows, columns)), shape=(count, count)).tocsr()
    return csr_matrix(diags(np.asarray(between.sum(axis=1)).ravel()) - between)


def drops(tip: Disc, body: Disc, sensed: int, conductances: np.ndarray) -> np.ndarray:
    """K at TIMES. conductances: W/(m2 K) of the tip's rings."""
    count, in_tip = tip.capacity.size + body.capacity.size, tip.capacity.size
    capacity = np.concatenate((tip.capacity, body.capacity))
    rings = len(tip.face)
    watts = tip.face / (1 / np.maximum(conductances, 1e-12) + tip.half + body.half)
    behind = np.zeros(count)
    behind[in_tip - rings : in_tip] = tip.face * 2 * tip.conducts[-1] / tip.thick[-1]
    matrix = joined(np.arange(rings), in_tip + np.arange(rings), watts, count) + diags(behind)
    inside = coo_matrix(tip.matrix), coo_matrix(body.matrix)
    for part, shift in zip(inside, (0, in_tip), strict=True):
        matrix = matrix + coo_matrix((part.data, (part.row + shift, part.col + shift)), shape=(count, count))
    state = np.concatenate((np.full(in_tip, DIFFERENCE), np.zeros(count - in_tip)))
    every, drops, drive = [0.0], [0.0], behind * DIFFERENCE
    for step, times in _STEPS:
        solve = splu((diags(capacity) + _GAMMA * step * matrix).tocsc()).solve
        for _ in range(times):
            first = solve(drive - matrix @ state)
            second = solve(drive - matrix @ (state + (1 - _GAMMA) * step * first))
            state = state + step * ((1 - _GAMMA) * first + _GAMMA * second)
            every.append(every[-1] + step)
            drops.append(_drop(tip, sensed, state[:in_tip]))
    return np.interp(TIMES, every, drops)


def _drop(tip: Disc, sensed: int, state: np.ndarray) -> float:
    mean = state.reshape(-1, len(tip.face)) @ tip.face / tip.face.sum()
    layer = np.flatnonzero(tip.layer == sensed)
    between = tip.conducts / tip.thick

    def at(cell: int) -> float:
        """K at the upper side of a cell."""
        a, b = between[cell], between[cell + 1]
        return float((a * mean[cell] + b * mean[cell + 1]) / (a + b))

    return at(int(layer[-1])) - at(int(layer[0]) - 1)


def compared(
    name: str, radius: float, force: float, cylinder: bool = False, worn: str | None = None
) -> dict[str, object]:
    """Of a ball, or of a cylinder across the face: W/K and drops K at TIMES, place by place and of an even patch, whose
    area is in m2. worn: a skin's name, None for a bare face."""
    made, stack = material(name), sensor("seed")
    surface, width = Surface.of(made), stack.width
    skin = None if worn is None else dressed(worn)
    law = round_footprint(Pad(), skin, surface, radius, _LONG if cylinder else None)
    area, load = footprint(law, force, _MIDDLE)
    patch, total = even_patch(law, made, force, skin), conduction(law, force, _MIDDLE)[1]
    length = width if cylinder else None
    touched, covers, reach = area / (2 * width), patch / (2 * width), width / 2
    volume = np.pi * radius**2 / (2 * radius) / 2
    if not cylinder:
        touched, covers, reach = np.sqrt(area / np.pi), np.sqrt(patch / np.pi), width / np.sqrt(np.pi)
        volume = np.sqrt(4 / 3 * np.pi * radius**3 / (2 * radius) / np.pi)
    fine = touched / CELLS
    ends = [
        each for each in np.unique(np.round([touched, covers], 9)) if each < reach
    ]  # within one cell each
    rings = edges([0.0, *ends, reach], [fine] * (1 + len(ends)) + [1e-4], 1.15, 3e-4)
    beyond = edges([reach, max(volume, 1.0001 * reach)], [1e-4, 1e-3], 1.2, 2e-3)
    layers = [*([] if skin is None else [skin.layer]), *stack.layers[::-1]]
    first = [fine] if skin is None else [min(fine, skin.thickness / CELLS)] * 2
    tip = Disc(rings, layers, [*first, *[3e-5] * (len(layers) + 1 - len(first))], 2e-4, length)
    wide = np.unique(np.concatenate((rings, beyond)))
    body = Disc(wide, [made.layer(2 * radius)], [min(fine, 1e-4) if cylinder else fine, 1e-3], 1e-3, length)
    at = (rings[1:] + rings[:-1]) / 2
    gap, beside = np.zeros(len(at)), at > touched
    gap[beside] = gap_beside(at[beside] / touched, cylinder, worn is None) * touched**2 / radius
    placed = np.where(at < radius, float(law["gas"]) / (float(law["mean_gap"]) + gap), 0.0)
    even = 1.0 if worn is None else (1.5 if cylinder else 2.0) * (1 - (at[~beside] / touched) ** 2)
    pressure = load / area * even * np.ones(len(at[~beside]))
    placed[~beside] = [conductance(law, each) for each in pressure]
    covered = at < covers
    sensed = len(layers) - 1 - stack.sensed
    return {
        "material": name,
        "radius": radius,
        "force": force,
        "conductance": total,
        "patch": patch,
        "placed": drops(tip, body, sensed, placed).tolist(),
        "even": drops(tip, body, sensed, covered * total / patch).tolist(),
    }


def gap_beside(x: np.ndarray, cylinder: bool, rigid: bool = True) -> np.ndarray:
    """The gap beside a contact, over its half width's square and the radius: Hertz's where both are rigid but for the
    contact, the body's own beside springs; x: of places, over its half width, 1 or more (Johnson, Contact Mechanics,
    sections 3.4, 4.2 and 4.3)."""
    if not rigid:
        return (x * x - 1) / 2
    root = np.sqrt(x * x - 1)
    if cylinder:
        return (x * root - np.log(x + root)) / 2
    return (root + (x * x - 2) * np.arccos(1 / x)) / np.pi


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description="A bare sensor on balls or cylinders, place by place and by an even patch."
    )
    parser.add_argument("materials", nargs="*", default=["steel", "copper", "glass", "plastic", "wood"])
    parser.add_argument(
        "--cylinders", action="store_true", help="cylinders that lie across the face, at more forces"
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--skin", help="that the sensor wears: such as filled_silicone")
    options = parser.parse_args(arguments)
    cases = CYLINDERS if options.cylinders else CASES
    rows = [
        compared(name, *case, options.cylinders, options.skin) for name in options.materials for case in cases
    ]
    if options.json:
        json.dump(rows, sys.stdout, indent=1)
        return 0
    print(
        f"material  radius, mm   N     mm2    W/K   drops at {', '.join(f'{t:g}' for t in TIMES)} s (even patch)"
    )
    for row in rows:
        pairs = "  ".join(f"{a:.3f} ({b:.3f})" for a, b in zip(row["placed"], row["even"], strict=True))  # pyright: ignore
        print(
            f"{row['material']:10}{1e3 * row['radius']:7g} {row['force']:6g} {1e6 * row['patch']:7.1f} "  # pyright: ignore
            f"{row['conductance']:7.4f}  {pairs}",
            flush=True,
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
