"""Balls and cylinders on a bare face, on a skin and on the pad, gas beside them: quadratures, order, no jumps."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import dblquad, quad

from thermograsp.errors import InvalidValueError
from thermograsp.thermal import (
    AIR,
    LAPPED_ALUMINA,
    Pad,
    Surface,
    contact_conductance,
    joint,
    material,
)
from thermograsp.thermal.contact import (
    bare_footprint,
    bared,
    conduction,
    cylinder_footprint,
    flat_footprint,
    footprint,
    rigid_cylinder,
    rigid_sphere,
    sphere_contact,
    sphere_footprint,
)
from thermograsp.thermal.contact.gas_beside import beside_ball, beside_strip

PAD, HALF, LONG = Pad(), 0.0045, 0.05
MIDDLE = np.zeros(3)
SILICONE = Surface.of(replace(material("silicone"), roughness=2e-6))
SKINNED = replace(PAD, face_stiffness=1.5e11)  # 0.2 mm of it, hardly compressible
STEEL = Surface.of(material("steel"))


def laws(name: str, radius: float = 0.02, length: float = LONG) -> dict[str, tuple[np.void, np.void]]:
    """(a ball's, a cylinder's) on the pad, on a bare face and on a skin."""
    body = Surface.of(material(name))
    pair, worn_pair = joint(LAPPED_ALUMINA, body), joint(SILICONE, body, full_contact=True)
    return {
        "pad": (sphere_footprint(PAD, pair, radius), cylinder_footprint(PAD, pair, radius, length)),
        "bare": (bare_footprint(PAD, body, radius), bare_footprint(PAD, body, radius, length)),
        "skin": (
            sphere_footprint(SKINNED, worn_pair, radius),
            cylinder_footprint(SKINNED, worn_pair, radius, length),
        ),
    }


@pytest.mark.parametrize("place", [(0.0, 0.0), (0.003, 0.0), (0.0044, 0.0012), (0.005, 0.005), (0.0, 0.009)])
@pytest.mark.parametrize("half_width", [0.0, 1e-4, 2e-3])
def test_gas_beside_a_ball_is_an_integral_over_the_face(
    half_width: float, place: tuple[float, float]
) -> None:
    radius, mean_gap = 0.02, 2e-6
    s, (y, z) = half_width**2, place

    def along(v: float) -> float:
        """The integral over w: what of it is beside the disc, in closed form."""
        n = np.sqrt(2 * radius * mean_gap - s + v * v + 0j)
        near = np.sqrt(max(s - v * v, 0.0))
        pieces = [(max(z - HALF, near), z + HALF), (z - HALF, min(z + HALF, -near))]
        if near == 0:
            pieces = [(z - HALF, z + HALF)]
        return sum(float(((np.arctan(b / n) - np.arctan(a / n)) / n).real) for a, b in pieces if b > a)

    breaks = sorted({y - HALF, y + HALF, *(p for p in (-half_width, 0.0, half_width) if abs(p - y) < HALF)})
    expected = sum(quad(along, a, b, limit=400)[0] for a, b in pairwise(breaks))
    assert beside_ball(s, 0.0, mean_gap, radius, HALF, y, z) == pytest.approx(2 * radius * expected, rel=0.04)


@pytest.mark.parametrize("x", [0.0, 0.003, 0.0046, 0.009])
@pytest.mark.parametrize("half_width", [0.0, 1e-4, 2.83e-4, 2e-3])
def test_gas_beside_a_strip_is_an_integral_over_the_face(half_width: float, x: float) -> None:
    radius, mean_gap = 0.02, 2e-6
    expected = 0.0
    for low, high in ((half_width, x + HALF), (x - HALF, -half_width)):
        start, end = max(low, x - HALF), min(high, x + HALF)
        if end > start:
            gap = lambda at: 1 / (mean_gap + (at * at - half_width**2) / (2 * radius))  # noqa: E731
            near = [p for p in (half_width + 1e-4, -half_width - 1e-4, 0.0) if start < p < end]
            expected += quad(gap, start, end, points=near or None, limit=400)[0]
    assert beside_strip(half_width**2, mean_gap, radius, HALF, x) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("force", [0.1, 1.0, 10.0, 30.0])
@pytest.mark.parametrize("radius", [0.005, 0.02, 0.05])
@pytest.mark.parametrize("name", ["steel", "glass", "aluminium", "plastic"])
def test_on_a_bare_face_contacts_are_hertzs(name: str, radius: float, force: float) -> None:
    """The law of any place against the one of the face's middle, whose gap is Hertz's own."""
    body = Surface.of(material(name))
    ball, rod = laws(name, radius)["bare"]
    expected = rigid_sphere(LAPPED_ALUMINA, body, force, radius, 2 * HALF)
    area, conducts = conduction(ball, force, MIDDLE)
    assert area == pytest.approx(np.pi * expected.half_width**2, rel=1e-6)
    assert conducts == pytest.approx(expected.conductance, rel=0.03)
    expected = rigid_cylinder(LAPPED_ALUMINA, body, force, radius, LONG, 2 * HALF)
    area, conducts = conduction(rod, force, MIDDLE)
    assert area == pytest.approx(4 * HALF * expected.half_width, rel=1e-3)
    assert conducts == pytest.approx(expected.conductance, rel=0.05)


def test_a_steel_ball_at_10_newtons_against_a_quadrature_of_its_own() -> None:
    """Spots, constriction and gas of a ball of 20 mm, from the textbooks' formulae written out here."""
    radius, force = 0.02, 10.0
    modulus = 1 / sum((1 - one.poisson_ratio**2) / one.youngs_modulus for one in (LAPPED_ALUMINA, STEEL))
    a = (0.75 * force * radius / modulus) ** (1 / 3)
    k = 2 / (1 / LAPPED_ALUMINA.conductivity + 1 / STEEL.conductivity)
    slope, sigma = (
        np.hypot(LAPPED_ALUMINA.slope, STEEL.slope),
        np.hypot(LAPPED_ALUMINA.roughness, STEEL.roughness),
    )
    hardness = min(LAPPED_ALUMINA.microhardness, STEEL.microhardness)
    # plastic spots under Hertz's pressure at each r
    spots = quad(
        lambda r: 2 * np.pi * r * 1.25 * k * slope / sigma
        * (1.5 * force / (np.pi * a * a) * np.sqrt(1 - (r / a) ** 2) / hardness) ** 0.95, 0, a,
    )[0]  # fmt: skip
    solid = 1 / (1 / spots + (1 / LAPPED_ALUMINA.conductivity + 1 / STEEL.conductivity) / (4 * a))
    mean_gap = 4.75 * sigma + AIR.jump

    def gap(r: float) -> float:
        x = max(r / a, 1.0)
        return a * a / (np.pi * radius) * (np.sqrt(x * x - 1) + (x * x - 2) * np.arccos(1 / x))

    flow = lambda y, x: AIR.conductivity / (mean_gap + gap(float(np.hypot(x, y)))) * (np.hypot(x, y) > a)  # noqa: E731
    gas = 4 * sum(
        dblquad(flow, *x, *y, epsrel=1e-3, epsabs=1e-7)[0]
        for x in ((0.0, 5e-4), (5e-4, HALF)) for y in ((0.0, 5e-4), (5e-4, HALF))
    )  # fmt: skip
    assert a == pytest.approx(1e-4, rel=0.03)
    conducts = conduction(laws("steel")["bare"][0], force, MIDDLE)[1]
    assert conducts == pytest.approx(solid + gas, rel=0.1)


@pytest.mark.parametrize("name", ["steel", "plastic", "aluminium", "wood"])
@pytest.mark.parametrize("kind", ["bare", "skin"])
def test_a_ball_less_than_a_rod_less_than_a_flat_face_and_more_force_more_heat(kind: str, name: str) -> None:
    body = Surface.of(material(name))
    pad = bared(PAD) if kind == "bare" else SKINNED
    face = LAPPED_ALUMINA if kind == "bare" else SILICONE
    flat = flat_footprint(pad, joint(face, body, full_contact=True), (0.05, 0.05))
    every = np.array(
        [[conduction(law, force, MIDDLE)[1] for force in np.geomspace(0.05, 40, 12)]
         for law in (*laws(name)[kind], flat)]
    )  # fmt: skip
    assert (np.diff(every, axis=0) > 0).all()
    assert (np.diff(every, axis=1) > 0).all()


@pytest.mark.parametrize("kind", ["pad", "skin"])
def test_a_thread_feels_less_than_its_rod(kind: str) -> None:
    """Crests as wide as a third of the length take the force that the rod's whole length takes."""
    whole, crests = laws("steel")[kind][1], laws("steel", length=0.003)[kind][1]
    for force in (0.5, 5.0, 30.0):
        assert conduction(crests, force, MIDDLE)[1] < conduction(whole, force, MIDDLE)[1]


@pytest.mark.parametrize("shape", ["ball", "rod"])
@pytest.mark.parametrize("kind", ["pad", "bare", "skin"])
def test_nothing_jumps_where_a_body_slides_over_the_face_and_off_it(kind: str, shape: str) -> None:
    """Halving the steps halves the largest change: gas goes on where the contact has left the face."""
    law = laws("steel", length=0.012)[kind][shape == "rod"]
    for way in ((0.0, 1.0), (1.0, 0.0), (0.6, 0.8)):
        largest = []
        for steps in (400, 800, 1600):
            places = np.linspace(0.0, 0.0095, steps + 1)
            answers = [conduction(law, 10.0, np.array([0.0, *(at * np.array(way))])) for at in places]
            assert np.isfinite(answers).all() and np.min(answers) >= 0
            conductances = [watts for _, watts in answers]
            largest.append(abs(np.diff(conductances)).max())
        assert largest[1] <= 0.65 * largest[0] + 1e-12 and largest[2] <= 0.65 * largest[1] + 1e-12


@pytest.mark.parametrize("pad", [bared(PAD), SKINNED], ids=["bare", "skin"])
@pytest.mark.parametrize(
    "place", [(0.0, 0.0), (0.003, 0.0), (0.0045, 0.001), (0.0055, 0.0041), (0.0098, 0.0)]
)
def test_the_pressures_add_up_to_the_force(pad: Pad, place: tuple[float, float]) -> None:
    """On a face as large as the pad the force is all; where the face is smaller, the springs' own sum is."""
    whole = Pad(face=pad.width, face_stiffness=pad.face_stiffness)
    for force in np.geomspace(0.01, 100, 9):
        assert sphere_contact(whole, force, 0.02, place).face_force == pytest.approx(force, rel=1e-6)
        conductances = sphere_contact(pad, force, 0.02, place)
        assert 0 <= conductances.face_force <= force * (1 + 1e-9)


def test_places_under_a_curved_body_conduct_as_their_mean_pressure_does() -> None:
    """Springs under a ball press by a parabola; spots and gas place by place are within 2.5 % of those of the mean."""
    for name in ("steel", "wood", "plastic", "rubber"):
        pair = joint(LAPPED_ALUMINA, Surface.of(material(name)))
        law = sphere_footprint(PAD, pair, 0.02)
        for force in (1.0, 10.0):
            area, load = footprint(law, force, MIDDLE)
            mean = load / area
            share = (np.arange(2000) + 0.5) / 2000  # of the area, inside a radius
            placed = float(contact_conductance(pair, 2 * mean * (1 - share)).mean())
            assert float(contact_conductance(pair, mean)) == pytest.approx(placed, rel=0.025)


def test_gas_of_a_vacuum_is_none_and_nonsense_is_refused() -> None:
    bare = bare_footprint(PAD, STEEL, 0.02, gas=None)
    assert conduction(bare, 10.0, MIDDLE)[1] < 0.5 * conduction(laws("steel")["bare"][0], 10.0, MIDDLE)[1]
    assert conduction(bare, 10.0, np.array([0.0, 0.0095, 0.0]))[1] == 0.0
    for radius, length in ((0.0, None), (float("nan"), None), (-1.0, 0.1), (0.02, 0.0), (0.02, float("nan"))):
        with pytest.raises(InvalidValueError, match="radius|length"):
            bare_footprint(PAD, STEEL, radius, length)
