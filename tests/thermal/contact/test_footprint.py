"""What a pad that is anywhere on a body touches: closed forms against sums over a grid, balance, order, no jumps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.thermal import LAPPED_ALUMINA, Pad, Surface, joint, material
from thermograsp.thermal.contact import (
    TABLE_FORCES,
    ContactArea,
    conductance,
    cylinder_contact,
    cylinder_footprint,
    flat_contact,
    flat_footprint,
    footprint,
    sphere_contact,
    sphere_footprint,
    table_footprint,
)

PAD = Pad()
SKINNED = replace(PAD, face_stiffness=12 * PAD.foundation_modulus / PAD.thickness)
STEEL = joint(LAPPED_ALUMINA, Surface.of(material("steel")))
PLACES = [(0.0, 0.0), (0.003, 0.0), (0.0, -0.006), (0.0055, 0.0041), (-0.0098, 0.002), (0.013, 0.0)]


def on_a_grid(pad: Pad, force: float, gap: np.ndarray, n: int, cover: np.ndarray | float = 1.0):
    """(area on the pad, area on the face, force on the face) of springs in n x n points, depth by bisection."""
    x = ((np.arange(n) + 0.5) / n - 0.5) * pad.width
    on_face = np.maximum(abs(x[:, None]), abs(x)) < pad.face / 2
    springs = pad.foundation_modulus / pad.thickness * np.where(on_face, pad.face_ratio, 1.0) * cover
    springs = springs * (pad.width / n) ** 2
    low, high = float(gap.min()), float(gap.max()) + 1.0
    for _ in range(50):
        middle = (low + high) / 2
        pushed = (springs * np.maximum(middle - gap, 0)).sum()
        low, high = (middle, high) if pushed < force else (low, middle)
    pushed, touched = springs * np.maximum(low - gap, 0), ((low > gap) & (springs > 0)) * (pad.width / n) ** 2
    return touched.sum(), (touched * on_face).sum(), (pushed * on_face).sum()


@pytest.mark.parametrize("pad", [PAD, SKINNED], ids=["pad", "skinned"])
@pytest.mark.parametrize(
    ("force", "place"), list(zip([10.0, 0.3, 2.0, 200.0, 10.0, 30.0], PLACES, strict=True))
)
def test_closed_forms_are_sums_over_a_grid(pad: Pad, force: float, place: tuple[float, float]) -> None:
    n, radius, length = 400, 0.02, 0.012
    x = ((np.arange(n) + 0.5) / n - 0.5) * pad.width
    first, second = x[:, None] - place[0], x - place[1]
    ball = on_a_grid(pad, force, (first**2 + second**2) / (2 * radius), n)
    found = sphere_contact(pad, force, radius, place)
    assert (found.pad, found.face) == pytest.approx(ball[:2], rel=0.02, abs=2e-7)
    assert found.face_force == pytest.approx(ball[2], rel=4e-3, abs=2e-3 * force)
    inside = np.clip((length / 2 - abs(second)) / (pad.width / n) + 0.5, 0, 1)
    line = on_a_grid(pad, force, np.broadcast_to(first**2 / (2 * radius), (n, n)), n, inside)
    found = cylinder_contact(pad, force, radius, length, (place[1], place[0]))
    row = length * pad.width / n  # the grid's own error: a row of points
    assert (found.pad, found.face) == pytest.approx(line[:2], rel=0.02, abs=row)
    assert found.face_force == pytest.approx(line[2], rel=4e-3, abs=2e-3 * force)


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("ratio", [1.0, 30.0])
def test_the_pressures_add_up_to_the_force(place: tuple[float, float], ratio: float) -> None:
    """With a face as large as the pad its force is all; with one a little smaller, the rest is what lies around it."""
    whole = Pad(face=PAD.width, face_stiffness=ratio * PAD.foundation_modulus / PAD.thickness)
    force = np.geomspace(1e-3, 1e3, 40)
    for found in (
        sphere_contact(whole, force, 0.015, place),
        cylinder_contact(whole, force, 0.015, 0.01, place),
        flat_contact(whole, force, (0.02, 0.01), place),
    ):
        np.testing.assert_allclose(found.face_force, force, rtol=1e-9)


def test_an_even_skin_is_a_stiffer_pad() -> None:
    whole = replace(PAD, face=PAD.width, face_stiffness=7 * PAD.foundation_modulus / PAD.thickness)
    stiff = Pad(face=PAD.width, youngs_modulus=7 * PAD.youngs_modulus)
    for place in PLACES:
        skinned, other = (sphere_contact(pad, 5.0, 0.02, place) for pad in (whole, stiff))
        assert skinned.face == pytest.approx(other.face, rel=1e-9)


SHAPES = {
    "flat": lambda pad: flat_footprint(pad, STEEL, (0.04, 0.015), (1, 2)),
    "cylinder": lambda pad: cylinder_footprint(pad, STEEL, 0.02, 0.015),
    "ball": lambda pad: sphere_footprint(pad, STEEL, 0.02),
}


def reference(name: str, pad: Pad, force: float, y: float, z: float) -> ContactArea:
    if name == "flat":
        return flat_contact(pad, force, (0.04, 0.015), (y, z))
    if name == "cylinder":
        return cylinder_contact(pad, force, 0.02, 0.015, (z, y))
    return sphere_contact(pad, force, 0.02, (y, z))


@pytest.mark.parametrize("pad", [PAD, SKINNED], ids=["pad", "skinned"])
@pytest.mark.parametrize("name", SHAPES)
def test_the_compiled_law_is_the_area_law_at_any_place(name: str, pad: Pad) -> None:
    law = SHAPES[name](pad)
    for y, z in PLACES:
        for force in (0.1, 10.0, 50.0):
            expected = reference(name, pad, force, y, z)
            area, load = footprint(law, force, np.array([0.0, y, z]))
            assert area == pytest.approx(float(expected.face), rel=1e-12, abs=1e-18)
            assert load == pytest.approx(float(expected.face_force), rel=1e-12, abs=1e-15)


@pytest.mark.parametrize("pad", [PAD, SKINNED], ids=["pad", "skinned"])
@pytest.mark.parametrize("name", SHAPES)
def test_nothing_jumps_where_a_body_slides_over_an_edge(name: str, pad: Pad) -> None:
    """Halving the steps halves the largest change of conductance times area: it is continuous, and steep nowhere."""
    law = SHAPES[name](pad)
    for way in ((0.0, 1.0), (1.0, 0.0), (0.6, 0.8)):
        largest = []
        for steps in (200, 400, 800):
            conductances = []
            for at in np.linspace(0.0, 0.016, steps + 1):
                area, load = footprint(law, 10.0, np.array([0.0, *(at * np.array(way))]))
                conductances.append(area * conductance(law, load / area) if area > 0 else 0.0)
            largest.append(abs(np.diff(conductances)).max())
        # where the last of a curved face slips off, its pressure falls as its area does: by more than in proportion
        assert largest[1] <= 0.6 * largest[0] + 1e-12 and largest[2] <= 0.6 * largest[1] + 1e-12


def conductance_of(law: np.void, force: float) -> float:
    area, load = footprint(law, force, np.zeros(3))
    return area * conductance(law, load / area)


def test_on_a_stiff_face_balls_feel_less_than_cylinders_and_these_less_than_flats() -> None:
    """The springs on the face take the force of each, over the less area the rounder it is."""
    forces = np.geomspace(0.05, 40.0, 12)
    flat, line, ball = (
        np.array([conductance_of(law, force) for force in forces])
        for law in (
            flat_footprint(SKINNED, STEEL, (0.04, 0.04)),
            cylinder_footprint(SKINNED, STEEL, 0.02, 0.04),
            sphere_footprint(SKINNED, STEEL, 0.02),
        )
    )
    assert (ball < line).all() and (line < flat).all()


@pytest.mark.parametrize("pad", [PAD, SKINNED], ids=["pad", "skinned"])
@pytest.mark.parametrize("name", SHAPES)
def test_more_force_more_heat(name: str, pad: Pad) -> None:
    heat = [conductance_of(SHAPES[name](pad), force) for force in np.geomspace(0.05, 40.0, 12)]
    assert (np.diff(heat) > 0).all()


def test_a_table_is_exact_for_powers_and_at_its_forces() -> None:
    contact = sphere_contact(PAD, TABLE_FORCES, 0.02)
    law = table_footprint(PAD, STEEL, contact)
    for force, area, load in zip(TABLE_FORCES, contact.face, contact.face_force, strict=True):
        assert footprint(law, force, np.zeros(3)) == pytest.approx((area, load), rel=1e-9)
    for force in (1e-4, 0.02, 1.3, 9.0):
        expected = sphere_contact(PAD, force, 0.02)
        found = footprint(law, force, np.zeros(3))
        assert found == pytest.approx((float(expected.face), float(expected.face_force)), rel=1e-9)
    with pytest.raises(InvalidValueError, match="9 forces"):
        table_footprint(PAD, STEEL, sphere_contact(PAD, np.ones(3), 0.02))
