"""Tables of curved contacts beside the laws that they are of: values, order, no jumps, and the same in arrays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.thermal import AIR, LAPPED_ALUMINA, SKINS, Pad, Surface, contact_conductance, joint, material
from thermograsp.thermal.contact import (
    array_curved_contact,
    beneath,
    conduction,
    curved_contact,
    curved_table,
    curved_touch,
    even_patch,
    face_joint,
    flat_footprint,
    patch_offset,
    rigid_cylinder,
    rigid_sphere,
    round_footprint,
    skinned,
)
from thermograsp.thermal.contact.patch_place import array_patch_offset

PAD, SKIN = Pad(), SKINS["filled_silicone"]
BODIES = {"ball": (0.02, None), "small ball": (0.005, None), "rod": (0.02, 0.06), "short rod": (0.02, 0.012)}
FORCES = (0.05, 0.5, 5.0, 50.0)
KINDS = [(skin, name) for skin in (None, SKIN) for name in ("steel", "wood")]


@pytest.mark.parametrize(("skin", "name"), KINDS)
@pytest.mark.parametrize("body", BODIES)
def test_it_is_the_law_in_the_middle_and_on_the_whole_off_it(skin, name: str, body: str) -> None:
    """Nearer where the places of the table are; worst within a tenth of a millimetre of the face's edge, and at the
    force at which a skin's spots come to full contact."""
    table, closed_form = (
        curved_table(PAD, skin, material(name), *BODIES[body]),
        round_footprint(PAD, skin, Surface.of(material(name)), *BODIES[body]),
    )
    rng, off = np.random.default_rng(0), []
    for _ in range(1000):
        force, place = (
            float(np.exp(rng.uniform(np.log(0.05), np.log(50)))),
            np.append(0, rng.uniform(0, 0.01, 2)),
        )
        middle = conduction(closed_form, force, np.zeros(3))[1]
        assert curved_contact(table, force, 0.0, 0.0)[0] == pytest.approx(
            middle, rel=0.02 if skin is None else 0.1
        )
        off.append(
            (curved_contact(table, force, place[1], place[2])[0] - conduction(closed_form, force, place)[1])
            / middle
        )
    assert np.sqrt(np.mean(np.square(off))) < 0.03
    assert np.quantile(np.abs(off), 0.9) < 0.05


def test_a_bare_ball_and_a_bare_rod_are_quadratures_over_hertzs_gap() -> None:
    steel = Surface.of(material("steel"))
    for force in (1.0, 10.0, 30.0):
        ball = curved_contact(curved_table(PAD, None, material("steel"), 0.02), force, 0.0, 0.0)[0]
        rod = curved_contact(curved_table(PAD, None, material("steel"), 0.02, 0.009), force, 0.0, 0.0)[0]
        assert ball == pytest.approx(
            rigid_sphere(LAPPED_ALUMINA, steel, force, 0.02, PAD.face).conductance, rel=0.05
        )
        other = rigid_cylinder(LAPPED_ALUMINA, steel, force, 0.02, 0.009, PAD.face).conductance
        assert rod == pytest.approx(other, rel=0.07)


def test_the_patch_is_the_even_one() -> None:
    body = material("steel")
    table, closed_form = (
        curved_table(PAD, None, body, 0.02),
        round_footprint(PAD, None, Surface.of(material("steel")), 0.02),
    )
    for force in FORCES:
        _, area, long = curved_contact(table, force, 0.0, 0.0)
        assert area == pytest.approx(even_patch(closed_form, body, force), rel=0.05)
        assert long**2 == pytest.approx(area, rel=0.05)
    _, area, long = curved_contact(curved_table(PAD, None, body, 0.02, 0.006), 5.0, 0.0, 0.0)
    assert long == pytest.approx(0.006)
    assert area < 0.006 * PAD.face


@pytest.mark.parametrize(("skin", "name"), KINDS)
def test_a_ball_less_than_a_rod_less_than_a_flat_face_and_more_force_more_heat(skin, name: str) -> None:
    """Under a skin through that and the bodies beneath, too."""
    pad, below = skinned(PAD, skin), beneath(material(name), skin)
    flat = flat_footprint(pad, face_joint(skin, Surface.of(material(name))), (0.04, 0.04))

    def felt(conducts: float, area: float) -> float:
        return conducts if skin is None else 1 / (1 / conducts + (below.straight + below.sheet) / area)

    before = (0.0, 0.0)
    for force in np.geomspace(0.01, 100.0, 60):
        ball, rod = (
            felt(
                *curved_contact(curved_table(PAD, skin, material(name), *BODIES[body]), force, 0.001, 0.0)[:2]
            )
            for body in ("ball", "rod")
        )
        area, conducts = conduction(flat, force, np.zeros(3))
        assert before[0] < ball < rod < felt(conducts, area)
        assert before[1] < rod
        before = ball, rod


@pytest.mark.parametrize(("skin", "name"), KINDS)
@pytest.mark.parametrize("body", BODIES)
def test_nothing_jumps_where_a_body_slides_over_the_face_and_off_it(skin, name: str, body: str) -> None:
    """Steps that are four times as fine make far smaller changes. Under a skin, in which heat spreads, what touches
    conducts well from its first hundredths of a millimetre on."""
    table = curved_table(PAD, skin, material(name), *BODIES[body])
    for force in FORCES:
        middle = curved_contact(table, force, 0.0, 0.0)[0]
        for way in ((1.0, 0.0), (0.0, 1.0), (0.7, 0.7)):
            changes = []
            for steps in (2000, 8000) if skin is None else (8000, 32000):
                slide = [
                    curved_contact(table, force, way[0] * at, way[1] * at)[0]
                    for at in np.linspace(-0.012, 0.012, steps)
                ]
                changes.append(np.abs(np.diff(slide)).max() / middle)
            assert changes[1] < 0.02
            assert changes[1] <= 0.6 * changes[0]


def test_arrays_hold_what_the_compiled_function_finds() -> None:
    every = [
        curved_table(PAD, skin, material(name), *body) for skin, name in KINDS for body in BODIES.values()
    ]
    rng = np.random.default_rng(1)
    number = rng.integers(0, len(every), 2000)
    force = np.exp(rng.uniform(np.log(1e-4), np.log(1e4), 2000)) * rng.choice([0.0, 1.0], 2000, p=[0.1, 0.9])
    aside, along = rng.uniform(-0.015, 0.015, (2, 2000))
    found = array_curved_contact(np.concatenate(every), number, force, aside, along)
    pressed = force > 0
    expected = np.array(
        [
            curved_contact(every[n], f, a, b)
            for n, f, a, b in zip(
                number[pressed], force[pressed], aside[pressed], along[pressed], strict=True
            )
        ]
    )
    for table_value, other in zip(found, expected.T, strict=True):
        np.testing.assert_allclose(table_value[pressed], other, rtol=1e-12, atol=0)
        assert not table_value[~pressed].any()


@pytest.mark.parametrize("size", [(0.0, None), (-1.0, None), (np.nan, None), (0.02, 0.0), (0.02, np.nan)])
def test_sizes_that_are_none_are_refused(size) -> None:
    with pytest.raises(InvalidValueError, match="radius|length"):
        curved_table(PAD, None, material("steel"), *size)


def off_the_middle(name: str, radius: float, force: float, place: tuple[float, float]) -> float:
    """W/K of a bare ball whose crown is there on the face, m: Hertz's spot, and a sum over its gap by angle and by
    distance. It shares the conductance of rough faces with the laws, and nothing of their geometry."""
    body, half, gas = Surface.of(material(name)), PAD.face / 2, AIR.conductivity
    pair = joint(LAPPED_ALUMINA, body, full_contact=True)
    stiff = 1 / sum((1 - one.poisson_ratio**2) / one.youngs_modulus for one in (LAPPED_ALUMINA, body))
    spot = (3 * force * radius / (4 * stiff)) ** (1 / 3)
    spots = float(contact_conductance(pair, force / (np.pi * spot**2))) * np.pi * spot**2
    both = 1 / LAPPED_ALUMINA.conductivity + 1 / body.conductivity
    smallest_gap = gas / (
        float(contact_conductance(pair, 1e-9))
        - float(contact_conductance(replace(pair, gas_conductivity=0.0), 1e-9))
    )
    # what would pass the gas there without force is no more concentrated than around it
    untouched = gas / smallest_gap * np.pi * spot**2
    solid = untouched + 1 / (1 / (spots - untouched) + both / 4 * (1 / spot - np.sqrt(np.pi) / PAD.face))
    angle = (np.arange(1000) + 0.5) / 1000 * 2 * np.pi
    ends = [
        np.where(turned > 0, half - at, half + at) / np.maximum(np.abs(turned), 1e-12)
        for turned, at in zip((np.cos(angle), np.sin(angle)), place, strict=True)
    ]
    end, scale = np.minimum(np.minimum(*ends), radius), np.sqrt(2 * radius * smallest_gap)
    low, high = np.arcsinh(spot / scale), np.arcsinh(end / scale)
    at = low + (high - low)[:, None] * (np.arange(500) + 0.5) / 500
    x = np.maximum(scale * np.sinh(at) / spot, 1.0)
    gap = spot**2 / (np.pi * radius) * (np.sqrt(x * x - 1) + (x * x - 2) * np.arccos(1 / x))
    around = (gas / (smallest_gap + gap) * scale**2 * np.sinh(at) * np.cosh(at)).mean(axis=1) * (high - low)
    return solid + float(around.mean()) * 2 * np.pi


@pytest.mark.parametrize("name", ["steel", "copper", "glass"])
@pytest.mark.parametrize("radius", [0.005, 0.02, 0.05])
def test_a_bare_ball_off_the_middle_is_a_sum_over_hertzs_gap(name: str, radius: float) -> None:
    table, closed_form = (
        curved_table(PAD, None, material(name), radius),
        round_footprint(PAD, None, Surface.of(material(name)), radius),
    )
    for force in (1.0, 10.0):
        for place in (
            (0.0, 0.0),
            (0.0015, 0.0),
            (0.003, 0.0),
            (0.003, 0.003),
            (0.004, 0.002),
            (0.0042, 0.0042),
        ):
            expected = off_the_middle(name, radius, force, place)
            assert conduction(closed_form, force, np.array([0.0, *place]))[1] == pytest.approx(
                expected, rel=0.03
            )
            assert curved_contact(table, force, *place)[0] == pytest.approx(expected, rel=0.03)


@pytest.mark.parametrize(
    ("radius", "length", "name"),
    [
        (0.02, None, "aluminium"),
        (0.01392, None, "steel"),
        (0.04030, None, "steel"),
        (0.07273, None, "copper"),
    ],
)
def test_a_patch_that_is_nearly_as_wide_as_the_face_is_a_number(radius: float, length, name: str) -> None:
    """A part in 1e9 more, and it counts as the whole face."""
    assert np.isfinite(curved_table(PAD, None, material(name), radius, length)).all()


@pytest.mark.parametrize("skin", [None, "filled_silicone"])
def test_a_narrow_pad_lies_in_the_middle_of_the_sensors_face(skin: str | None) -> None:
    """A rod's line of 6 mm is as long as a sensor of 6 mm, and lies in the middle of one of 9."""
    worn = None if skin is None else SKINS[skin]
    for sensor, expected in ((None, 1.0), (0.009, 0.0)):
        pad, shares = Pad(width=0.006, face=0.006, sensor=sensor), np.empty(4)
        curved_touch(curved_table(pad, worn, material("steel"), 0.01, 0.04), 5.0, 0.0, 0.0, shares)
        np.testing.assert_allclose(shares, [0.0, expected, 0.0, expected], atol=1e-12)


@pytest.mark.parametrize("less", [1e-16, 1e-12, 1e-9, 1.1e-9, 4e-9, 1e-8, 1e-6])
def test_shares_at_the_end_of_the_face_come_to_one(less: float) -> None:
    width = 0.009
    for offset in (0.0, 0.3 * width):
        share = patch_offset(offset, (1 - less) * width, width)
        same = array_patch_offset(np.array(offset), np.array((1 - less) * width), np.array(width))
        assert share == same and 0.0 <= share <= 1.0
        single = array_patch_offset(
            *(np.array(value, np.float32) for value in (offset, (1 - less) * width, width))
        )
        assert 0.0 <= single <= 1.0
