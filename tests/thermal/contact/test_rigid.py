"""Curved bodies on a rigid face, against quadratures and an elastic solution of their own."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid, trapezoid
from scipy.special import ellipk

from thermograsp.errors import InvalidValueError
from thermograsp.thermal import AIR, LAPPED_ALUMINA, Surface, joint, material
from thermograsp.thermal.contact import RigidContact, rigid_cylinder, rigid_sphere
from thermograsp.thermal.contact.rough_faces import gas_conductance

WIDTH, RADIUS = 0.009, 0.02
STIFF = ["steel", "glass", "aluminium", "plastic"]


def ball(name: str, force: float, **changes) -> RigidContact:
    return rigid_sphere(LAPPED_ALUMINA, Surface.of(material(name)), force, RADIUS, WIDTH, **changes)


def rod(name: str, force: float, **changes) -> RigidContact:
    return rigid_cylinder(LAPPED_ALUMINA, Surface.of(material(name)), force, RADIUS, 0.05, WIDTH, **changes)


def modulus(name: str) -> float:
    faces = (LAPPED_ALUMINA, Surface.of(material(name)))
    return 1 / sum((1 - one.poisson_ratio**2) / one.youngs_modulus for one in faces)


def gap_of(name: str) -> float:
    """m of gas between faces that touch without force, the jump with it."""
    return AIR.conductivity / float(gas_conductance(joint(LAPPED_ALUMINA, Surface.of(material(name))), 0.0))


def elastic_ball(name: str, force: float) -> tuple[float, np.ndarray, np.ndarray]:
    """Contact radius m, distances m and gaps m of a ball on a half-space, by ring loads on 200 annuli: a unit pressure
    on one displaces 4/(pi E*) times the integral of K(4 r s/(r + s)^2) s/(r + s) (Johnson, section 3.8), and annuli
    that would pull are let go until none does."""
    edges = np.linspace(0.0, 3.2 * ball(name, force).half_width, 201)
    middle, width = (edges[1:] + edges[:-1]) / 2, edges[1]
    part = (np.arange(40) + 0.5) / 40  # none falls on a middle, where the kernel has a logarithm
    sources = edges[:-1, None] + part * width
    r, s = middle[:, None, None], sources[None]
    kernel = ellipk(4 * r * s / (r + s) ** 2) * s / (r + s)
    influence = 4 / (np.pi * modulus(name)) * kernel.mean(-1) * width
    areas, shape = np.pi * (edges[1:] ** 2 - edges[:-1] ** 2), middle**2 / (2 * RADIUS)
    touches = np.ones(len(middle), bool)
    while True:
        count = touches.sum()
        equations = np.zeros((count + 1, count + 1))
        equations[:count, :count], equations[:count, count] = influence[np.ix_(touches, touches)], -1.0
        equations[count, :count] = areas[touches]
        solved = np.linalg.solve(equations, np.append(-shape[touches], force))
        pressure = np.zeros(len(middle))
        pressure[touches] = solved[:count]
        if (pressure >= 0).all():
            return float(edges[count]), middle, influence @ pressure + shape - solved[count]
        touches &= pressure > 0


@pytest.mark.parametrize("name", STIFF)
def test_gas_without_force_is_that_under_a_parabola(name: str) -> None:
    d, square = gap_of(name), WIDTH**2 / np.pi
    expected = 2 * np.pi * AIR.conductivity * RADIUS * np.log1p(square / (2 * RADIUS * d))
    assert ball(name, 0.0).gas == pytest.approx(expected, rel=1e-9)
    expected = 2 * AIR.conductivity * WIDTH * np.sqrt(2 * RADIUS / d)
    expected *= np.arctan(WIDTH / 2 / np.sqrt(2 * RADIUS * d))
    assert rod(name, 0.0).gas == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("force", [1.0, 10.0, 30.0])
@pytest.mark.parametrize("name", STIFF)
def test_gas_beside_a_strip_is_that_of_a_quadrature(name: str, force: float) -> None:
    """The gap by integrating the slope of the surfaces, x/R less what Hertz's pressure bends, sqrt(x^2 - b^2)/R."""
    found = rod(name, force)
    x = found.half_width + (WIDTH / 2 - found.half_width) * np.linspace(0, 1, 200_001) ** 3
    slope = np.sqrt(np.maximum(x**2 - found.half_width**2, 0.0)) / RADIUS
    gap = cumulative_trapezoid(slope, x, initial=0.0)
    expected = 2 * WIDTH * AIR.conductivity * trapezoid(1 / (gap + gap_of(name)), x)
    assert found.gas == pytest.approx(expected, rel=1e-3)


def test_gas_over_a_square_face_is_that_over_a_disc_of_its_area() -> None:
    x, weight = np.polynomial.legendre.leggauss(400)
    grade = (x + 1) / 2
    along, weights = WIDTH / 2 * grade**3, weight / 2 * WIDTH / 2 * 3 * grade**2
    gap = (along[:, None] ** 2 + along**2) / (2 * RADIUS) + gap_of("steel")
    square = 4 * AIR.conductivity * weights @ (1 / gap) @ weights
    assert ball("steel", 0.0).gas == pytest.approx(square, rel=0.01)


@pytest.mark.parametrize(("name", "force"), [("steel", 10.0), ("glass", 1.0), ("plastic", 3.0)])
def test_contact_and_gap_are_those_of_an_elastic_solution(name: str, force: float) -> None:
    half, distance, gap = elastic_ball(name, force)
    found = ball(name, force)
    assert found.half_width == pytest.approx(half, rel=0.02)
    assert found.pressure == pytest.approx(force / (np.pi * half**2), rel=0.04)
    rings = 2 * np.pi * distance * (distance[1] - distance[0])
    beside = distance > half
    elastic = AIR.conductivity * (rings / (gap + gap_of(name)))[beside].sum()
    edge = (distance[-1] + (distance[1] - distance[0]) / 2) * np.sqrt(np.pi)
    near = rigid_sphere(LAPPED_ALUMINA, Surface.of(material(name)), force, RADIUS, edge).gas
    assert near == pytest.approx(elastic, rel=0.03)


def test_a_steel_ball_and_a_rod_feel_little() -> None:
    """10 N, 20 mm: a disc of 0.1 mm, and gas in a gap of micrometres."""
    assert ball("steel", 10.0).half_width == pytest.approx(1.0e-4, rel=0.03)
    assert 0.015 < ball("steel", 10.0).conductance < 0.03
    assert 0.06 < rod("steel", 10.0).conductance < 0.15


@pytest.mark.parametrize("name", STIFF)
def test_a_ball_less_than_a_rod_less_than_a_flat_face_and_more_force_more_heat(name: str) -> None:
    forces = (0.0, 0.1, 1.0, 10.0, 30.0)
    balls, rods = ([shape(name, force).conductance for force in forces] for shape in (ball, rod))
    assert (np.diff(balls) > 0).all() and (np.diff(rods) > 0).all()
    assert (np.array(balls) < rods).all()
    flat = float(gas_conductance(joint(LAPPED_ALUMINA, Surface.of(material(name))), 0.0)) * WIDTH**2
    assert rods[0] < flat


def test_a_disc_is_constricted_and_vacuum_has_no_gas() -> None:
    found = ball("steel", 10.0, gas=None)
    assert found.gas == 0
    conductivities = (LAPPED_ALUMINA.conductivity, material("steel").conductivity)
    bodies = sum(1 / (4 * found.half_width * k) for k in conductivities)
    assert 1 / found.solid == pytest.approx(1 / found.spots + bodies)
    assert rod("steel", 10.0, gas=None).conductance == rod("steel", 10.0, gas=None).spots


def test_refuses_what_is_none() -> None:
    with pytest.raises(InvalidValueError, match="force"):
        ball("steel", -1.0)
    with pytest.raises(InvalidValueError, match="Hertz"):
        ball("rubber", 30.0)
    with pytest.raises(InvalidValueError, match="length"):
        rigid_cylinder(LAPPED_ALUMINA, LAPPED_ALUMINA, 1.0, RADIUS, 0.0, WIDTH)
