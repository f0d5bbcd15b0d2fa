"""What the silicone around the sensor does to a touch, by axisymmetric finite elements with scikit-fem.

The package takes the sensor's sides as adiabatic and lets nothing but the sensor touch. Here the sensor is a disc of
its face's area in a pad of silicone as deep, which lies on the same thermostat and touches the object too; a skin
covers both. Beside it the same elements without the pad. Flat faces, conductances by the package's law of contact;
the object is a disc, by itself and without air. Biquadratic elements, a conductance between the two meshes, SDIRK2.

    python studies/surround/pad_heat.py           the change of the temperature drop, K of 12, for five materials
    python studies/surround/pad_heat.py --all     the largest change for every material
    python studies/surround/pad_heat.py --cases   by force, width of the pad, size of the object, pads that start cooler
    python studies/surround/pad_heat.py --json    the first of these as one JSON object

Needs scikit-fem.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementQuad2, FacetBasis, LinearForm, MeshQuad
from skfem.element import DiscreteField
from skfem.helpers import dot

from thermograsp.thermal import Pad, SensorStack, Surface, contact_conductance, flat_contact, materials
from thermograsp.thermal.contact import face_joint, pad_joint, skinned
from thermograsp.thermal.matter import USUAL_SKIN, material, sensor
from thermograsp.thermal.matter import skin as named_skin

MATERIALS = ("wood", "plastic", "glass", "stainless_steel", "aluminium")
TIMES = (0.5, 1.0, 2.0, 5.0, 10.0)
"""s after the touch."""
DIFFERENCE = 12.0
SKINS_WORN = (None, USUAL_SKIN)
_FACE = Pad().face / np.sqrt(np.pi)  # m, radius of a disc as large


@dataclass(frozen=True, slots=True)
class Touch:
    """A flat touch in the middle of an object that is as wide and as thick as `size`, m. skin: a name, or None. force:
    N on a pad of that width, m. conductances: W/(m2 K) of the sensor's contact and of the pad's around it, None for the
    package's law. cooled: K by which the silicone is colder at its front at first, and less in proportion deeper.
    sides, front: whether the silicone exchanges heat with the sensor, and with the object. depth: m of an object that
    is not square, and spot: m, the sides of a rectangle in the middle that alone touches, both in three dimensions
    alone; None for its width, and for all that lies over the pad."""

    material: str
    skin: str | None = None
    force: float = 10.0
    width: float = Pad().width
    size: tuple[float, float] = (0.040, 0.010)
    conductances: tuple[float, float] | None = None
    cooled: float = 0.0
    sides: bool = True
    front: bool = True
    depth: float | None = None
    spot: tuple[float, float] | None = None

    @property
    def alone(self) -> Touch:
        """As the package has it."""
        return replace(self, sides=False, front=False)

    def through(self) -> tuple[float, float]:
        """W/(m2 K) of the two contacts."""
        if self.conductances is not None:
            return self.conductances
        skin, other = named_skin(self.skin), Surface.of(material(self.material))
        flat = flat_contact(
            skinned(Pad(width=self.width), skin), self.force, (self.size[0], self.depth or self.size[0])
        )
        around = pad_joint(skin, material("silicone"), other)
        pressure = (self.force - flat.face_force) / (flat.pad - flat.face)
        return (
            float(contact_conductance(face_joint(skin, other), flat.face_pressure)),
            float(contact_conductance(around, pressure)),
        )


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


def drops(touch: Touch, refine: float = 1.0) -> np.ndarray:
    """(5,) K, the sensor's temperature drop at TIMES."""

    def cells(*counts: int) -> list[int]:
        return [max(2, round(refine * count)) for count in counts]

    skin, stack = named_skin(touch.skin), sensor("seed")
    pad = len(stack.layers)  # as deep as these
    stack = stack if skin is None else skin.over(stack)
    heights = np.concatenate([[0.0], np.cumsum([layer.thickness for layer in stack.layers])])
    wide, thick = touch.width / np.sqrt(np.pi), touch.size[1]
    r = pieces((0.0, _FACE, wide, touch.size[0] / np.sqrt(np.pi)), cells(12, 10, 6))
    below = pieces(heights.tolist(), cells(4, 6, 6, 4)[: len(stack.layers)])
    above = heights[-1] + np.concatenate([[0.0], np.geomspace(2e-5, thick, cells(20)[0])])
    lower = Basis(MeshQuad.init_tensor(r[r <= wide * (1 + 1e-9)], below), ElementQuad2(), intorder=5)
    upper = Basis(MeshQuad.init_tensor(r, above), ElementQuad2(), intorder=5)
    stiffness, mass = [], []
    body, edge = material(touch.material), r[r > _FACE * (1 + 1e-9)][0]
    for basis in (lower, upper):
        x: Any = basis.global_coordinates()
        outside = np.asarray(x)[0] > _FACE
        k, c = matter(np.asarray(x)[1], outside, heights, stack, pad)
        if not touch.sides:
            k = np.where(outside & (np.asarray(x)[0] < edge), 1e-9, k)  # a gap
        if basis is upper:
            k, c = np.full_like(k, body.conductivity), np.full_like(c, body.volumetric_heat_capacity)
        stiffness.append(_conduction.assemble(basis, value=DiscreteField(k)))
        mass.append(_weighted.assemble(basis, value=DiscreteField(c)))
    top, bottom = (
        FacetBasis(
            basis.mesh,
            ElementQuad2(),
            facets=basis.mesh.facets_satisfying(
                lambda p: (abs(p[1] - heights[-1]) < 1e-9) & (p[0] < (wide if touch.front else _FACE))
            ),
            intorder=5,
        )
        for basis in (lower, upper)
    )
    inside: Any = top.global_coordinates()
    conductance = np.where(np.asarray(inside)[0] < _FACE, *touch.through())
    even: Any = _weighted.assemble(top, value=DiscreteField(conductance))
    joined = connected(stiffness, mass, even, _ordered(lower, top), _ordered(upper, bottom))
    plate = lower.get_dofs(lambda x: x[1] < 1e-12).flatten()
    u = np.where(np.arange(lower.N + upper.N) < lower.N, DIFFERENCE, 0.0)
    around = lower.doflocs[0] > _FACE * (1 + 1e-9)
    u[: lower.N][around] -= touch.cooled * lower.doflocs[1][around] / heights[-1]
    drop = np.zeros(len(u))
    drop[: lower.N] = _mean(lower, heights[1]) - _mean(lower, heights[2])
    return marched(*joined, plate, u, drop, (0.01, 0.02, 0.05, 0.1, 0.1))


def matter(
    depth: np.ndarray, outside: np.ndarray, heights: np.ndarray, stack: SensorStack, pad: int
) -> tuple[np.ndarray, np.ndarray]:
    """W/(m K) and J/(m3 K) at places of that depth, m: silicone outside the sensor, beside the first `pad` layers of
    the stack, whose boundaries are the heights."""
    at = np.clip(np.searchsorted(heights, depth) - 1, 0, len(stack.layers) - 1)
    k = np.array([layer.conductivity for layer in stack.layers])[at]
    c = np.array([layer.volumetric_heat_capacity for layer in stack.layers])[at]
    around, silicone = outside & (at < pad), material("silicone")
    return (
        np.where(around, silicone.conductivity, k),
        np.where(around, silicone.volumetric_heat_capacity, c),
    )


def connected(
    stiffness: Sequence[Any], mass: Sequence[Any], even: Any, ordered: np.ndarray, other: np.ndarray
) -> tuple[Any, Any]:
    """Conduction and heat capacity of two meshes, whose nodes `ordered` and `other` lie upon each other. even: what the
    contact between them conducts, on the first one's nodes."""
    nodes = stiffness[0].shape[0]
    both = np.concatenate([ordered, nodes + other])
    link = even[ordered][:, ordered]
    join = sparse.bmat([[link, -link], [-link, link]]).tocoo()
    whole: Any = sparse.block_diag(stiffness).tocsr()
    whole += sparse.csr_matrix((join.data, (both[join.row], both[join.col])), whole.shape)
    return whole, sparse.block_diag(mass).tocsr()


def marched(
    whole: Any, heat: Any, plate: np.ndarray, u: np.ndarray, drop: np.ndarray, steps: Sequence[float]
) -> np.ndarray:
    """(5,) K, the row `drop` of the temperatures at TIMES, in steps of so many s up to each. u: the first temperatures
    of all nodes; those of the plate keep them."""
    free = np.setdiff1d(np.arange(len(u)), plate)
    a, b = whole[free][:, free].tocsc(), heat[free][:, free].tocsc()
    load = -whole[free][:, plate] @ u[plate]
    gamma, found, t = 1 - np.sqrt(0.5), [], 0.0
    for end, step in zip(TIMES, steps, strict=True):
        # symmetric and positive definite: no pivoting, which keeps the factors of 3-D meshes small
        solver = splu(
            (b + gamma * step * a).tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        for _ in range(round((end - t) / step)):
            first = solver.solve(load - a @ u[free])
            second = solver.solve(load - a @ (u[free] + (1 - gamma) * step * first))
            u[free] += step * ((1 - gamma) * first + gamma * second)
        t = end
        found.append(float(drop @ u))
    return np.array(found)


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
    parser.add_argument("--all", action="store_true", help="the largest change for every material")
    parser.add_argument("--cases", action="store_true", help="by force, width, size and first temperature")
    options = parser.parse_args(arguments)
    if options.all:
        _every()
    elif options.cases:
        _cases()
    else:
        _usual(options.json)
    return 0


def _change(touch: Touch, refine: float = 0.8) -> np.ndarray:
    return drops(touch, refine) - drops(touch.alone, refine)


def _usual(as_json: bool) -> None:
    curves = {
        (name, skin): [drops(touch).tolist() for touch in (Touch(name, skin).alone, Touch(name, skin))]
        for skin in SKINS_WORN
        for name in MATERIALS
    }
    if as_json:
        json.dump({f"{name}/{skin}": both for (name, skin), both in curves.items()}, sys.stdout, indent=1)
        return
    print("drop without a pad, and what the pad changes, K, at " + ", ".join(f"{t:g}" for t in TIMES) + " s")
    for (name, skin), (alone, padded) in curves.items():
        changes = (f"{a:6.3f} {b - a:+.3f}" for a, b in zip(alone, padded, strict=True))
        print(f"{name:16} {skin or 'bare':16}" + "   ".join(changes))


def _every() -> None:
    print("largest change of the drop at these times, K: bare, with a skin")
    for name in materials():
        found = [_change(Touch(name, skin)) for skin in SKINS_WORN]
        print(f"{name:24}" + "  ".join(f"{change[np.argmax(np.abs(change))]:+.3f}" for change in found))


def _cases() -> None:
    print("what the pad changes, K, at " + ", ".join(f"{t:g}" for t in TIMES) + " s")
    variants: dict[str, dict[str, Any]] = {
        "as usual": {},
        "silicone beside the sensor alone": {"front": False},
        "silicone against the object alone": {"sides": False},
        **{f"{force:g} N": {"force": force} for force in (1.0, 30.0)},
        **{f"pad {1e3 * width:g} mm wide": {"width": width} for width in (0.010, 0.012, 0.015, 0.025, 0.030)},
        "sheet of 1 mm": {"size": (0.040, 0.001)},
        "plate of 3 mm": {"size": (0.040, 0.003)},
        "piece of 24 x 24 x 20 mm": {"size": (0.024, 0.020)},
        "plate of 100 x 100 x 20 mm": {"size": (0.100, 0.020)},
        **{f"front {cooled:g} K cooler at first": {"cooled": cooled} for cooled in (1.1, 6.0)},
    }
    for skin in SKINS_WORN:
        for name in MATERIALS:
            for told, given in variants.items():
                change = _change(Touch(name, skin, **given))
                print(f"{name:16} {skin or 'bare':16} {told:36}" + " ".join(f"{c:+.3f}" for c in change))


if __name__ == "__main__":
    sys.exit(main())
