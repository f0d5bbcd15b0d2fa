"""Mean temperatures of a narrow contact's two faces by finite elements, and what ThermalTouch's heat tells of them.

A square or a round contact in the middle of the sensor's face, narrower than it, opens at time 0 on a block of 40 x 40
x 10 mm. Finite elements (see fem.py) tell the mean temperatures over the contact's area on the sensor's side and on the
object's. ThermalTouch's heat is given the same area and conductance and reports them as touch/heat/reported.py does: by
the mean of the whole face, and by how much a narrow contact is colder or warmer than that. The drop stands beside them.

    python studies/elements/narrow_faces.py                       every case on two meshes, four minutes
    python studies/elements/narrow_faces.py ball/steel --json     cases whose name contains that, as JSON
    python studies/elements/narrow_faces.py --balls               bare balls of 5 to 15 mm at 1 to 20 N instead

A ball presses most in its middle and conducts best there; ThermalTouch takes a bare ball's contact as even and narrower
(thermal/contact/spread.py); "even ball" is of the mean conductance all over. Under an uneven contact the mean over the
area is not what drives heat: that mean is weighted with the conductance of each place, and stands beside it. With it
what is said of a ball's contact is compared. Needs scikit-fem.
"""

# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from fem import GAMMA, assemble, blocks, factor, tr_bdf2, weighted
from scipy import sparse
from skfem import ElementHex2, FacetBasis, LinearForm
from skfem.element import DiscreteField

from thermograsp import Fingertip, ThermalTouch
from thermograsp.thermal import SKINS, Pad, PressProblem, Surface, material, sensor
from thermograsp.thermal.contact import conductance, face_joint, flat_law, narrowing, skinned
from thermograsp.touch.contacts import AREA, CLOSED, CONDUCTANCE, FORCE, LENGTH, NORMAL, PLACE

BLOCK = (0.04, 0.04, 0.01)
"""m."""
WARM, COOL = 36.0, 24.0
"""°C of the thermostat and of the block at first."""
TIMES = (0.1, 0.3, 1.0, 3.0)
"""s after the touch."""
DT = 0.01
"""s, a sample of the touch."""
RADIUS, FORCE_N = 0.008, 10.0
"""m and N of the ball, a fingertip whose pad is as wide as its tangents at 53 degrees."""
BALLS = (0.008, 1.0), (0.005, 10.0), (0.015, 10.0), (0.008, 20.0)
"""m and N of others, on pads of the same width."""
PAD = Pad(width=0.0128, face=0.009)
EVENNESS = 0.75
"""Of a ball's pressure on springs: its mean's square over the mean of its square."""


@dataclass(frozen=True, slots=True)
class Case:
    """material: of the block. width: m, the contact's side or, of a round one, its diameter. conductance: W/(m2 K) on
    the mean. skin: over the sensor, None for a bare one. law: of a ball's contact, which conducts by the pressure of
    each place, highest in its middle, of force N; None for an even one."""

    material: str
    width: float
    conductance: float
    round: bool = False
    skin: str | None = None
    law: np.void | None = None
    force: float = FORCE_N

    @property
    def area(self) -> float:
        """m2."""
        return math.pi / 4 * self.width**2 if self.round else self.width**2

    @property
    def patch(self) -> float:
        """m2, as which a fingertip's contact counts."""
        if self.law is None or self.skin is not None:
            return self.area
        return self.area * (1 - (1 - EVENNESS) * narrowing(Surface.of(material(self.material))))

    def at(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """W/(m2 K) at places m from the contact's middle; 0 beside it."""
        if not self.round:
            return np.full(np.broadcast(x, y).shape, self.conductance)
        deep = np.maximum(1 - (x**2 + y**2) / (self.width / 2) ** 2, 0.0)
        if self.law is None:
            return np.where(deep > 0, self.conductance, 0.0)
        found, pressure = np.zeros(deep.shape), 2 * self.force / self.area * deep
        found[deep > 0] = [conductance(self.law, each) for each in pressure[deep > 0].tolist()]
        return found


def ball(
    name: str, skin: str | None, even: bool = False, radius: float = RADIUS, force: float = FORCE_N
) -> Case:
    """A ball's contact as the springs of a pad make it; even: of its conductance at the mean pressure all over, which
    is what ThermalTouch takes it to be."""
    sheet, cover = PAD.foundation_modulus / PAD.thickness, None if skin is None else SKINS[skin]
    stiffness = sheet if cover is None else cover.stiffness
    area = 2 * math.pi * radius * math.sqrt(force / (math.pi * stiffness * radius))
    law = flat_law(skinned(PAD, cover), face_joint(cover, Surface.of(material(name))), (PAD.width, PAD.width))
    mean = float(conductance(law, force / area))
    return Case(name, math.sqrt(4 * area / math.pi), mean, True, skin, None if even else law, force)


@dataclass(frozen=True, slots=True)
class Means:
    """At TIMES: drop K, and °C of the contact's sides: sensor_surface and object_surface."""

    drop: np.ndarray
    sensor: np.ndarray
    object: np.ndarray


def cases() -> dict[str, Case]:
    """Squares of two widths and a ball's contact, as uneven as its pressure and even, on metals and wood."""
    found: dict[str, Case] = {}
    for name in ("aluminium", "steel", "wood"):
        found[f"3 mm/{name}"] = Case(name, 3e-3, 1e4)
        found[f"6 mm/{name}"] = Case(name, 6e-3, 1e4)
        found[f"3 mm, skin/{name}"] = Case(name, 3e-3, 1e5, skin="filled_silicone")
        for skin, added in ((None, ""), ("filled_silicone", ", skin")):
            found[f"even ball{added}/{name}"] = ball(name, skin, even=True)
            found[f"ball{added}/{name}"] = ball(name, skin)
    return found


def balls() -> dict[str, Case]:
    """Bare balls of several sizes and forces on what conducts well and badly."""
    names = "aluminium", "copper", "steel", "stainless_steel", "ceramic", "glass", "wood"
    return {
        f"{1e3 * radius:g} mm, {force:g} N/{name}": ball(name, None, radius=radius, force=force)
        for name in names
        for radius, force in BALLS
    }


@LinearForm
def _valued(v, w):
    return w.value * v


def by_elements(case: Case, refine: float) -> tuple[Means, Means]:
    """On one mesh: means over the contact's area, and means weighted with its conductance."""
    stack = sensor("seed")
    problem = PressProblem(
        stack=stack if case.skin is None else SKINS[case.skin].over(stack),
        material=material(case.material),
        mode="T",
        conductance=1e-6,  # nearly none: the contact's own is added below, place by place
        area=case.width**2,
        shape="square",
        object_size=BLOCK,
        air=0.0,
        sensor_temperature=WARM,
        object_temperature=COOL,
    )
    system = assemble(problem, refine)
    upper, lower, patch = blocks(problem, refine)
    total = upper.basis.N + lower.basis.N
    sides, even, driving, matrices = [], [], [], []
    for body, first in ((upper, 0), (lower, upper.basis.N)):
        facets = body.face(2, 0.0, patch)
        basis = FacetBasis(body.mesh, ElementHex2(), facets=facets.find, intorder=12)
        x, y = np.asarray(basis.global_coordinates())[:2]
        value, nodes = case.at(x, y), body.nodes(facets)
        inside = DiscreteField((value > 0).astype(float))
        for row, field in ((even, inside), (driving, DiscreteField(value))):
            part = np.zeros(total)
            part[first : first + body.basis.N] = _valued.assemble(basis, value=field)
            row.append(part / part.sum())
        matrices.append(weighted.assemble(basis, value=DiscreteField(value))[nodes][:, nodes])
        sides.append(nodes + first)
    rows = np.arange(len(sides[0]))
    jump = sparse.csr_matrix((np.ones(len(rows)), (rows, sides[0])), shape=(len(rows), total))
    jump = jump - sparse.csr_matrix((np.ones(len(rows)), (rows, sides[1])), shape=jump.shape)
    spread = system.spread
    stiffness = (system.stiffness + spread.T @ (jump.T @ matrices[0] @ jump) @ spread).tocsc()
    whole = type(system)(
        *(system.mass, stiffness, system.load, spread, system.fixed, system.drop, system.contact),
        *(system.contact_source, system.stored, system.initial),
    )
    read = np.stack([system.drop, *even, *driving])
    v, now, step, solver, marks, found = whole.initial, 0.0, 1e-3, None, list(TIMES), []
    while marks:
        if solver is None:
            solver = factor((whole.mass + GAMMA / 2 * step * whole.stiffness).tocsc())
        _, v = tr_bdf2(solver, whole, v, step)
        now += step
        if abs(now - marks[0]) < 1e-9:
            found.append(read @ (spread @ v + system.fixed))
            marks.pop(0)
            step, solver = {0.1: 5e-3, 0.3: 2e-2, 1.0: 5e-2}.get(round(now, 6), step), None
    drop, *rest = np.array(found).T
    first, second, third, fourth = (each + COOL for each in rest)
    return Means(drop, first, second), Means(drop, third, fourth)


def by_touch(case: Case) -> Means:
    """ThermalTouch that is given that contact in the middle of a block's face."""
    half, top = (" ".join(str(side / 2) for side in BLOCK)), BLOCK[2] / 2
    model = mujoco.MjModel.from_xml_string(f"""
      <mujoco><option timestep="{DT}"/><worldbody>
        <body name="block"><geom name="block" type="box" size="{half}" mass="1"/></body>
        <body name="tip" pos="0 0 {top + 0.1}"><joint type="slide" axis="0 0 1"/>
          <geom name="tip" type="box" size=".01 .01 .004"/></body>
      </worldbody></mujoco>""")
    tip = Fingertip("tip", (0, 0, -0.004), (0, 0, -1), (0.02, 0.02), temperature=WARM, skin=case.skin)
    touch = ThermalTouch(
        *(model,),
        fingertips={"tip": tip},
        objects={"block": case.material},
        dt=DT,
        air=0.0,
        ambient=COOL,
        chain="ideal",
    )
    reader, data = touch._reader, mujoco.MjData(model)
    touches = np.zeros_like(reader.touches[0])
    row = touches[0, 0]
    row[[CONDUCTANCE, AREA, LENGTH]] = (
        case.conductance * case.area,
        case.patch,
        case.patch * math.sqrt(case.patch),
    )
    row[[CLOSED, FORCE]] = 1.0, 10.0
    row[PLACE : PLACE + 3], row[NORMAL : NORMAL + 3] = (0.0, 0.0, top), (0.0, 0.0, -1.0)

    def read(data: mujoco.MjData, weight: int = 1) -> None:
        reader.counted += weight
        reader.touches[0, 0, 0] += weight * row
        reader.touches[0, 0, 0, PLACE : NORMAL + 3] = row[PLACE : NORMAL + 3]

    reader.read, touch._listen = read, lambda: None
    mujoco.mj_forward(model, data)
    touch.reset(data)
    found = []
    for step in range(1, round(TIMES[-1] / DT) + 1):
        data.time += DT
        touch.update(data)
        if any(abs(step * DT - mark) < DT / 2 for mark in TIMES):
            sides = touch._heat.faces(0, touches)
            found.append((touch.reading.temperature_drop[0], sides[0][0, 0], sides[1][0, 0]))
    return Means(*np.array(found).T)


def row(name: str, case: Case, levels: Sequence[float] = (0.7, 1.0)) -> dict[str, object]:
    """K and °C of a case at TIMES. mesh_K: the largest difference between the two meshes."""
    begun = time.perf_counter()
    coarse, fine = (by_elements(case, level) for level in levels)
    touch = by_touch(case)
    found: dict[str, object] = {"case": name, "times_s": TIMES}
    sides = ("drop", "sensor", "object")
    found["mesh_K"] = max(
        float(np.abs(getattr(coarse[0], side) - getattr(fine[0], side)).max()) for side in sides
    )
    for side in sides:
        found[side] = {
            "elements": getattr(fine[0], side).round(3).tolist(),
            "driving": getattr(fine[1], side).round(3).tolist(),
            "touch": getattr(touch, side).round(3).tolist(),
        }
        off = getattr(touch, side) - getattr(fine[0] if case.law is None else fine[1], side)
        found[f"{side}_off_K"] = float(off[np.abs(off).argmax()])
    found["seconds"] = round(time.perf_counter() - begun, 1)
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("case", nargs="?", default="", help="part of a case's name")
    parser.add_argument("--levels", nargs=2, type=float, default=[0.7, 1.0], help="meshes, coarse and fine")
    parser.add_argument("--balls", action="store_true", help="bare balls of several sizes and forces")
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    given = parser.parse_args(arguments)
    chosen = {
        name: case for name, case in (balls() if given.balls else cases()).items() if given.case in name
    }
    if not chosen:
        parser.error(f"no case has {given.case!r} in its name")
    for name, case in chosen.items():
        found = row(name, case, given.levels)
        if given.json:
            print(json.dumps(found), flush=True)
            continue
        print(
            f"{name}: touch - elements at most {found['sensor_off_K']:+.2f} K on the sensor, "
            f"{found['object_off_K']:+.2f} K on the object, {found['drop_off_K']:+.2f} K of drop; "
            f"meshes {found['mesh_K']:.3f} K apart, {found['seconds']} s"
        )
        for side in ("sensor", "object", "drop"):
            each = found[side]
            assert isinstance(each, dict)
            cells = "  ".join(f"{who} " + " ".join(f"{x:6.2f}" for x in each[who]) for who in each)
            print(f"    {side:7}{cells}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
