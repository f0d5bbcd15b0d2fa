"""The contact law of arrays is the compiled one."""

from __future__ import annotations

import numpy as np
import pytest

from thermograsp.thermal import (
    LAPPED_ALUMINA,
    SKINS,
    Pad,
    Surface,
    flat_law,
    joint,
    material,
)
from thermograsp.thermal.contact import (
    array_conductance,
    array_contact,
    array_laws,
    conductance,
    contact,
    skinned,
)

FORCES = np.logspace(-6, 3.5, 60)
PAD, SKINNED = Pad(), skinned(Pad(), SKINS["filled_silicone"])
SHAPES = {
    "flat": lambda j: flat_law(PAD, j, (0.04, 0.012)),
    "flat that follows": lambda j: flat_law(PAD, j, (0.04, 0.03), (2, 1)),
    "flat on a skin": lambda j: flat_law(SKINNED, j, (0.04, 0.03), (2, 1)),
}
PLACES = np.array([[0.0, 0.0, 0.0], [0.0, 0.012, -0.018], [0.01, 0.05, 0.0]])


@pytest.mark.parametrize("name", ["glass", "cotton", "polyethylene", "muscle in full contact, crowned"])
def test_all_shapes_at_once_over_nine_decades_of_force(name: str) -> None:
    name, *special = name.split(" ", 1)
    flatness = 1e-5 if special else 0.0
    pair = joint(LAPPED_ALUMINA, Surface.of(material(name)), full_contact=bool(special), flatness=flatness)
    records = np.array([make(pair) for make in SHAPES.values()])
    laws = array_laws(records, np.zeros(0))
    for place in PLACES:
        for force in FORCES:
            area, share = array_contact(laws, np.full(len(records), force), np.tile(place, (len(records), 1)))
            expected = np.array([contact(record, force, place) for record in records])
            np.testing.assert_allclose(area, expected[:, 0], rtol=1e-9, atol=1e-18)
            np.testing.assert_allclose(share, expected[:, 1], rtol=1e-9, atol=1e-18)
            touching = area > 0
            pressure = np.where(touching, share / np.where(touching, area, 1.0), 1.0)
            h = [conductance(record, p) for record, p in zip(records, pressure, strict=True)]
            np.testing.assert_allclose(array_conductance(laws, pressure), h, rtol=1e-9)


def test_what_is_apart_has_no_area() -> None:
    pair = joint(LAPPED_ALUMINA, Surface.of(material("glass")))
    laws = array_laws(np.array([make(pair) for make in SHAPES.values()]), np.zeros(0))
    for force in (0.0, -3.0):
        area, share = array_contact(laws, np.full(len(SHAPES), force), np.zeros((len(SHAPES), 3)))
        assert not area.any() and not share.any()
