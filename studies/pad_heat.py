"""What the silicone around the sensor does to a touch, by axisymmetric finite elements with scikit-fem.

The package takes the sensor's sides as adiabatic and lets nothing but the sensor touch. Here the sensor is a disc of
its face's area in a pad of silicone as deep, which lies on the same thermostat and touches the object too; both start
warm. Beside it the same elements without the pad. The object is a disc of 40 x 40 x 10 mm. Biquadratic elements, a
conductance between the two meshes, SDIRK2 in time.

    python studies/pad_heat.py           the change of the temperature drop, K of 12, for five materials
    python studies/pad_heat.py --json

Needs scikit-fem.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementQuad2, FacetBasis, LinearForm, MeshQuad
from skfem.element import DiscreteField
from skfem.helpers import dot

from thermograsp.thermal import Pad
from thermograsp.thermal.matter import Material, material, sensor

MATERIALS = ("wood", "plastic", "glass", "stainless_steel", "aluminium")
TIMES = (0.5, 1.0, 2.0, 5.0, 10.0)
"""s after the touch."""
DIFFERENCE = 12.0
_OBJECT = 0.040, 0.010  # m, side and thickness
_FACE, _PAD = Pad().face / np.sqrt(np.pi), Pad().width / np.sqrt(np.pi)  # m, radii of discs as large


@BilinearForm
def _conduction(u, v, w):
    return w.value * dot(u.grad, v.grad) * w.x[0]


@BilinearForm
def _weighted(u, v, w):
    return w.value * u * v * w.x[0]


@LinearForm
def _weight(v, w):
    return w.value * v * w.x[0]


def pieces(bounds: Sequence[float], counts: Sequence[int]) -> np.ndarray:
    """Mesh lines: so many cells between each two bounds, smaller toward both, as cosines are."""
    lines = [np.array([bounds[0]])]
    for low, high, count in zip(bounds[:-1], bounds[1:], counts, strict=True):
        part = (1 - np.cos(np.pi * np.arange(1, count + 1) / count)) / 2
        lines.append(low + (high - low) * part)
    return np.concatenate(lines)


def drops(name: str, padded: bool, conductance: float = 1e4, refine: float = 1.0) -> np.ndarray:
    """(5,) K, the sensor's temperature drop at TIMES. padded: whether the silicone is there and conducts. conductance:
    W/(m2 K) of both contacts."""

    def cells(*counts: int) -> list[int]:
        return [max(2, round(refine * count)) for count in counts]

    stack, silicone = sensor("seed"), material("silicone")
    heights = np.concatenate([[0.0], np.cumsum([layer.thickness for layer in stack.layers])])
    r = pieces((0.0, _FACE, _PAD, _OBJECT[0] / np.sqrt(np.pi)), cells(12, 10, 6))
    below = pieces(heights.tolist(), cells(4, 6, 6))
    above = heights[-1] + np.concatenate([[0.0], np.geomspace(2e-5, _OBJECT[1], cells(20)[0])])
    lower = Basis(MeshQuad.init_tensor(r[r <= _PAD * (1 + 1e-9)], below), ElementQuad2(), intorder=5)
    upper = Basis(MeshQuad.init_tensor(r, above), ElementQuad2(), intorder=5)
    stiffness, mass = [], []
    body: Material = material(name)
    for basis in (lower, upper):
        x: Any = basis.global_coordinates()
        at = np.clip(np.searchsorted(heights, np.asarray(x)[1]) - 1, 0, len(stack.layers) - 1)
        k = np.array([layer.conductivity for layer in stack.layers])[at]
        c = np.array([layer.density * layer.specific_heat for layer in stack.layers])[at]
        around = np.asarray(x)[0] > _FACE
        k = np.where(around, silicone.conductivity if padded else 1e-9, k)
        c = np.where(around, silicone.volumetric_heat_capacity, c)
        if basis is upper:
            k, c = np.full_like(k, body.conductivity), np.full_like(c, body.volumetric_heat_capacity)
        stiffness.append(_conduction.assemble(basis, value=DiscreteField(k)))
        mass.append(_weighted.assemble(basis, value=DiscreteField(c)))
    top, bottom = (
        FacetBasis(
            basis.mesh,
            ElementQuad2(),
            facets=basis.mesh.facets_satisfying(
                lambda p: (abs(p[1] - heights[-1]) < 1e-9) & (p[0] < (_PAD if padded else _FACE))
            ),
            intorder=5,
        )
        for basis in (lower, upper)
    )
    even: Any = _weighted.assemble(top, value=DiscreteField(np.full(np.shape(top.dx), conductance)))
    ordered, other = _ordered(lower, top), _ordered(upper, bottom)
    both = np.concatenate([ordered, lower.N + other])
    link = even[ordered][:, ordered]
    join = sparse.bmat([[link, -link], [-link, link]]).tocoo()
    size = lower.N + upper.N
    joined = sparse.csr_matrix((join.data, (both[join.row], both[join.col])), (size, size))
    whole: Any = sparse.block_diag(stiffness).tocsr() + joined
    heat: Any = sparse.block_diag(mass).tocsr()
    plate = lower.get_dofs(lambda x: x[1] < 1e-12).flatten()
    free = np.setdiff1d(np.arange(size), plate)
    u = np.where(np.arange(size) < lower.N, DIFFERENCE, 0.0)
    a, b = whole[free][:, free].tocsc(), heat[free][:, free].tocsc()
    load = -whole[free][:, plate] @ u[plate]
    face = [_mean(lower, height) for height in heights[1:3]]
    gamma, drops, t = 1 - np.sqrt(0.5), [], 0.0
    for end, step in zip(TIMES, (0.01, 0.02, 0.05, 0.1, 0.1), strict=True):
        solver = splu(b + gamma * step * a)
        for _ in range(round((end - t) / step)):
            first = solver.solve(load - a @ u[free])
            second = solver.solve(load - a @ (u[free] + (1 - gamma) * step * first))
            u[free] += step * ((1 - gamma) * first + gamma * second)
        t = end
        drops.append(float((face[0] - face[1]) @ u[: lower.N]))
    return np.array(drops)


def _ordered(basis: Basis, facets: FacetBasis) -> np.ndarray:
    nodes = np.unique(basis.get_dofs(facets.find).flatten())
    return nodes[np.argsort(basis.doflocs[0, nodes])]


def _mean(basis: Basis, height: float) -> np.ndarray:
    """The mean over the sensor at that height m, of nodes."""
    mesh: Any = basis.mesh
    plane = np.flatnonzero(
        (np.abs(mesh.p[1, mesh.facets] - height) < 1e-9).all(axis=0)
        & (mesh.p[0, mesh.facets] < _FACE * (1 + 1e-9)).all(axis=0)
    )
    # of a plane within the mesh, from one side
    facets = FacetBasis(mesh, ElementQuad2(), facets=plane, intorder=5)
    row = _weight.assemble(facets, value=DiscreteField(np.ones(np.shape(facets.dx))))
    return row / row.sum()


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description="What the pad around the sensor does to the temperature drop."
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args(arguments)
    curves = {name: [drops(name, padded).tolist() for padded in (False, True)] for name in MATERIALS}
    if options.json:
        json.dump(curves, sys.stdout, indent=1)
        return 0
    print("drop without a pad, and what the pad changes, K, at " + ", ".join(f"{t:g}" for t in TIMES) + " s")
    for name, (alone, padded) in curves.items():
        changes = (f"{a:6.3f} {b - a:+.3f}" for a, b in zip(alone, padded, strict=True))
        print(f"{name:16}" + "   ".join(changes))
    return 0


if __name__ == "__main__":
    sys.exit(main())
