"""The compiled contact law is the contact law."""

from __future__ import annotations

import numpy as np
import pytest

from thermograsp.thermal import (
    LAPPED_ALUMINA,
    SKINS,
    Joint,
    Pad,
    Surface,
    contact_conductance,
    cylinder_law,
    flat_contact,
    flat_law,
    joint,
    material,
    materials,
    sphere_law,
)
from thermograsp.thermal.contact.footprint import conductance, contact

FORCES = np.logspace(-6, 3.5, 200)
PAD = Pad()
SHAPES = {
    "flat": (lambda j: flat_law(PAD, j, (0.04, 0.012)), lambda: flat_contact(PAD, FORCES, (0.04, 0.012))),
    "small": (lambda j: flat_law(PAD, j, (0.004, 0.006)), lambda: flat_contact(PAD, FORCES, (0.004, 0.006))),
}


def mixed(share: float) -> Joint:
    """Neither plastic nor elastic."""
    return Joint(2.0, 1e-6, 0.1, 5e9, 3e8, share, 0.026, 3e-7)


def special(name: str) -> Joint | None:
    """Faces in full contact, and faces that are not flat."""
    if name == "mixed":
        return mixed(0.4)
    if name == "full":
        return joint(LAPPED_ALUMINA, Surface.of(material("muscle")), full_contact=True)
    return (
        joint(LAPPED_ALUMINA, Surface.of(material("plastic")), flatness=1e-5) if name == "crowned" else None
    )


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("name", ["glass", "copper", "cotton", "polyethylene", "mixed", "full", "crowned"])
def test_it_is_the_area_and_conductance_law_over_nine_decades_of_force(shape, name):
    pair = special(name) or joint(LAPPED_ALUMINA, Surface.of(material(name)))
    compiled, reference = SHAPES[shape]
    law, expected = compiled(pair), reference()
    area, load = np.array([contact(law, force, np.zeros(3)) for force in FORCES]).T
    assert np.allclose(area, expected.face, rtol=1e-12, atol=0)
    assert np.allclose(load, expected.face_force, rtol=1e-12, atol=0)
    found = [conductance(law, pressure) for pressure in expected.face_pressure]
    assert np.allclose(found, contact_conductance(pair, expected.face_pressure), rtol=1e-10, atol=0)


def test_of_what_is_curved_it_has_no_numbers() -> None:
    pair = joint(LAPPED_ALUMINA, Surface.of(material("glass")))
    for law in (sphere_law(PAD, pair, 0.02), cylinder_law(PAD, pair, 0.02, 0.05)):
        assert np.isnan(contact(law, 1.0, np.zeros(3))).all()


def test_a_pad_off_the_middle_meets_what_lies_under_it() -> None:
    rng, pair = np.random.default_rng(0), joint(LAPPED_ALUMINA, Surface.of(material("glass")))
    for size in ((0.04, 0.03), (0.006, 0.05), (0.015, 0.004)):
        law, fixed = flat_law(PAD, pair, size, (2, 0)), flat_law(PAD, pair, size)
        for place in rng.uniform(-0.03, 0.03, (200, 3)):
            expected = flat_contact(PAD, 1.0, size, (place[2], place[0]))
            area, load = contact(law, 1.0, place)
            assert area == pytest.approx(float(expected.face), rel=1e-12, abs=1e-18)
            assert load == pytest.approx(float(expected.face_force), rel=1e-12, abs=1e-15)
            assert contact(fixed, 1.0, place) == (fixed["area"], fixed["share"])
        assert contact(law, 1.0, np.zeros(3)) == (law["area"], law["share"])


@pytest.mark.parametrize("skin", [None, *SKINS])
def test_its_numbers_are_finite_for_every_material(skin: str | None) -> None:
    """As MuJoCo's plugin and float32 need them; soft materials have no hardness."""
    face = LAPPED_ALUMINA if skin is None else Surface.of(SKINS[skin].made_of)
    for name, one in materials().items():
        law = flat_law(PAD, joint(face, Surface.of(one), full_contact=skin is not None), (0.04, 0.012))
        assert all(np.isfinite(np.float32(law[field])).all() for field in law.dtype.names or ()), name
