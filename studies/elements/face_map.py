"""Temperature over the sensor's face by finite elements with scikit-fem, and how far thermal/batch/face.py is from it.

Half of the element and of an object beside its symmetry plane are two meshes of triquadratic hexahedra, joined by a
conductance that differs from place to place (see fem.py). The object may end under the face.

    python studies/elements/face_map.py               every case, two meshes
    python studies/elements/face_map.py half --json   cases whose name contains "half", as JSON

Needs scikit-fem.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from fem import GAMMA, Block, factor, joined, toward, weighted
from scipy import sparse
from skfem.element import DiscreteField

from thermograsp.thermal import (
    Geometry,
    Orders,
    advance_heat,
    heat_tables,
    network_of,
)
from thermograsp.thermal.batch import (
    CELLS,
    cosine_means,
    face_field,
    face_means,
    face_state,
    step_face,
)
from thermograsp.thermal.matter import material, sensor

STACK = sensor("seed")
HALF = STACK.width / 2
DIFFERENCE = 12.0
"""K of the thermostat above the object's first temperature."""
TIMES = (0.1, 0.3, 1.0, 3.0, 10.0)
"""s after the touch."""
PARTS = 6
"""Of the face's sides: 1.5 mm each."""
STEP = 0.02
"""s, of the model: a control step."""
_SAMPLES = 240  # along the face


@dataclass(frozen=True, slots=True)
class Case:
    """material: of the object. reach: m, where the object begins and ends along y, the face's middle at 0. conductance:
    W/(m2 K) at (x, y) m of the face. area: m2 of the contact."""

    material: str
    reach: tuple[float, float]
    conductance: Callable[[np.ndarray, np.ndarray], np.ndarray]
    area: float


@dataclass(frozen=True, slots=True)
class Faces:
    """face (times, PARTS, PARTS) K above the object's first temperature: means over equal parts, rows along x. contact
    (times,) K, their mean over the contact. flow (steps,) W, means over steps of STEP."""

    face: np.ndarray
    contact: np.ndarray
    flow: np.ndarray
    nodes: int


def cases() -> dict[str, Case]:
    """Full, half and spot contacts of four materials."""
    radius = 2.5e-3

    def even(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.full(np.broadcast(x, y).shape, 1e4)

    def spot(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return 1e4 * np.maximum(1 - (x**2 + y**2) / radius**2, 0.0) ** 0.95

    found: dict[str, Case] = {}
    for name in ("aluminium", "stainless_steel", "glass", "plastic"):
        found[f"{name}/full"] = Case(name, (-0.02, 0.02), even, STACK.face_area)
        found[f"{name}/half"] = Case(name, (0.0, 0.04), even, STACK.face_area / 2)
        found[f"{name}/spot"] = Case(name, (-0.02, 0.02), spot, np.pi * radius**2)
    return found


def _lines(case: Case, refine: float) -> tuple[np.ndarray, ...]:
    """m: x and y of the face, and x and y of the object."""
    last = 0.02 * HALF / refine**2

    def cells(count: int) -> int:
        return max(round(count * refine), 2)

    def both(low: float, high: float, count: int) -> np.ndarray:
        middle = (low + high) / 2
        return joined(toward(middle, low, cells(count), last)[::-1], toward(middle, high, cells(count), last))

    x = toward(0.0, HALF, cells(9), last)
    ends = 0.0 if case.reach[0] > -HALF else None
    y = both(-HALF, HALF, 8) if ends is None else joined(both(-HALF, ends, 5), both(ends, HALF, 5))
    x_lines = joined(x, toward(0.02, HALF, cells(6), last)[::-1])
    beyond = toward(case.reach[1], HALF, cells(6), last)[::-1]
    if ends is None:
        y_lines = joined(toward(case.reach[0], -HALF, cells(6), last), y, beyond)
    else:
        y_lines = joined(y[y >= ends - 1e-12], beyond)
    return x, y, x_lines, y_lines


def solved(case: Case, refine: float) -> Faces:
    """By finite elements on one mesh."""
    x, y, x_lines, y_lines = _lines(case, refine)
    layers = STACK.layers[::-1]
    heights = np.concatenate(([0.0], np.cumsum([layer.thickness for layer in layers])))
    count = max(round(3 * refine), 2)
    first = toward(heights[1], 0.0, count, 0.05e-3)[::-1]
    pieces = [np.linspace(a, b, count + 1) for a, b in zip(heights[1:-1], heights[2:], strict=True)]
    upper = Block(
        x,
        y,
        joined(first, *pieces),
        list(heights),
        [layer.conductivity for layer in layers],
        [layer.volumetric_heat_capacity for layer in layers],
    )
    body = material(case.material)
    depth = 0.01
    lower = Block(
        x_lines,
        y_lines,
        toward(-depth, 0.0, max(round(6 * refine), 3), 0.05e-3),
        [-depth, 0.0],
        [body.conductivity],
        [body.volumetric_heat_capacity],
    )
    offset = upper.basis.N
    total = offset + lower.basis.N
    low = max(case.reach[0], -HALF)

    def facing_nodes(block: Block) -> np.ndarray:
        face = block.face(2, 0.0)
        nodes = block.nodes(face)
        at = block.basis.doflocs[:2, nodes]
        near = 1e-9
        return nodes[(at[0] <= HALF + near) & (at[1] >= low - near) & (at[1] <= HALF + near)]

    above, below = facing_nodes(upper), facing_nodes(lower) + offset
    facets = upper.face(2, 0.0)
    middles = upper.mesh.p[:, upper.mesh.facets[:, facets.find]].mean(axis=1)
    touching = facets.find[middles[1] > low]
    basis = type(facets)(upper.mesh, facets.elem, facets=touching, intorder=6)
    place = np.asarray(basis.global_coordinates())
    value = DiscreteField(case.conductance(place[0], place[1]))
    weights = weighted.assemble(basis, value=value)[above][:, above]
    rows = np.arange(len(above))
    jump = sparse.csr_matrix((np.ones(len(above)), (rows, above)), shape=(len(above), total))
    jump = jump - sparse.csr_matrix((np.ones(len(below)), (rows, below)), shape=jump.shape)
    mass = sparse.block_diag([upper.mass, lower.mass], format="csr")
    stiffness = sparse.block_diag([upper.stiffness, lower.stiffness], format="csr")
    stiffness = stiffness + jump.T @ weights @ jump
    flow_row = 2 * (jump.T @ (weights @ np.ones(len(above))))

    held = upper.nodes(upper.face(2, heights[-1]))
    kept = np.setdiff1d(np.arange(total), held)
    fixed = np.zeros(total)
    fixed[held] = DIFFERENCE
    load = -(stiffness @ fixed)[kept]
    mass, stiffness = mass[kept][:, kept].tocsc(), stiffness[kept][:, kept].tocsc()
    u = np.where(np.arange(total) < offset, DIFFERENCE, 0.0)
    v = u[kept]

    means, share = _means(upper, total, case)
    times, flows = [0.0], [float(flow_row @ u)]
    faces, contacts = [], []
    now, step, solver = 0.0, 1e-3, None
    marks = list(TIMES)
    while marks:
        if solver is None:
            solver = factor((mass + GAMMA / 2 * step * stiffness).tocsc())
        weight, mix = GAMMA / 2 * step, 1 / (GAMMA * (2 - GAMMA))
        middle = solver.solve(mass @ v - weight * (stiffness @ v - 2 * load))
        v = solver.solve(mass @ (mix * middle + (1 - mix) * v) + weight * load)
        now += step
        u = fixed.copy()
        u[kept] = v
        times.append(now)
        flows.append(float(flow_row @ u))
        if abs(now - marks[0]) < 1e-9:
            faces.append((means @ u).reshape(PARTS, PARTS))
            contacts.append(float(share @ u))
            marks.pop(0)
            if now >= 40 * step:
                step, solver = step * {0.1: 5.0, 0.3: 4.0, 1.0: 5.0, 3.0: 2.5}.get(round(now, 6), 1.0), None
    even = np.arange(0.0, TIMES[-1] + STEP / 2, STEP)
    passed = np.concatenate(([0.0], np.cumsum(np.diff(times) * (np.array(flows[1:]) + flows[:-1]) / 2)))
    flow = np.diff(np.interp(even, times, passed)) / STEP
    return Faces(np.array(faces), np.array(contacts), flow, len(v))


def _means(upper: Block, total: int, case: Case) -> tuple[np.ndarray, np.ndarray]:
    """Rows of the means over the face's parts, and of that over the contact, on all nodes."""
    nodes = upper.nodes(upper.face(2, 0.0))
    x, y = (np.unique(np.round(upper.basis.doflocs[axis, nodes], 12)) for axis in range(2))
    samples = ((np.arange(_SAMPLES) + 0.5) / _SAMPLES - 0.5) * 2 * HALF
    at_x, at_y = _quadratic(x, np.abs(samples)), _quadratic(y, samples)  # mirrored along x
    along_x, along_y = (each.reshape(PARTS, -1, each.shape[1]).mean(axis=1) for each in (at_x, at_y))
    means = np.zeros((PARTS * PARTS, total))
    means[:, nodes] = np.einsum("ai,bj->abij", along_x, along_y).reshape(PARTS**2, -1)
    touched = case.conductance(samples[:, None], samples) * (samples > case.reach[0]) > 0
    share = np.zeros(total)
    share[nodes] = (at_x.T @ touched @ at_y / touched.sum()).ravel()
    return means, share


def _quadratic(nodes: np.ndarray, places: np.ndarray) -> np.ndarray:
    """(places, nodes): interpolation by parabolas through each other node, the node between and the next."""
    first = 2 * np.clip(np.searchsorted(nodes[::2], places) - 1, 0, len(nodes) // 2 - 1)
    found = np.zeros((len(places), len(nodes)))
    rows = np.arange(len(places))
    a, b, c = (nodes[first + k] for k in range(3))
    found[rows, first] = (places - b) * (places - c) / ((a - b) * (a - c))
    found[rows, first + 1] = (places - a) * (places - c) / ((b - a) * (b - c))
    found[rows, first + 2] = (places - a) * (places - b) / ((c - a) * (c - b))
    return found


def modelled(case: Case, flow: np.ndarray, contact: np.ndarray) -> np.ndarray:
    """(times, PARTS, PARTS) K by face_field from a heat flow (steps,) W and the mean over the contact (times,) K."""
    body = material(case.material)
    field = face_field(STACK, body.layer(0.01), STEP)
    state = face_state()
    middles = ((np.arange(CELLS) + 0.5) / CELLS - 0.5) * STACK.width
    x, y = np.meshgrid(middles, middles, indexing="ij")
    conductance = np.where(y > case.reach[0], case.conductance(x, y), 0.0)
    parts = cosine_means(PARTS)
    ends = [round(mark / STEP) - 1 for mark in TIMES]
    found = []
    for step, each in enumerate(flow):
        step_face(field, conductance, each / STACK.face_area, *state)
        if step in ends:
            found.append(
                face_means(field.waves, state.surface, state.contact, parts, parts) + contact[len(found)]
            )
    return np.array(found)


def networked(case: Case) -> tuple[np.ndarray, np.ndarray]:
    """Heat flow (steps,) W and mean over the contact (times,) K by the network of a centred square of the contact's
    area on the same plate, of 3/16/16 orders."""
    low, high = case.reach
    size = (0.04, high - low, 0.01)
    geometry = Geometry(STACK, material(case.material), "T", case.area, "square", size)
    system = network_of(geometry, Orders.parse("3/16/16"), cache=False)
    tables = heat_tables([system], [0.0], STEP)
    middles = ((np.arange(90) + 0.5) / 90 - 0.5) * STACK.width
    x, y = np.meshgrid(middles, middles, indexing="ij")
    conductance = np.where(y > low, case.conductance(x, y), 0.0)
    total = float(conductance.mean() * STACK.face_area)
    steps = round(TIMES[-1] / STEP)
    _, reading = advance_heat(
        tables,
        np.zeros(1, int),
        np.zeros((1, len(system.rates))),
        np.full((1, 1), total),
        np.full((1, 1), DIFFERENCE),
        np.ones(1, bool),
        steps,
    )
    ends = [round(mark / STEP) - 1 for mark in TIMES]
    return reading.flow[0, :, 0], DIFFERENCE + reading.sensor_rise[0, ends, 0]


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description="The temperature over the face against finite elements.")
    parser.add_argument("case", nargs="?", default="", help="part of a case's name, such as glass or half")
    parser.add_argument("--levels", nargs="+", type=float, default=[0.7, 1.0], help="meshes, coarse to fine")
    parser.add_argument("--json", action="store_true", help="one JSON object a case")
    options = parser.parse_args(arguments)
    chosen = {name: case for name, case in cases().items() if options.case in name}
    if not chosen:
        parser.error(f"no case has {options.case!r} in its name")
    for name, case in chosen.items():
        start = time.perf_counter()
        levels = [solved(case, refine) for refine in options.levels]
        finest = levels[-1]
        ours = modelled(case, finest.flow, finest.contact)
        flow, contact = networked(case)
        whole = modelled(case, flow, contact)

        def worst(face: np.ndarray, reference: np.ndarray = finest.face) -> list[float]:
            return np.abs(face - reference).max(axis=(1, 2)).round(4).tolist()

        record = {
            "case": name,
            "nodes": finest.nodes,
            "t": list(TIMES),
            "spread": np.ptp(finest.face, axis=(1, 2)).round(3).tolist(),
            "mesh": worst(levels[0].face),
            "map": worst(ours),
            "network": worst(whole),
            "seconds": round(time.perf_counter() - start, 1),
        }
        if options.json:
            print(json.dumps(record), flush=True)
            continue
        print(f"{name}: {record['nodes']} nodes, {record['seconds']} s; K at t = {record['t']} s")
        for key in ("spread", "mesh", "map", "network"):
            print(f"  {key:8s}", *(f"{value:7.3f}" for value in record[key]), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
