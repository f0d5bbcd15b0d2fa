"""What the silicone around the sensor does to a touch, in three dimensions, by finite elements with scikit-fem.

As pad_heat.py has it, but of the sensor's square face in a square pad, on a box, in place of discs of equal area: a
quarter of them, as they are symmetric. Triquadratic elements, a conductance between the two meshes, SDIRK2.

    python studies/surround/pad_square.py [MATERIAL ...]   the change of the drop, K of 12, beside that of the discs
    python studies/surround/pad_square.py --thickness .001 [MATERIAL ...]   on an object of 1 mm
    python studies/surround/pad_square.py --press   how far `press(surround="silicone")` is off the elements

Needs scikit-fem, and half a minute for each material, bare and with a skin.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
import pad_heat
from pad_heat import DIFFERENCE, MATERIALS, SKINS_WORN, TIMES, Touch, connected, marched, matter, pieces
from skfem import Basis, BilinearForm, ElementHex2, FacetBasis, LinearForm, MeshHex
from skfem.element import DiscreteField
from skfem.helpers import dot

from thermograsp.thermal import Pad, press
from thermograsp.thermal.matter import USUAL_SKIN, material, sensor
from thermograsp.thermal.matter import skin as named_skin

_HALF = Pad().face / 2  # m


@BilinearForm
def _conduction(u, v, w):
    return w.value * dot(u.grad, v.grad)


@BilinearForm
def _weighted(u, v, w):
    return w.value * u * v


@LinearForm
def _weight(v, w):
    return v


def drops(touch: Touch, refine: float = 1.0) -> np.ndarray:
    """(5,) K, the sensor's temperature drop at TIMES. touch: with all of the pad or alone, none of it cooler at
    first."""

    def cells(*counts: int) -> list[int]:
        return [max(2, round(refine * count)) for count in counts]

    skin, stack = named_skin(touch.skin), sensor("seed")
    pad = len(stack.layers)  # as deep as these
    stack = stack if skin is None else skin.over(stack)
    heights = np.concatenate([[0.0], np.cumsum([layer.thickness for layer in stack.layers])])
    wide = touch.width / 2 if touch.sides else _HALF
    # nothing is steep where the quarter ends by symmetry
    near = np.sin(np.pi / 2 * np.linspace(0, 1, cells(6)[0] + 1)) * _HALF
    # half a second after the touch the silicone has heat from the sensor within 0.3 mm of it
    ring = _HALF + np.geomspace(1.5e-4, touch.width / 2 - _HALF, cells(6)[0])
    ends = np.array([touch.size[0], touch.depth or touch.size[0]]) / 2
    end = ends.max()
    beyond = pieces((touch.width / 2, end), cells(4))[1:] if end > touch.width / 2 else np.zeros(0)
    touched = np.minimum(np.minimum(ends, wide), np.array(touch.spot or (np.inf, np.inf)) / 2)
    touched = np.minimum(np.minimum(ends, wide), np.array(touch.spot or (np.inf, np.inf)) / 2)
    marked = [each for each in ends.tolist() if _HALF < each < touch.width / 2]
    marked += [each / 2 for each in touch.spot or () if each < touch.width]
    lines = np.unique(np.round(np.concatenate([near, ring, beyond, marked]), 9))
    below = pieces(heights.tolist(), cells(3, 4, 4, 2)[: len(stack.layers)])
    above = heights[-1] + np.concatenate([[0.0], np.geomspace(4e-5, touch.size[1], cells(9)[0])])
    inside = lines[lines <= wide * (1 + 1e-9)]
    lower = Basis(MeshHex.init_tensor(inside, inside, below), ElementHex2(), intorder=4)
    over = [lines[lines <= each * (1 + 1e-9)] for each in ends]
    upper = Basis(MeshHex.init_tensor(over[0], over[1], above), ElementHex2(), intorder=4)
    stiffness, mass, body = [], [], material(touch.material)
    for basis in (lower, upper):
        x: Any = np.asarray(basis.global_coordinates())
        k, c = matter(x[2], np.maximum(x[0], x[1]) > _HALF, heights, stack, pad)
        if basis is upper:
            k, c = np.full_like(k, body.conductivity), np.full_like(c, body.volumetric_heat_capacity)
        stiffness.append(_conduction.assemble(basis, value=DiscreteField(k)))
        mass.append(_weighted.assemble(basis, value=DiscreteField(c)))
    top, bottom = (
        FacetBasis(
            basis.mesh,
            ElementHex2(),
            facets=basis.mesh.facets_satisfying(
                lambda p: (abs(p[2] - heights[-1]) < 1e-9) & (p[0] < touched[0]) & (p[1] < touched[1])
            ),
            intorder=4,
        )
        for basis in (lower, upper)
    )
    where: Any = np.asarray(top.global_coordinates())
    conductance = np.where(np.maximum(where[0], where[1]) < _HALF, *touch.through())
    even: Any = _weighted.assemble(top, value=DiscreteField(conductance))
    joined = connected(stiffness, mass, even, _ordered(lower, top), _ordered(upper, bottom))
    plate = lower.get_dofs(lambda x: x[2] < 1e-12).flatten()
    u = np.where(np.arange(lower.N + upper.N) < lower.N, DIFFERENCE, 0.0)
    drop = np.zeros(len(u))
    drop[: lower.N] = _mean(lower, heights[1]) - _mean(lower, heights[2])
    return marched(*joined, plate, u, drop, (0.025, 0.025, 0.05, 0.1, 0.1))


def _ordered(basis: Basis, facets: FacetBasis) -> np.ndarray:
    nodes = np.unique(basis.get_dofs(facets.find).flatten())
    x, y = np.round(basis.doflocs[:2, nodes], 9)
    return nodes[np.lexsort((x, y))]


def _mean(basis: Basis, height: float) -> np.ndarray:
    """The mean over the sensor at that height m, of nodes."""
    mesh: Any = basis.mesh
    plane = np.flatnonzero(
        (np.abs(mesh.p[2, mesh.facets] - height) < 1e-9).all(axis=0)
        & (np.maximum(mesh.p[0, mesh.facets], mesh.p[1, mesh.facets]) < _HALF * (1 + 1e-9)).all(axis=0)
    )
    row = _weight.assemble(FacetBasis(mesh, ElementHex2(), facets=plane, intorder=4))
    return row / row.sum()


PRESSED = [
    (name, skin, (0.040, thickness))
    for thickness in (0.010, 0.001)
    for skin in SKINS_WORN
    for name in ("wood", "glass", "stainless_steel", "aluminium")
] + [
    ("sandstone", None, (0.040, 0.010)),
    ("potato", USUAL_SKIN, (0.040, 0.010)),
    ("glass", None, (0.012, 0.010)),
    ("aluminium", None, (0.016, 0.010)),
]
"""Materials, skins, and widths and thicknesses m of objects: of some pad and face conduct least alike, and over some
the pad stands."""


def compared(
    name: str, skin: str | None, size: tuple[float, float], alike: float | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Drops (5,) K of the elements, and by how much those of `press` are above. alike: W/(m2 K) of face and pad, None
    for what either conducts under 10 N."""
    touch = Touch(name, skin, size=size, conductances=None if alike is None else (alike, alike))
    elements = drops(touch)
    pressed = press(
        name,
        skin=skin,
        object_size=(size[0], size[0], size[1]),
        conductance=touch.through()[0],
        surround="silicone",
        surround_conductance=alike,
        dt=0.05,
    )
    found = pressed.temperature_drop[np.round(np.array(TIMES) / 0.05).astype(int)]
    return elements, found - elements


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description="What a square pad around a square sensor does to the temperature drop."
    )
    parser.add_argument("materials", nargs="*", default=MATERIALS, help="materials of the object")
    parser.add_argument("--thickness", type=float, default=0.010, help="of the object, m (default .010)")
    parser.add_argument("--press", action="store_true", help="compare press with the elements instead")
    parser.add_argument(
        "--alike", type=float, help="W/(m2 K) of face and pad there (default: what each conducts)"
    )
    options = parser.parse_args(arguments)
    if not 0 < options.thickness < np.inf:
        parser.error(f"--thickness must be above 0 m, got {options.thickness:g}")
    if options.press:
        print("elements, K, and press less these, at " + ", ".join(f"{t:g}" for t in TIMES) + " s")
        worst = 0.0
        for name, skin, size in PRESSED:
            elements, off = compared(name, skin, size, options.alike)
            worst = max(worst, float(abs(off).max()))
            rows = " ".join(f"{e:.3f}" for e in elements), " ".join(f"{e:+.3f}" for e in off)
            what = f"{1e3 * size[0]:g} x {1e3 * size[1]:g} mm"
            print(f"{name:16} {skin or 'bare':16}{what:14}{rows[0]}   {rows[1]}", flush=True)
        print(f"at most {worst:.3f} K of {DIFFERENCE:g} K")
        return 0
    print("what the pad changes, K, at " + ", ".join(f"{t:g}" for t in TIMES) + " s: squares, discs")
    for name in options.materials:
        for skin in SKINS_WORN:
            touch = Touch(name, skin, size=(0.040, options.thickness))
            changes = [each(touch) - each(touch.alone) for each in (drops, pad_heat.drops)]
            found = "   ".join(" ".join(f"{value:+.3f}" for value in change) for change in changes)
            print(f"{name:16} {skin or 'bare':16}{found}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
