"""A curved wall against finite elements, which share nothing with the grids: a tube pressed on its outside, of one
material and in a sleeve of another."""

import numpy as np
import pytest
import trimesh

from thermograsp import thermal
from thermograsp.thermal.meshes.network import body_network
from thermograsp.thermal.surfaces.solid import (
    Solid,
    SolidPart,
    SurfacePatch,
    solid,
)

skfem = pytest.importorskip("skfem", reason="the extra fem is not installed")

OUTER, INNER, HALF_LENGTH, HALF_WIDTH = 0.020, 0.017, 0.015, 0.0045
SLEEVE = 0.0005  # m
MOMENTS = np.array([0.1, 0.5, 2.0, 8.0])  # 1/s


def graded(stops, counts, ratios):
    """Points from stop to stop, so many intervals each, the last over the first of each as its ratio."""
    points = [np.array([stops[0]])]
    for a, b, n, ratio in zip(stops[:-1], stops[1:], counts, ratios, strict=True):
        steps = ratio ** (np.arange(n) / max(n - 1, 1))
        points.append(a + (b - a) * np.cumsum(steps) / steps.sum())
    return np.concatenate(points)


def tube_by_elements(material, sleeve=None) -> np.ndarray:
    """Impedance (S,) K/W of the patch: a quarter of the tube, triquadratic hexahedra in cylinder coordinates. sleeve:
    of the outermost SLEEVE, None for the same."""
    edge = np.arcsin(HALF_WIDTH / OUTER)
    depth = graded((0.0, SLEEVE, OUTER - INNER), (4, 4), (6.0, 3.0))
    angle = graded((0.0, edge, np.pi), (6, 12), (0.1, 20.0))
    height = graded((0.0, HALF_WIDTH, HALF_LENGTH), (6, 7), (0.1, 10.0))
    mesh = skfem.MeshHex.init_tensor(depth, angle, height)
    basis = skfem.Basis(mesh, skfem.ElementHex2(), intorder=4)
    sleeve = sleeve or material

    def of(name, w):
        return np.where(w.x[0] < SLEEVE, getattr(sleeve, name), getattr(material, name))

    @skfem.BilinearForm
    def stiffness(u, v, w):
        r, k = OUTER - w.x[0], of("conductivity", w)
        return k * (r * u.grad[0] * v.grad[0] + u.grad[1] * v.grad[1] / r + r * u.grad[2] * v.grad[2])

    @skfem.BilinearForm
    def mass(u, v, w):
        return of("volumetric_heat_capacity", w) * (OUTER - w.x[0]) * u * v

    @skfem.LinearForm
    def share(v, w):  # of the heat, by the area seen along the normal
        on = (w.x[1] < edge) & (w.x[2] < HALF_WIDTH)
        return OUTER * np.cos(w.x[1]) * on / (2 * HALF_WIDTH) ** 2 * v

    stiff, heat = stiffness.assemble(basis), mass.assemble(basis)
    surface = skfem.FacetBasis(
        mesh, basis.elem, facets=mesh.facets_satisfying(lambda x: x[0] < 1e-9), intorder=4
    )
    load = share.assemble(surface)
    assert load.sum() == pytest.approx(0.25, rel=1e-4)
    return np.array([4 * load @ skfem.solve(stiff + s * heat, load) for s in MOMENTS])


@pytest.mark.parametrize("name", ["glass", "aluminium"])
def test_a_tube_s_wall_is_that_of_the_finite_elements(name):
    material = thermal.material(name)
    mesh = trimesh.creation.annulus(INNER, OUTER, 2 * HALF_LENGTH, sections=360)
    body = solid(mesh.vertices, mesh.faces, material)
    net = body_network(body, [SurfacePatch((OUTER, 0, 0), (1, 0, 0))], cache=False)
    expected = tube_by_elements(material)
    assert net.impedance(MOMENTS)[:, 0, 0] == pytest.approx(expected, rel=0.005)


@pytest.mark.parametrize("core", ["glass", "stainless_steel"])
def test_a_tube_in_a_sleeve_is_that_of_the_finite_elements(core):
    sleeve, within = thermal.material("rubber"), thermal.material(core)
    meshes = (
        trimesh.creation.annulus(INNER, r, 2 * HALF_LENGTH, sections=360) for r in (OUTER, OUTER - SLEEVE)
    )
    parts = (
        SolidPart(mesh.vertices, mesh.faces, of) for mesh, of in zip(meshes, (sleeve, within), strict=True)
    )
    net = body_network(Solid(tuple(parts)), [SurfacePatch((OUTER, 0, 0), (1, 0, 0))], cache=False)
    expected = tube_by_elements(within, sleeve)
    found = net.impedance(MOMENTS)[:, 0, 0] / expected
    # at 8 1/s heat is within 0.1 mm of the surface, as deep as cells are there
    assert np.all(np.abs(found - 1) < [0.01, 0.01, 0.01, 0.02])
