"""Residues of boxes as they are touched."""

from __future__ import annotations

import numpy as np
import pytest

from thermograsp.thermal import material, sensor
from thermograsp.thermal.kernels import (
    GRASP,
    OF_GRASP,
    Patches,
    Resolution,
    TouchedBox,
    box_samples,
    tip,
    touched_boxes,
)
from thermograsp.thermal.kernels import touched as touched_module

SEED = sensor("seed")
LEVEL = Resolution(12, 3, slowest=2e-3)
TIP = tip(SEED, ((0.0, SEED.width), (0.0, SEED.width)), LEVEL)
SIZE = (0.01, 0.06, 0.024)
MIDDLES = np.array([[0.03, 0.012], [0.03, 0.012], [0.0335, 0.012], [0.045, 0.012]])
FACES = np.array([0, 1, 0, 0])


def touched(name: str, film: float, places: int = 4, fingertips: int = 2) -> TouchedBox:
    patches = Patches(FACES[:places], MIDDLES[:places], np.full((places, 2), SEED.width / 2))
    return TouchedBox(material(name), SIZE, film, patches, (TIP,) * places, fingertips)


def test_a_box_s_numbers_do_not_depend_on_the_others():
    boxes = [
        touched(name, film, places, fingertips)
        for name, film, places, fingertips in (
            ("glass", 5.0, 4, 2),
            ("aluminium", 5.0, 4, 2),
            ("wood", 0.0, 4, 2),
            ("glass", 5.0, 2, 1),
            ("stainless_steel", 5.0, 4, 2),
        )
    ]
    together = touched_boxes(boxes, LEVEL)
    for box, found in zip(boxes, together, strict=True):
        [alone] = touched_boxes([box], LEVEL)
        assert all(np.array_equal(one, other) for one, other in zip(alone, found, strict=True))
    assert touched_boxes([], LEVEL) == []


@pytest.mark.parametrize("name", ["glass", "aluminium", "cotton"])
def test_what_flowed_elsewhere_is_told_as_the_kernels_have_it(name):
    """Beside what a contact's own impedance is, to a hundredth; and places that are remembered change nothing of it."""
    known = material(name)
    [found] = touched_boxes([touched(name, 0.0)], LEVEL)
    [without] = touched_boxes([touched(name, 0.0, 2)], LEVEL)
    assert np.abs(found.residues[:, :6] - without.residues).max() < 1e-9 * without.residues.max()
    patches = touched(name, 0.0).patches
    exact = box_samples(
        SIZE, known.conductivity, known.volumetric_heat_capacity, 0.0, patches, [TIP.basis] * 4
    ).impedance[OF_GRASP, :6]
    fitted = np.einsum("ijk,sk->sij", found.residues, 1 / (GRASP[:, None] + LEVEL.decay))
    whole = np.abs(exact[:, 0, 0] + found.ports[0] ** 2 / GRASP + TIP.impedance)[:, None, None]
    assert (np.abs(fitted - exact) / whole).max() < 0.01
    assert min(np.linalg.eigvalsh(each).min() for each in found.residues[:, :6].transpose(2, 0, 1)) > -1e-9


@pytest.mark.parametrize("name", ["cotton", "cork", "wood", "glass", "stainless_steel", "aluminium"])
def test_few_times_of_a_kernel_tell_its_transform(monkeypatch, name):
    """Of patches by themselves and of those that they overlap, which feel each other at once, beside many times from
    very early on."""
    box = touched(name, 15.0)
    few = touched_module._samples(box)
    touched_module._transform.cache_clear()
    monkeypatch.setattr(touched_module, "_SPACING", 0.6)
    monkeypatch.setattr(touched_module, "_UNFELT", 1e-14)
    monkeypatch.setattr(touched_module, "_FIRST", 1e-9)
    many = touched_module._samples(box)
    touched_module._transform.cache_clear()
    exact = many.impedance
    whole = np.abs(exact[:, 0, 0] + many.port[0] ** 2 / (GRASP + many.rate) + TIP.impedance)
    difference = np.abs(few.impedance - exact) / whole[:, None, None]
    assert difference[..., :6].max() < 5e-4
    assert difference.max() < 1e-2  # of what flowed elsewhere once, at the fastest moments
    assert (np.abs(few.heat - many.heat) * GRASP[:, None]).max() < 1e-3


@pytest.mark.parametrize("film", [5.0, 300.0])
def test_all_heat_that_goes_in_is_in(film):
    """At once, wherever it goes in; and a box that follows the air holds its whole capacity."""
    box = touched("wood", film)
    [found] = touched_boxes([box], LEVEL)
    even = np.concatenate([one.even for one in box.tips])
    assert found.heat.sum(axis=1) + found.held * found.ports == pytest.approx(even, abs=1e-13)
    assert found.still.min() >= 0
    capacity = box.material.volumetric_heat_capacity * np.prod(SIZE)
    assert found.still.sum() + found.held**2 == pytest.approx(capacity, rel=1e-12)
