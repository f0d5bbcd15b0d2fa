"""Independent reference: a press by finite elements with scikit-fem, sharing no numerics with the package.

A quarter of the sensor and of the object are two meshes of triquadratic hexahedra. The contact is an interface without
thickness: a conductance between coinciding nodes of the two meshes, weighted with the facet mass matrix. In O mode the
element and the object share the nodes of their bond. Time: TR-BDF2 (Bank et al. 1985, IEEE Trans. Electron Devices 32,
1992), second order and L-stable, with steps that grow fourfold, each factored once.

    python studies/elements/fem.py                 every case of the reference table, two meshes and their extrapolation
    python studies/elements/fem.py glass --json    cases whose name contains "glass", as JSON

Needs scikit-fem.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy import sparse
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq
from scipy.sparse.linalg import SuperLU, splu
from skfem import Basis, BilinearForm, ElementHex2, FacetBasis, LinearForm, MeshHex
from skfem.element import DiscreteField
from skfem.helpers import dot

from thermograsp.thermal.matter import material, sensor
from thermograsp.thermal.rungs import PressProblem

REFERENCE = Path(__file__).resolve().parents[2] / "tests" / "data" / "press_3d.json"
GAMMA = 2 - np.sqrt(2)
EDGE_CELL = 5e-3
"""Smallest cell over half the side of the contact, at its edge, where the flux is nearly singular; refine = 1."""
ORDER = 2.5
"""In which the error of the drop falls with refine: 2 to 3 between the levels 1, 1.4 and 2 of the reference cases."""
TOLERANCE = 0.002
"""K, what the reference table itself is good to."""


@dataclass(frozen=True, slots=True)
class FemCurves:
    """t, temperature_drop K, heat_flow W: (n,). stored_heat: (n, 2) J gained by the sensor and the object.
    passed_heat: (n,) J through the opening contact. nodes: of the mesh."""

    t: np.ndarray
    temperature_drop: np.ndarray
    heat_flow: np.ndarray
    stored_heat: np.ndarray
    passed_heat: np.ndarray
    nodes: int


@dataclass(frozen=True, slots=True)
class Extrapolated:
    """levels: from coarse to fine. value (n,) K: the drop with the mesh error taken off. error: K, the finest
    level's largest distance from it, which is the mesh error to be shown."""

    levels: tuple[FemCurves, ...]
    value: np.ndarray
    error: float


@dataclass(frozen=True, slots=True)
class System:
    """mass @ v' + stiffness @ v = load, temperatures u = spread @ v + fixed in every node (K above the object's first).

    drop, contact: rows on u for the temperature drop K and the heat flow W (contact @ u + contact_source).
    stored: (2, N) heat capacity of every node, of the sensor and of the object. initial: v at the touch.
    """

    mass: sparse.csc_matrix
    stiffness: sparse.csc_matrix
    load: np.ndarray
    spread: sparse.csr_matrix
    fixed: np.ndarray
    drop: np.ndarray
    contact: np.ndarray
    contact_source: float
    stored: np.ndarray
    initial: np.ndarray


@BilinearForm
def _conduction(u, v, w):
    return w.value * dot(u.grad, v.grad)


@BilinearForm
def weighted(u, v, w):
    return w.value * u * v


@BilinearForm
def _product(u, v, w):
    return u * v


@LinearForm
def _integral(v, w):
    return v


class Block:
    """One body's quarter on a tensor mesh, its layers between the given heights.

    x, y, z: m, mesh lines. heights: m, bounds of the layers. conductivity, heat_capacity: of the layers.
    """

    def __init__(
        self,
        x: np.ndarray,
        y: np.ndarray,
        z: np.ndarray,
        heights: Sequence[float],
        conductivity: Sequence[float],
        heat_capacity: Sequence[float],
    ) -> None:
        self.mesh = MeshHex.init_tensor(x, y, z)
        self.basis = Basis(self.mesh, ElementHex2(), intorder=4)
        layer = np.searchsorted(np.asarray(heights)[1:-1], np.asarray(self.basis.global_coordinates())[2])
        self.stiffness = _conduction.assemble(
            self.basis, value=DiscreteField(np.asarray(conductivity)[layer])
        )
        self.mass = weighted.assemble(self.basis, value=DiscreteField(np.asarray(heat_capacity)[layer]))

    def face(self, axis: int, position: float, within: float = np.inf) -> FacetBasis:
        """The facets in a plane, those with x and y below `within` (m)."""
        near = 1e-9

        def chosen(p: np.ndarray) -> np.ndarray:
            return (np.abs(p[axis] - position) < near) & (p[0] < within) & (p[1] < within)

        return FacetBasis(self.mesh, ElementHex2(), facets=self.mesh.facets_satisfying(chosen), intorder=4)

    def nodes(self, face: FacetBasis) -> np.ndarray:
        """The nodes of a horizontal face, ordered by where they are."""
        nodes = self.basis.get_dofs(face.find).flatten()
        place = np.round(self.basis.doflocs[:2, nodes] * 1e12)
        return nodes[np.lexsort((place[1], place[0]))]


def toward(start: float, stop: float, count: int, last: float) -> np.ndarray:
    """count + 1 mesh lines from start to stop, the intervals shrinking in equal ratio to `last` (m) at stop."""
    length = abs(stop - start)
    powers = np.arange(count)
    ratio = 1.0
    if count > 1 and last * count < length:
        ratio = float(np.asarray(brentq(lambda r: last * np.sum(r**-powers) - length, 1e-4, 1.0)))
    widths = ratio**powers
    return start + (stop - start) * np.concatenate(([0.0], np.cumsum(widths))) / widths.sum()


def joined(*parts: np.ndarray) -> np.ndarray:
    return np.concatenate([parts[0], *(part[1:] for part in parts[1:])])


def blocks(problem: PressProblem, refine: float) -> tuple[Block, Block, float]:
    """The sensor above z = 0 and the object below it, and half the side of the contact m. refine: 1 is coarse."""
    if problem.shape != "square" or callable(problem.conductance):
        raise ValueError("the finite-element reference has square patches and constant conductance only")

    def cells(count: int) -> int:
        return round(count * refine)

    stack = problem.stack
    half, patch = stack.width / 2, min(np.sqrt(problem.area), stack.width) / 2
    last = EDGE_CELL * patch / refine**2
    face = toward(0.0, patch, cells(6), last)
    if patch < half * (1 - 1e-6):
        if problem.mode == "T":
            face = joined(face, toward(half, patch, cells(4), last)[::-1])
        else:
            middle = (half + patch) / 2
            face = joined(
                face, toward(middle, patch, cells(4), last)[::-1], toward(middle, half, cells(4), last)
            )
    inner = face if problem.mode == "O" else face[face <= patch * (1 + 1e-9)]
    sides = [
        joined(inner, toward(size / 2, inner[-1], cells(7), last)[::-1])
        if size / 2 > inner[-1] * (1 + 1e-6)
        else inner
        for size in problem.object_size[:2]
    ]
    # upward from the object: the layers in reverse
    layers = stack.layers[::-1]
    heights = np.concatenate(([0.0], np.cumsum([layer.thickness for layer in layers])))
    pieces = []
    for n, (low, high) in enumerate(zip(heights[:-1], heights[1:], strict=True)):
        fine_below, fine_above = n == 0, problem.mode == "O" and n == len(layers) - 1
        if fine_below and fine_above:
            middle = (low + high) / 2
            pieces += [toward(middle, low, cells(4), last)[::-1], toward(middle, high, cells(4), last)]
        elif fine_below:
            pieces.append(toward(high, low, cells(3), last)[::-1])
        elif fine_above:
            pieces.append(toward(low, high, cells(3), last))
        else:
            pieces.append(np.linspace(low, high, cells(3) + 1))
    upper = Block(
        face,
        face,
        joined(*pieces),
        list(heights),
        [layer.conductivity for layer in layers],
        [layer.density * layer.specific_heat for layer in layers],
    )
    depth = problem.object_size[2]
    lower = Block(
        sides[0],
        sides[1],
        toward(-depth, 0.0, cells(7), last),
        [-depth, 0.0],
        [problem.material.conductivity],
        [problem.material.density * problem.material.specific_heat],
    )
    return upper, lower, float(patch)


def assemble(problem: PressProblem, refine: float) -> System:
    """The semi-discrete press on one mesh."""
    upper, lower, patch = blocks(problem, refine)
    offset = upper.basis.N
    total = offset + lower.basis.N
    mass = sparse.block_diag([upper.mass, lower.mass], format="csr")
    stiffness = sparse.block_diag([upper.stiffness, lower.stiffness], format="csr")
    bounds = upper.mesh.p[2].max() - np.concatenate(
        ([0.0], np.cumsum([layer.thickness for layer in problem.stack.layers]))
    )
    half = problem.stack.width / 2

    # the opening contact
    height = 0.0 if problem.mode == "T" else bounds[0]
    face = upper.face(2, height, patch)
    above = upper.nodes(face)
    weights = _product.assemble(face)[above][:, above]
    rows = np.arange(len(above))
    jump = sparse.csr_matrix((np.ones(len(above)), (rows, above)), shape=(len(above), total))
    source = np.zeros(total)
    assert not callable(problem.conductance)  # blocks() has refused it
    difference, conductance = problem.temperature_difference, problem.conductance
    area = weights.sum()
    if problem.mode == "T":
        below = lower.nodes(lower.face(2, 0.0, patch)) + offset
        jump = jump - sparse.csr_matrix((np.ones(len(below)), (rows, below)), shape=jump.shape)
        contact, contact_source = 4 * conductance * (jump.T @ (weights @ np.ones(len(above)))), 0.0
        touched = patch
    else:
        source[above] = conductance * difference * (weights @ np.ones(len(above)))
        contact = -4 * conductance * (jump.T @ (weights @ np.ones(len(above))))
        contact_source = 4 * conductance * difference * area
        touched = half
    stiffness = stiffness + conductance * (jump.T @ weights @ jump)

    # air on the object's free faces
    if problem.air:
        mesh, (width, depth, thickness) = lower.mesh, problem.object_size
        planes = ((0, width / 2), (1, depth / 2), (2, -thickness))
        free = [lower.face(axis, position).find for axis, position in planes]
        top = mesh.facets_satisfying(lambda p: (np.abs(p[2]) < 1e-9) & ((p[0] > touched) | (p[1] > touched)))
        film = _product.assemble(
            FacetBasis(mesh, ElementHex2(), facets=np.unique(np.concatenate([*free, top])), intorder=4)
        )
        stiffness = stiffness + problem.air * sparse.block_diag([sparse.csr_matrix((offset, offset)), film])

    # nodes held by the thermostat (T) or shared by the two meshes (O)
    target = np.arange(total)
    fixed = np.zeros(total)
    if problem.mode == "T":
        held = upper.nodes(upper.face(2, bounds[0]))
        fixed[held] = difference
        kept = np.setdiff1d(target, held)
    else:
        shared = lower.nodes(lower.face(2, 0.0, half)) + offset
        target[shared] = upper.nodes(upper.face(2, 0.0, half))
        kept = np.setdiff1d(np.arange(total), shared)
    number = np.full(total, -1)
    number[kept] = np.arange(len(kept))
    column = number[target]
    filled = column >= 0
    spread = sparse.csr_matrix(
        (np.ones(filled.sum()), (np.flatnonzero(filled), column[filled])), shape=(total, len(kept))
    )

    drop = np.zeros(total)
    for position, sign in zip(
        bounds[problem.stack.sensed : problem.stack.sensed + 2], (1.0, -1.0), strict=True
    ):
        mean = _integral.assemble(upper.face(2, position))
        drop[:offset] += sign * mean / mean.sum()
    stored = np.zeros((2, total))
    stored[0, :offset] = 4 * np.asarray(upper.mass.sum(axis=0)).ravel()
    stored[1, offset:] = 4 * np.asarray(lower.mass.sum(axis=0)).ravel()
    at_first = np.where(np.arange(total) < offset, difference if problem.mode == "T" else 0.0, 0.0)
    return System(
        mass=(spread.T @ mass @ spread).tocsc(),
        stiffness=(spread.T @ stiffness @ spread).tocsc(),
        load=spread.T @ (source - stiffness @ fixed),
        spread=spread,
        fixed=fixed,
        drop=drop,
        contact=contact,
        contact_source=contact_source,
        stored=stored,
        initial=at_first[kept],
    )


def factor(matrix: sparse.csc_matrix) -> SuperLU:
    """Sparse LU of a symmetric positive definite matrix, ordered for symmetry."""
    return splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


def tr_bdf2(solver: SuperLU, system: System, v: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """State in the middle and at the end of a step (s); solver of mass + GAMMA / 2 * step * stiffness."""
    weight = GAMMA / 2 * step
    middle = solver.solve(system.mass @ v - weight * (system.stiffness @ v - 2 * system.load))
    mix = 1 / (GAMMA * (2 - GAMMA))
    end = solver.solve(system.mass @ (mix * middle + (1 - mix) * v) + weight * system.load)
    return middle, end


def run(
    problem: PressProblem,
    t: np.ndarray,
    refine: float = 1.0,
    first_step: float = 2.5e-4,
    step_per_time: float = 0.1,
) -> FemCurves:
    """Curves at the times t (n,) s > 0 on one mesh.

    refine: 1 is coarse, every number of cells grows with it. first_step: s; steps grow fourfold where they stay below
    step_per_time of the time since the touch.
    """
    system = assemble(problem, refine)

    def read(v: np.ndarray) -> list[float]:
        u = system.spread @ v + system.fixed
        flow = system.contact @ u + system.contact_source
        return [float(system.drop @ u), float(flow), *(system.stored @ u).tolist()]

    v, now, step = system.initial, 0.0, first_step
    times, readings, passed = [0.0], [read(v)], [0.0]
    solver = None
    while now < t[-1]:
        if 4 * step <= step_per_time * now:
            step, solver = 4 * step, None
        if solver is None:
            solver = factor((system.mass + GAMMA / 2 * step * system.stiffness).tocsc())
        middle, v = tr_bdf2(solver, system, v, step)
        readings.append(read(v))
        halfway = passed[-1] + GAMMA / 2 * step * (readings[-2][1] + read(middle)[1])
        mix = 1 / (GAMMA * (2 - GAMMA))
        passed.append(mix * halfway + (1 - mix) * passed[-1] + GAMMA / 2 * step * readings[-1][1])
        now += step
        times.append(now)
    table = np.column_stack((readings, passed))
    table[:, 2:4] -= table[0, 2:4]
    drop, flow, in_sensor, in_object, through = CubicSpline(times, table)(t).T
    return FemCurves(t, drop, flow, np.stack((in_sensor, in_object), axis=1), through, len(v))


def extrapolate(problem: PressProblem, t: np.ndarray, levels: Sequence[float] = (1.0, 1.4)) -> Extrapolated:
    """Curves on meshes of two or more levels, and the drop with the mesh error taken off as if it fell in ORDER."""
    curves = tuple(run(problem, t, refine) for refine in levels)
    coarse, fine = curves[-2:]
    change = (fine.temperature_drop - coarse.temperature_drop) / ((levels[-1] / levels[-2]) ** ORDER - 1)
    return Extrapolated(curves, fine.temperature_drop + change, float(np.abs(change).max()))


def reference_problem(case: str) -> PressProblem:
    """The press of a case "material/conductance/mode" of the reference table."""
    name, conductance, mode = case.split("/")
    return PressProblem(
        stack=sensor("seed"),
        material=material(name),
        mode="T" if mode == "T" else "O",
        conductance=float(conductance),
        area=81e-6,
        shape="square",
        object_size=(0.04, 0.04, 0.01),
        air=0.0,
        sensor_temperature=36.0,
        object_temperature=24.0,
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; 0 if every case agrees with the reference within its mesh error and TOLERANCE."""
    parser = argparse.ArgumentParser(description="Finite elements against the reference table.")
    parser.add_argument("case", nargs="?", default="", help="part of a case's name, such as glass or 10000/T")
    parser.add_argument("--levels", nargs="+", type=float, default=[1.0, 1.4], help="meshes, coarse to fine")
    parser.add_argument("--json", action="store_true", help="one JSON object a case")
    options = parser.parse_args(arguments)
    if len(options.levels) < 2:
        parser.error("give at least two levels")
    cases = {
        k: v
        for k, v in json.loads(REFERENCE.read_text(encoding="utf-8"))["cases"].items()
        if options.case in k
    }
    if not cases:
        parser.error(f"no case has {options.case!r} in its name")
    agree = True
    for case, reference in cases.items():
        start = time.perf_counter()
        result = extrapolate(reference_problem(case), np.array(reference["t"]), options.levels)
        seconds = time.perf_counter() - start
        finest = result.levels[-1]
        off = {
            "finest": float(np.abs(finest.temperature_drop - reference["Td"]).max()),
            "extrapolated": float(np.abs(result.value - reference["Td"]).max()),
        }
        agrees = max(off.values()) <= result.error + TOLERANCE
        agree &= agrees
        if options.json:
            record = {
                "case": case,
                "nodes": [level.nodes for level in result.levels],
                "t": reference["t"],
                "temperature_drop": [level.temperature_drop.tolist() for level in result.levels],
                "extrapolated": result.value.tolist(),
                "mesh_error": result.error,
                "difference": off,
                "agrees": agrees,
                "seconds": seconds,
            }
            print(json.dumps(record), flush=True)
            continue
        print(
            f"{case}: {finest.nodes} nodes, {seconds:.0f} s, mesh error {result.error:.4f} K; largest difference"
        )
        print(
            f"  from the reference: finest mesh {off['finest']:.4f} K, extrapolated {off['extrapolated']:.4f} K"
        )
        for row in zip(reference["t"], reference["Td"], finest.temperature_drop, result.value, strict=True):
            print(
                "  {:6.2f} s  reference {:8.5f}  finest {:8.5f}  extrapolated {:8.5f} K".format(*row),
                flush=True,
            )
    return 0 if agree else 1


if __name__ == "__main__":
    sys.exit(main())
