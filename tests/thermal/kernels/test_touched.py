"""Residues of boxes as they are touched."""

from __future__ import annotations

from typing import NamedTuple

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
    touched_box,
    under_tips,
)
from thermograsp.thermal.kernels import samples as samples_module
from thermograsp.thermal.kernels.box import box_kernel
from thermograsp.thermal.kernels.patterns import basis_terms

SEED = sensor("seed")
LEVEL = Resolution(12, 3, slowest=2e-3)
TIP = tip(SEED, ((0.0, SEED.width), (0.0, SEED.width)), LEVEL)
SIZE = (0.01, 0.06, 0.024)
MIDDLES = np.array([[0.03, 0.012], [0.03, 0.012], [0.0335, 0.012], [0.045, 0.012]])
FACES = np.array([0, 1, 0, 0])


def touched(name: str, film: float, places: int = 4, fingertips: int = 2) -> TouchedBox:
    patches = Patches(FACES[:places], MIDDLES[:places], np.full((places, 2), SEED.width / 2))
    return TouchedBox(material(name), SIZE, film, patches, (TIP,) * places, fingertips)


def test_what_is_under_fingertips_may_be_known():
    box = touched("stainless_steel", 5.0)
    known = under_tips(touched("stainless_steel", 5.0, 2), LEVEL)
    for one, other in zip(touched_box(box, LEVEL), touched_box(box, LEVEL, known), strict=True):
        assert np.array_equal(one, other)
    alone = touched_box(touched("stainless_steel", 5.0, 2), LEVEL)
    assert all(np.array_equal(one, other) for one, other in zip(alone, known.bare, strict=True))


@pytest.mark.parametrize("name", ["glass", "aluminium", "cotton"])
def test_what_flowed_elsewhere_is_told_as_the_kernels_have_it(name):
    """Beside what a contact's own impedance is, to a hundredth; and places that are remembered change nothing of it."""
    known = material(name)
    found = touched_box(touched(name, 0.0), LEVEL)
    without = touched_box(touched(name, 0.0, 2), LEVEL)
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
    few, few_beside = impedances(name)
    samples_module.grasp_rule.cache_clear()
    monkeypatch.setattr(samples_module, "FEW_SPACING", 0.6)
    monkeypatch.setattr(samples_module, "_UNFELT", 1e-14)
    monkeypatch.setattr(samples_module, "_FIRST", 1e-9)
    many, many_beside = impedances(name)
    samples_module.grasp_rule.cache_clear()
    rate, port = many_beside.rate, many_beside.port
    whole = np.abs(many[0][:, 0, 0] + port[0] ** 2 / (GRASP + rate) + TIP.impedance)[:, None, None]
    assert (np.abs(few[0] - many[0]) / whole).max() < 5e-4
    assert (np.abs(few[1] - many[1]) * GRASP[:, None]).max() < 1e-3
    # of what flowed elsewhere once, at the fastest moments
    assert (np.abs(transformed(few_beside) - transformed(many_beside)) / whole).max() < 1e-2


class Told(NamedTuple):
    """A kernel as box_kernel tells it, by a Rule."""

    kernel: np.ndarray
    rate: float
    port: np.ndarray
    heat: np.ndarray
    rule: samples_module.Rule


def told(box: TouchedBox, first: int) -> Told:
    known, count = box.material, box.touched
    capacity = known.volumetric_heat_capacity
    rule = samples_module.grasp_rule(known.conductivity / capacity)
    jumps = np.array([one.jumps for one in box.tips])
    terms = basis_terms(LEVEL.patterns)
    made = known.conductivity, capacity, box.film
    kernel, rate, port, _, heat = box_kernel(SIZE, *made, box.patches, jumps, terms, count, rule.times, first)
    assert heat is not None
    return Told(kernel, rate, port, heat, rule)


def impedances(name: str):
    """Of patches under fingertips, with the heat's; and the kernel of others."""
    box = touched(name, 15.0, 2)
    under, areas = told(box, 0), box.patches.areas
    alone = 1 / (areas * box.material.volumetric_heat_capacity * np.sqrt(np.pi * under.rule.begun))
    own = samples_module.at_moments(
        under.kernel, under.heat, under.port, alone, np.eye(3), under.rule.to_moments, under.rule.early
    )
    return own, told(touched(name, 15.0), 2)


def transformed(beside: Told) -> np.ndarray:
    first = beside.kernel[0] + np.outer(beside.port[:6], beside.port[6:])
    rule = beside.rule
    return np.tensordot(rule.to_moments, beside.kernel, axes=1) + rule.early[:, None, None] * first


@pytest.mark.parametrize("film", [5.0, 300.0])
def test_all_heat_that_goes_in_is_in(film):
    """At once, wherever it goes in; and a box that follows the air holds its whole capacity."""
    box = touched("wood", film)
    found = touched_box(box, LEVEL)
    even = np.concatenate([one.even for one in box.tips])
    assert found.heat.sum(axis=1) + found.held * found.ports == pytest.approx(even, abs=1e-13)
    assert found.still.min() >= 0
    capacity = box.material.volumetric_heat_capacity * np.prod(SIZE)
    assert found.still.sum() + found.held**2 == pytest.approx(capacity, rel=1e-12)
