"""Squares that stand for strips."""

from __future__ import annotations

import numpy as np
import pytest

from thermograsp.thermal import material, sensor
from thermograsp.thermal.curves import equal_square

STACK = sensor("seed")
FACE = STACK.face_area


@pytest.mark.parametrize("name", ["aluminium", "steel", "glass", "wood"])
@pytest.mark.parametrize("skinned", [True, False])
def test_a_square_stands_for_itself_and_a_longer_strip_for_a_larger_one(name: str, skinned: bool) -> None:
    body, side = material(name), 0.002
    assert equal_square(STACK, skinned, body, side**2, side) == pytest.approx(side**2, rel=1e-2)
    areas = [equal_square(STACK, skinned, body, side**2, length) for length in (0.002, 0.004, 0.006, 0.009)]
    assert (np.diff(areas) > 0).all() and areas[-1] < FACE
    assert equal_square(STACK, skinned, body, side**2, 0.5) == pytest.approx(areas[-1], rel=1e-9)


def test_the_whole_face_is_itself_and_nothing_is_larger() -> None:
    for area in (FACE, 1.2 * FACE):
        assert equal_square(STACK, True, material("glass"), area, STACK.width) == FACE


def test_a_strip_along_either_axis_is_alike() -> None:
    broad = 0.0015
    areas = [
        equal_square(STACK, True, material("glass"), broad * STACK.width, side)
        for side in (broad, STACK.width)
    ]
    assert areas[0] == pytest.approx(areas[1], rel=1e-3)
    assert equal_square(STACK, True, material("glass"), broad * STACK.width, broad * (1 - 1e-6)) > 0


def spreading(aspect: float) -> float:
    """sqrt(area) k R of an even flow over a rectangle of a half-space (Yovanovich & Marotta, Thermal spreading and
    contact resistances, in Bejan & Kraus, Heat Transfer Handbook, 2003)."""
    e = aspect
    corners = e / 3 * (1 + 1 / e**3 - (1 + 1 / e**2) ** 1.5)
    return float(np.sqrt(e) / np.pi * (np.arcsinh(1 / e) + np.arcsinh(e) / e + corners))


def test_a_line_on_metal_is_the_square_of_its_spreading_resistance() -> None:
    """In insulators heat spreads less in a second, so that the area tells more."""
    long, broad = 0.009, 0.0003
    side = np.sqrt(long * broad) * spreading(1.0) / spreading(long / broad)
    found = [
        equal_square(STACK, False, material(name), long * broad, long) for name in ("copper", "glass", "wood")
    ]
    assert found[0] == pytest.approx(side**2, rel=0.02)
    assert found[0] > found[1] > found[2] > long * broad
