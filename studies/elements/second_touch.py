"""A fingertip that touches a bar beside where it warmed it before: finite elements, and the environments' networks.

The fingertip is pressed for WARMING s, released for RELEASED s, and pressed for AGAIN s on a patch beside the first,
both of the sensor's face. Half of the element and of the bar are meshes as in fem.py; the element meets the bar's nodes
at one place or the other.

    python studies/elements/second_touch.py           glass, stainless steel and aluminium
    python studies/elements/second_touch.py glass --json

Needs scikit-fem.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Sequence

import numpy as np
from fem import GAMMA, Block, factor, joined, toward, weighted
from scipy import sparse
from skfem.element import DiscreteField

from thermograsp.envs import GraspBody, ObjectSpec
from thermograsp.envs.sensing import GraspHeat
from thermograsp.thermal.contact import conductance, contact
from thermograsp.thermal.matter import material, sensor

STACK = sensor("seed")
HALF = STACK.width / 2
BAR = (0.010, 0.072, 0.024)
"""m, thickness, length and height; touched in the middle of its length and of its height, then HALF * 2 along it."""
WARM, COOL = 36.0, 24.0
"""°C of the thermostat and of the bar at first."""
WARMING, RELEASED, AGAIN = 5.0, 2.0, 3.0
STEP = 0.02
"""s, of samples."""
FORCE = 10.0
"""N."""
MATERIALS = ("glass", "stainless_steel", "aluminium")


def grasp_body(name: str, anywhere: bool = True) -> GraspBody:
    """The bar, one fingertip with a sensor."""
    spec = ObjectSpec(size=BAR, mass=0.1, friction=0.8)
    return GraspBody(spec, material(name), COOL, "T", STACK, 1, anywhere=anywhere)


def by_networks(name: str, tolerance: float, anywhere: bool = True) -> np.ndarray:
    """(steps of AGAIN,) K of temperature drop. anywhere: the heat knows where it enters."""
    each = grasp_body(name, anywhere)
    heat = GraspHeat(1, tolerance=tolerance, air=0.0, dt=STEP, samples=1, sensor_temperature=WARM)
    heat.reset([0], [each])
    first = np.array([-BAR[0] / 2, 0.0, 0.0])
    beside = first + [0.0, 2 * HALF, 0.0]

    def pressed(seconds: float, at: np.ndarray | None) -> np.ndarray:
        force, place = np.zeros((1, 10, 2)), np.zeros((1, 2, 3))
        if at is not None:
            force[0, :, 0], place[0, 0] = FORCE, at
        return np.array([heat.advance(force, place).drop[0, -1, 0] for _ in range(round(seconds / STEP))])

    pressed(WARMING, first)
    pressed(RELEASED, None)
    return pressed(AGAIN, beside)


def by_elements(name: str, refine: float) -> tuple[np.ndarray, int]:
    """The same by finite elements, and the number of nodes."""
    each = grasp_body(name)
    area, load = contact(each.law, FORCE, np.zeros(3))
    through = float(conductance(each.law, load / area))

    def cells(count: int) -> int:
        return max(round(count * refine), 2)

    last = 0.01 * HALF / refine**2
    half_face = toward(0.0, HALF, cells(6), last)
    face_y = joined(-half_face[::-1], half_face)
    x = half_face
    x_lines = joined(x, toward(BAR[2] / 2, HALF, cells(4), last)[::-1])
    far = BAR[1] / 2
    y_lines = joined(
        toward(-far, -HALF, cells(5), last),
        face_y,
        face_y + 2 * HALF,
        toward(far, 3 * HALF, cells(5), last)[::-1],
    )
    layers = STACK.layers[::-1]
    heights = np.concatenate(([0.0], np.cumsum([layer.thickness for layer in layers])))
    count = cells(3)
    pieces = [toward(heights[1], 0.0, count, 0.05e-3)[::-1]]
    pieces += [np.linspace(a, b, count + 1) for a, b in zip(heights[1:-1], heights[2:], strict=True)]
    upper = Block(
        x,
        face_y,
        joined(*pieces),
        list(heights),
        [layer.conductivity for layer in layers],
        [layer.volumetric_heat_capacity for layer in layers],
    )
    body = material(name)
    lower = Block(
        x_lines,
        y_lines,
        toward(-BAR[0], 0.0, cells(6), 0.05e-3),
        [-BAR[0], 0.0],
        [body.conductivity],
        [body.volumetric_heat_capacity],
    )
    offset = upper.basis.N
    total = offset + lower.basis.N
    facets = upper.face(2, 0.0)
    above = upper.nodes(facets)
    one = DiscreteField(np.ones_like(np.asarray(facets.global_coordinates())[0]))
    weights = through * weighted.assemble(facets, value=one)[above][:, above]
    plain = sparse.block_diag([upper.stiffness, lower.stiffness], format="csr")

    def touched(along: float) -> sparse.csr_matrix:
        nodes = lower.nodes(lower.face(2, 0.0))
        at = lower.basis.doflocs[:2, nodes]
        near = 1e-9
        contact_nodes = nodes[(at[0] <= HALF + near) & (np.abs(at[1] - along) <= HALF + near)] + offset
        rows, ones = np.arange(len(above)), np.ones(len(above))
        jump = sparse.csr_matrix((ones, (rows, above)), shape=(len(above), total))
        jump = jump - sparse.csr_matrix((ones, (rows, contact_nodes)), shape=jump.shape)
        return plain + jump.T @ weights @ jump

    held = upper.nodes(upper.face(2, heights[-1]))
    kept = np.setdiff1d(np.arange(total), held)
    mass = sparse.block_diag([upper.mass, lower.mass], format="csr")[kept][:, kept].tocsc()
    difference = WARM - COOL
    fixed = np.zeros(total)
    fixed[held] = difference
    v = np.where(np.arange(total) < offset, difference, 0.0)[kept]
    drop = np.zeros(total)
    bounds = heights[::-1]
    for height, sign in zip(bounds[STACK.sensed : STACK.sensed + 2], (1.0, -1.0), strict=True):
        level = upper.face(2, height)
        value = DiscreteField(np.ones_like(np.asarray(level.global_coordinates())[0]))
        mean = np.asarray(weighted.assemble(level, value=value).sum(axis=0)).ravel()
        drop[:offset] += sign * mean / mean.sum()
    read = []
    for seconds, stiffness in ((WARMING, touched(0.0)), (RELEASED, plain), (AGAIN, touched(2 * HALF))):
        load = -(stiffness @ fixed)[kept]
        inner = stiffness[kept][:, kept].tocsc()
        now, read = 0.0, []
        for step, until in ((STEP / 16, 3 * STEP), (STEP / 2, 0.5), (STEP, seconds)):
            solver = factor((mass + GAMMA / 2 * step * inner).tocsc())
            weight, mix = GAMMA / 2 * step, 1 / (GAMMA * (2 - GAMMA))
            while now < until - 1e-9:
                middle = solver.solve(mass @ v - weight * (inner @ v - 2 * load))
                v = solver.solve(mass @ (mix * middle + (1 - mix) * v) + weight * load)
                now += step
                if abs(now / STEP - round(now / STEP)) < 1e-6:
                    u = fixed.copy()
                    u[kept] = v
                    read.append(float(drop @ u))
    return np.array(read), len(v)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description="A touch beside a warm place against finite elements.")
    parser.add_argument("material", nargs="?", default="", help="part of a material's name")
    parser.add_argument("--refine", type=float, default=1.0, help="of the mesh (default 1)")
    parser.add_argument("--json", action="store_true", help="one JSON object a material")
    options = parser.parse_args(arguments)
    chosen = [name for name in MATERIALS if options.material in name]
    if not chosen:
        parser.error(f"no material has {options.material!r} in its name")
    late = slice(round(0.06 / STEP) - 1, None)
    for name in chosen:
        begun = time.perf_counter()
        expected, nodes = by_elements(name, options.refine)
        record: dict[str, object] = {
            "material": name,
            "nodes": nodes,
            "drop_K": expected[[4, 24, 49, -1]].round(3).tolist(),
        }
        for key, found in {
            "heat kernels": by_networks(name, 0.05),
            "mesh, tolerance 0.03": by_networks(name, 0.03),
            "mean temperature only": by_networks(name, 0.05, anywhere=False),
        }.items():
            record[key] = round(float(np.abs(found - expected)[late].max()), 4)
        record["seconds"] = round(time.perf_counter() - begun, 1)
        print(json.dumps(record) if options.json else record, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
