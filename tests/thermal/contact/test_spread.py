"""The even patch that stands for a curved body on a sensor's face: limits, order, and drops beside finite volumes."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from thermograsp.thermal import AIR, LAPPED_ALUMINA, Pad, Surface, material
from thermograsp.thermal.contact import (
    Wedge,
    array_beside_round,
    array_laws,
    bare_footprint,
    beneath,
    beside_round,
    conductance,
    conduction,
    even_patch,
    face_joint,
    flat_law,
    footprint,
    round_footprint,
    skinned,
)
from thermograsp.thermal.matter import skin

PAD, FACE = Pad(), Pad().face ** 2


def patches(name: str, radius: float = 0.02, force: float = 10.0, length: float | None = None) -> float:
    body = material(name)
    return even_patch(bare_footprint(PAD, Surface.of(body), radius, length), body, force)


@pytest.mark.parametrize("name", ["copper", "steel", "glass", "plastic", "wood", "rubber"])
@pytest.mark.parametrize("radius", [0.003, 0.02, 0.3])
@pytest.mark.parametrize("length", [None, 0.05])
def test_it_is_as_wide_as_what_touches_and_no_wider_than_the_face(
    name: str, radius: float, length: float | None
) -> None:
    body = material(name)
    law = bare_footprint(PAD, Surface.of(body), radius, length)
    for force in (0.1, 10.0, 40.0):
        assert conduction(law, force, np.zeros(3))[0] <= even_patch(law, body, force) <= FACE * (1 + 1e-9)


def test_better_conductors_and_smaller_balls_are_met_on_less() -> None:
    areas = [patches(name) for name in ("copper", "steel", "glass", "plastic")]
    assert (np.diff(areas) > 0).all()
    areas = [patches("steel", radius) for radius in (0.003, 0.01, 0.05, 0.3)]
    assert (np.diff(areas) > 0).all()
    assert patches("steel") < patches("steel", length=0.05)


def test_gas_that_conducts_the_same_all_over_the_face_is_a_patch_as_large_as_the_face() -> None:
    """A ball of 100 m is flat over 9 mm, and far from touching it."""
    body = replace(material("steel"), roughness=1e-3)
    law = bare_footprint(PAD, Surface.of(body), 100.0)
    assert even_patch(law, body, 1e-6) == pytest.approx(FACE, rel=0.01)


def test_without_gas_it_is_what_touches() -> None:
    body = material("steel")
    law = bare_footprint(PAD, Surface.of(body), 0.02, gas=None)
    assert even_patch(law, body, 10.0) == conduction(law, 10.0, np.zeros(3))[0]


def test_it_loses_to_the_bodies_what_the_gas_loses_place_by_place() -> None:
    """By a quadrature over the wedge of a ball that hardly touches: what of both bodies is in series."""
    body, radius, reach = material("glass"), 0.02, np.sqrt(FACE / np.pi)
    law = bare_footprint(PAD, Surface.of(body), radius)
    area = even_patch(law, body, 1e-6)
    total = conduction(law, 1e-6, np.zeros(3))[1]
    depth = np.sqrt(body.diffusivity)
    assert depth < 0.8e-3
    behind = depth * (1 / LAPPED_ALUMINA.conductivity + 1 / body.conductivity)
    at = (np.arange(200_000) + 0.5) / 200_000 * reach
    alone = (float(law["mean_gap"]) + at**2 / (2 * radius)) / AIR.conductivity
    placed = (2 * np.pi * at / (alone + behind)).mean() * reach
    assert area < FACE
    assert area / (area / total + behind) == pytest.approx(placed, rel=0.01)


@pytest.mark.parametrize("name", ["abs", "wood", "cork"])
def test_a_cylinder_that_is_pressed_harder_takes_up_no_less(name: str) -> None:
    """Its patch was the mean of the contact's and the gas's areas, and a can of ABS had half the drop at 60 N."""
    body, resists = material(name), []
    law = bare_footprint(PAD, Surface.of(body), 0.02, 0.08)
    for force in (0.05, 0.5, 5.0, 20.0, 60.0):
        conducts, area = conduction(law, force, np.zeros(3))[1], even_patch(law, body, force)
        resists.append(1 / conducts + beneath(body).straight / area)
    assert all(later < 1.02 * before for before, later in pairwise(resists)), resists


@pytest.mark.parametrize("name", ["aluminium", "glass", "wood"])
@pytest.mark.parametrize("length", [None, 0.08])
def test_under_a_skin_it_is_wider_than_what_touches_and_more_force_is_no_less_heat(
    name: str, length: float | None
) -> None:
    """A ball of glass was felt half as cold: heat had to go through the skin under the contact alone."""
    body, worn, resists = material(name), skin("filled_silicone"), []
    law = round_footprint(PAD, worn, Surface.of(body), 0.02, length)
    below = beneath(body, worn)
    for force in (0.05, 0.5, 5.0, 20.0, 60.0):
        touched, conducts = conduction(law, force, np.zeros(3))
        area = even_patch(law, body, force, worn)
        assert touched < area <= FACE * (1 + 1e-9)
        resists.append(1 / conducts + (below.straight + below.sheet) / area)
    assert all(later < 1.02 * before for before, later in pairwise(resists)), resists
    assert (
        even_patch(law, body, 5.0, worn)
        > (1.1 if name == "aluminium" else 1.5) * conduction(law, 5.0, np.zeros(3))[0]
    )


@pytest.mark.parametrize("name", ["aluminium", "glass", "wood"])
@pytest.mark.parametrize("length", [None, 0.08])
@pytest.mark.parametrize("force", [0.3, 3.0, 30.0])
def test_two_round_bodies_have_the_patch_of_the_one_that_they_are_beside_a_plane(
    name: str, length: float | None, force: float
) -> None:
    """A ball of 40 mm on one of 40 mm is one of 20 mm on a plane, and so are rods that lie along one another."""
    body, worn, half = material(name), skin("filled_silicone"), PAD.face / 2
    law, below = round_footprint(PAD, worn, Surface.of(body), 0.02, length), beneath(body, worn)
    pair = flat_law(skinned(PAD, worn), face_joint(worn, Surface.of(body)), (1.0, 1.0))
    for key, value in {"mean_gap": law["mean_gap"], **below._asdict()}.items():
        pair[key] = value
    area, load = footprint(law, force, np.zeros(3))
    square = area / np.pi if length is None else (area / (2 * PAD.face)) ** 2
    bend = 50.0 if length is None else 1e-6
    wedge = Wedge(square * 25.0, 0.0, bend, 50.0, -half, half, -half, half)
    side = np.sqrt(area) if length is None else PAD.face
    alone = conductance(law, load / area) * area
    conducts, patch, long = beside_round(pair, wedge, alone, area, side)
    assert conducts == pytest.approx(conduction(law, force, np.zeros(3))[1], rel=5e-3)
    assert patch == pytest.approx(even_patch(law, body, force, worn), rel=0.01)
    assert long == pytest.approx(np.sqrt(patch) if length is None else PAD.face, rel=1e-6)
    rows = array_laws(np.array([pair]), np.zeros(0))
    many = Wedge(*(np.array([each]) for each in wedge))
    found = array_beside_round(rows, many, *(np.array([each]) for each in (alone, area, side)))
    np.testing.assert_allclose(np.ravel(found), (conducts, patch, long), rtol=1e-9)
    apart = Wedge(1e-9, *wedge[1:])
    total, wide, _ = beside_round(pair, apart, 0.0, 0.0, 0.0)
    assert 0 < total < conducts and area < wide <= FACE
    (one,), (other,), _ = array_beside_round(
        rows, Wedge(*(np.array([each]) for each in apart)), *(np.zeros(1),) * 3
    )
    assert (one, other) == pytest.approx((total, wide))
    pair["mean_gap"] = 0.0
    assert beside_round(pair, wedge, alone, area, side) == (alone, area, side)
