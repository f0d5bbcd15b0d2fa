"""A ball on a skin, a pad and a half-space by axisymmetric finite elements with scikit-fem, beside our footprints.

Mechanics: linear elasticity of a layer that is bonded to a rigid base, small strains and slopes, no friction, bilinear
elements whose change of volume is integrated in one point (no locking near a Poisson ratio of 1/2). Unit forces on
the nodes of the face give its compliance; the nodes that press are those where neither a force pulls nor the ball
enters the layer (active sets). The ball is rigid: its own yielding is in the modulus of the half-space, where that
matters. Heat: the conductance of rough faces by pressure where it presses, of gas by the gap beside it, place by place.

    python studies/contact/ball_contact.py           every case: forces, contact radii, pressures, conductances
    python studies/contact/ball_contact.py --json

Needs scikit-fem.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementQuad1, ElementVector, MeshQuad

from thermograsp.thermal import (
    AIR,
    LAPPED_ALUMINA,
    SKINS,
    Joint,
    Pad,
    Skin,
    Surface,
    contact_conductance,
    joint,
    material,
)
from thermograsp.thermal.contact import bare_footprint, conduction, footprint, sphere_footprint
from thermograsp.thermal.contact.rough_faces import gas_conductance

RADIUS = 0.02
"""m, of the ball."""
_CENTRE = np.full((2, 1), 0.5), np.ones(1)
FACE = Pad().face
"""m, the sensor's face, whose area the disc in the comparison has."""


@dataclass(frozen=True, slots=True)
class Layer:
    """youngs_modulus: Pa. poisson_ratio. thickness: m, on a rigid base. reach: m, to where contacts are looked for."""

    youngs_modulus: float
    poisson_ratio: float
    thickness: float
    reach: float


@dataclass(frozen=True, slots=True)
class Contact:
    """force: N. radius: m, of the disc that touches. peak: Pa, in its middle. depth: m, of the ball. share: of force,
    what lies within the face. conductance: W/K through the face, gas beside the contact with it. balance: of the
    force, what the pressures lack of it."""

    force: float
    radius: float
    peak: float
    depth: float
    share: float
    conductance: float
    balance: float


@BilinearForm
def _shear(u, v, w):
    """2 G of strains, without the trace's part."""
    r = w.x[0]
    du, dv = u.grad, v.grad
    rz = (du[0, 1] + du[1, 0]) * (dv[0, 1] + dv[1, 0]) / 2
    return (du[0, 0] * dv[0, 0] + du[1, 1] * dv[1, 1] + u[0] * v[0] / r**2 + rz) * r


@BilinearForm
def _volume(u, v, w):
    r = w.x[0]
    return (u.grad[0, 0] + u.grad[1, 1] + u[0] / r) * (v.grad[0, 0] + v.grad[1, 1] + v[0] / r) * r


def graded(first: float, even: float, end: float, growth: float = 1.08) -> np.ndarray:
    """Mesh lines from 0: cells of `first` up to `even`, growing from there to `end`."""
    lines, cell = list(np.arange(0.0, even + first / 2, first)), first
    while lines[-1] < end:
        cell *= growth
        lines.append(lines[-1] + cell)
    return np.array(lines)


def compliance(layer: Layer, cells: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(places r m of the nodes that may touch, their rings m2, m down at each per N on each). cells: to the reach."""
    fine = layer.reach / cells
    r = graded(
        fine,
        layer.reach,
        max(8 * layer.thickness, 6 * layer.reach) if layer.thickness < np.inf else 40 * layer.reach,
    )
    deep = layer.thickness if layer.thickness < np.inf else 40 * layer.reach
    z = graded(fine, 8 * fine, deep, 1.1)
    z *= deep / z[-1]
    mesh = MeshQuad.init_tensor(r, z)
    element = ElementVector(ElementQuad1())
    basis, one = Basis(mesh, element, intorder=4), Basis(mesh, element, quadrature=_CENTRE)
    e, nu = layer.youngs_modulus, layer.poisson_ratio
    shear, first = e / (2 * (1 + nu)), e * nu / ((1 + nu) * (1 - 2 * nu))
    stiffness: Any = 2 * np.pi * (2 * shear * _shear.assemble(basis) + first * _volume.assemble(one))
    base = np.concatenate([basis.get_dofs(lambda x: x[1] > deep * (1 - 1e-9)).flatten()])
    axis = basis.get_dofs(lambda x: x[0] < 1e-12).all("u^1")
    free = np.setdiff1d(np.arange(basis.N), np.union1d(base, axis))
    top = np.flatnonzero(mesh.p[1] < 1e-12)
    top = top[np.argsort(mesh.p[0, top])]
    may = top[mesh.p[0, top] <= layer.reach * (1 + 1e-9)]
    nodal: Any = basis.nodal_dofs
    down = nodal[1, may]
    at = np.searchsorted(free, down)
    solver = splu(stiffness[free][:, free].tocsc())
    loads = np.zeros((len(free), len(may)))
    loads[at, np.arange(len(may))] = 1.0
    places = mesh.p[0, may]
    # what a node's hat function weighs on a ring: the force that an even pressure of 1 Pa puts there
    rings = np.zeros(len(may) + 1)
    ends = mesh.p[0, top][: len(may) + 1]
    low, high = ends[:-1], ends[1:]
    rings[:-1] += np.pi * (high - low) * (2 * low + high) / 3
    rings[1:] += np.pi * (high - low) * (low + 2 * high) / 3
    return places, rings[:-1], solver.solve(loads)[at]


def pressed(
    places: np.ndarray, flexible: np.ndarray, force: float, radius: float
) -> tuple[np.ndarray, np.ndarray, float]:
    """(forces N on the nodes, gap m at them, depth m) of a rigid ball of that radius m."""
    shape, touches = places**2 / (2 * radius), np.zeros(len(places), bool)
    touches[: max(2, len(places) // 4)] = True
    for _ in range(400):
        on = np.flatnonzero(touches)
        count = len(on)
        equations = np.zeros((count + 1, count + 1))
        equations[:count, :count], equations[:count, count], equations[count, :count] = (
            flexible[np.ix_(on, on)],
            -1,
            1,
        )
        solved = np.linalg.solve(equations, np.append(-shape[on], force))
        loads = np.zeros(len(places))
        loads[on] = solved[:count]
        gap = shape + flexible @ loads - solved[count]
        changed = (touches & (loads >= 0)) | (gap < -1e-12)
        if (changed == touches).all():
            return loads, np.maximum(gap, 0.0), float(solved[count])
        touches = changed
    raise RuntimeError("the nodes that touch go on changing: take another mesh")


def judged(layer: Layer, pair: Joint, force: float, cells: int = 120) -> Contact:
    """What finite elements say of a ball on that layer; pair: the faces that meet."""
    return contact_of(*compliance(layer, cells), pair, force)


def contact_of(
    places: np.ndarray, rings: np.ndarray, flexible: np.ndarray, pair: Joint, force: float
) -> Contact:
    """See judged; of a layer's compliance."""
    loads, gap, depth = pressed(places, flexible, force, RADIUS)
    pressure = loads / rings
    pressure[0] = pressure[1]  # one point integrates nothing well on the axis
    last = np.flatnonzero(loads > 0)[-1]
    # the pressure falls like a root toward the edge: where its square, drawn on, is none
    a, b = pressure[last - 1] ** 2, pressure[last] ** 2
    edge = places[last] + (places[last] - places[last - 1]) * b / (a - b) if a > b else places[last]
    disc = FACE / np.sqrt(np.pi)
    fine = np.linspace(0, disc, 40_001)
    p = np.interp(fine, places, pressure, right=0.0)
    p[fine > edge] = 0.0
    mean_gap = AIR.conductivity / float(gas_conductance(pair, 0.0))
    far = (fine**2 - places[-1] ** 2) / (2 * RADIUS) + gap[-1]  # the ball's own shape beyond the nodes
    g = np.where(fine <= places[-1], np.interp(fine, places, gap), far)
    h = np.where(p > 0, np.asarray(contact_conductance(pair, p)), AIR.conductivity / (mean_gap + g))
    within = float(loads[places <= disc].sum())
    total = float(np.trapezoid(2 * np.pi * fine * h, fine))
    return Contact(
        force, float(edge), float(pressure[0]), depth, within / force, total, float(loads.sum() / force - 1)
    )


def ours(law: np.void, force: float, springs: bool) -> Contact:
    """What the footprint of the package says."""
    middle = np.zeros(3)
    area, load = footprint(law, force, middle)
    total = conduction(law, force, middle)[1]
    return Contact(
        force,
        float(np.sqrt(area / np.pi)),
        float((2.0 if springs else 1.5) * load / area),
        0.0,
        load / force,
        float(total),
        0.0,
    )


def hertz_layer(body: Surface) -> tuple[Layer, np.void]:
    """A half-space with the modulus of the body and alumina, and our law of the bare face; contacts up to 30 N."""
    modulus = 1 / sum((1 - one.poisson_ratio**2) / one.youngs_modulus for one in (LAPPED_ALUMINA, body))
    most = (0.75 * 30 * RADIUS / modulus) ** (1 / 3)
    law = bare_footprint(Pad(), body, RADIUS)
    return Layer(modulus * (1 - 0.3**2), 0.3, np.inf, 1.6 * most), law


def cases() -> dict[str, tuple[Layer, Joint, np.void]]:
    """The layers under a steel ball, the faces and our laws."""
    steel = Surface.of(material("steel"))
    every = {}
    layer, law = hertz_layer(steel)
    # without the constriction, which is no matter of the contact's places
    law["constriction"] = 0.0
    every["bare"] = layer, joint(LAPPED_ALUMINA, steel, full_contact=True), law
    for name, thickness, e, nu in (
        ("skin 0.2 mm", 0.2e-3, 1.7e6, 0.49),
        ("skin 0.2 mm, compressible", 0.2e-3, 1.7e6, 0.3),
        ("skin 1 mm", 1e-3, 1.7e6, 0.49),
    ):
        soft = Surface(1.6, 2e-6, 0.2, e, nu, np.inf)
        sheet = replace(SKINS["filled_silicone"].made_of, youngs_modulus=e, poisson_ratio=nu)
        pad = Pad(face_stiffness=Skin(sheet, thickness).stiffness)
        pair = joint(soft, steel, full_contact=True)
        every[name] = Layer(e, nu, thickness, 4e-3), pair, sphere_footprint(pad, pair, RADIUS)
    pad = Pad()
    pair = joint(LAPPED_ALUMINA, steel)
    every["pad"] = (
        Layer(pad.youngs_modulus, 0.499, pad.thickness, 7e-3),
        pair,
        sphere_footprint(pad, pair, RADIUS),
    )
    return every


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description="A ball's contact by finite elements beside the package's.")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args(arguments)
    results = {}
    for name, (layer, pair, law) in cases().items():
        flexible = compliance(layer, 120)
        rows = [
            (contact_of(*flexible, pair, force), ours(law, force, name != "bare"))
            for force in (1.0, 10.0, 30.0)
        ]
        results[name] = [
            {"finite elements": asdict(fem), "package": asdict(package)} for fem, package in rows
        ]
        if not options.json:
            print(f"{name}\n     N   radius, mm    peak, MPa      W/K")
            for fem, package in rows:
                pairs = ((fem.radius * 1e3, package.radius * 1e3), (fem.peak / 1e6, package.peak / 1e6))
                pairs += ((fem.conductance, package.conductance),)
                print(f"{fem.force:6g}  " + "  ".join(f"{a:.4g} ({b:.4g})".ljust(16) for a, b in pairs))
    if options.json:
        json.dump(results, sys.stdout, indent=1)
    return 0


if __name__ == "__main__":
    sys.exit(main())
