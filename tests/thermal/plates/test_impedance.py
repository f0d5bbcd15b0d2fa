"""Impedances from heat kernels against transmission lines and against sums over eigenfunctions."""

from dataclasses import replace
from functools import cache
from typing import Literal

import numpy as np
import pytest

from thermograsp.thermal.matter.layers import Layer
from thermograsp.thermal.matter.materials import material
from thermograsp.thermal.matter.mounting import Mode
from thermograsp.thermal.matter.sensors import sensor
from thermograsp.thermal.plates.impedance import (
    Far,
    half_space_impedance,
    layer_impedance,
    layered_impedance,
    stack_impedance,
    stack_profile,
    transfer_impedance,
)
from thermograsp.thermal.plates.lateral_sum import lateral_sum
from thermograsp.thermal.plates.patch import RoundPatch, SquarePatch
from thermograsp.thermal.plates.samples import Geometry, sample_bodies
from thermograsp.thermal.plates.section import Disc, Rectangle

GLASS = Layer("glass", 0.01, 1.0, 2500, 840)
METAL = Layer("metal", 0.002, 237.0, 2700, 897)
PLATE = Layer("plate", 7e-4, 25.0, 3900, 850)
STACK = (PLATE, Layer("telluride", 1.6e-3, 1.6, 7740, 154.4), PLATE)
S = np.geomspace(1e-2, 1e3, 6)
SECTIONS = [
    (Rectangle(0.02, 0.02), SquarePatch(0.0045)),
    (Rectangle(0.03, 0.01), SquarePatch(0.002, square=False)),
    (Disc(0.02), RoundPatch(0.005)),
]


@cache
def reference(section: Rectangle | Disc, patch: SquarePatch | RoundPatch):
    """Sums over the section's eigenfunctions, from the patch to itself."""
    return lateral_sum(section, patch, patch)


def assert_same(z: np.ndarray, summed: np.ndarray, patch) -> None:
    """To 3e-4 of the largest pattern: the narrowest ones need more wave numbers than the sum has; they hold little
    heat, so that the uniform pattern agrees to 1e-6."""
    difference = np.abs(z - summed).max(axis=(1, 2))
    assert np.all(difference < 3e-4 * np.abs(summed).max(axis=(1, 2)))
    mean = np.einsum("c,scd,d->s", patch.uniform, summed, patch.uniform)
    np.testing.assert_allclose(np.einsum("c,scd,d->s", patch.uniform, z, patch.uniform), mean, rtol=1e-6)


@pytest.mark.parametrize(
    ("section", "whole"), [(Rectangle(0.01, 0.01), SquarePatch(0.01)), (Disc(0.01), RoundPatch(0.01))]
)
def test_one_dimensional_where_the_patch_is_the_face(section, whole) -> None:
    """The uniform pattern over the whole face sees the transmission line at wave number 0 and stays uniform."""
    uniform, one = whole.uniform, np.zeros(1)
    pole = whole.area / section.area / (S * GLASS.thickness * GLASS.volumetric_heat_capacity)
    cases: tuple[tuple[tuple[Layer, ...], Far], ...] = (
        (STACK, "isothermal"),
        ((GLASS,), "isothermal"),
        ((GLASS,), "adiabatic"),
    )
    for slabs, far in cases:
        if len(slabs) == 1:
            z = layer_impedance(GLASS, section, whole, far, S).value @ uniform
        else:
            z = layered_impedance(slabs, far, section, whole, S).value @ uniform
        line = stack_impedance(slabs, far, S[:, None], one)[:, 0] - (pole if far == "adiabatic" else 0)
        np.testing.assert_allclose(z, line[:, None] * uniform, atol=1e-7 * np.abs(line).max())


@pytest.mark.parametrize(("section", "patch"), SECTIONS)
@pytest.mark.parametrize("slab", [GLASS, METAL])
def test_slab_is_the_sum_over_eigenfunctions(section, patch, slab) -> None:
    direct = reference(section, patch)
    for far in ("adiabatic", "isothermal"):
        z = layer_impedance(slab, section, patch, far, S).value
        if far == "adiabatic":
            capacity = section.area * slab.thickness * slab.volumetric_heat_capacity
            z = z + np.outer(patch.uniform, patch.uniform) * patch.area / capacity / S[:, None, None]
        summed = direct(lambda s, kappa2, far=far: stack_impedance((slab,), far, s, kappa2), S)
        assert_same(z, summed, patch)


@pytest.mark.parametrize(
    ("section", "patch", "thickness"),
    [
        (Rectangle(0.25, 0.005), SquarePatch(0.0045, square=False), 0.01),
        (Rectangle(0.01, 0.01), SquarePatch(0.0045), 0.3),
        pytest.param(Disc(0.3), RoundPatch(0.0045), 0.001, marks=pytest.mark.slow),
    ],
)
def test_slow_bodies_are_followed_to_their_end(section, patch, thickness) -> None:
    """Long bars and rods, wide discs: the even pattern at the start of the control band and below."""
    slow, uniform = np.array([1e-4, 1e-3, 1e-2]), patch.uniform
    slab = Layer("copper", thickness, 400.0, 8960, 385)
    z = layer_impedance(slab, section, patch, "adiabatic", slow)
    pole = patch.area / (section.area * slab.thickness * slab.volumetric_heat_capacity)
    direct = lateral_sum(section, patch, patch)

    def even(matrix: np.ndarray) -> np.ndarray:
        return np.einsum("c,scd,d->s", uniform, matrix, uniform)

    summed = even(direct(lambda s, kappa2: stack_impedance((slab,), "adiabatic", s, kappa2), slow))
    np.testing.assert_allclose(even(z.value) + pole / slow, summed, rtol=2e-6)
    step = 1e-3
    up, down = (
        even(layer_impedance(slab, section, patch, "adiabatic", slow * (1 + sign * step)).value)
        for sign in (1, -1)
    )
    rest = summed - pole / slow
    np.testing.assert_allclose(even(z.value), rest, rtol=3e-5)
    np.testing.assert_allclose(even(z.slope), (up - down) / (2 * step * slow), rtol=1e-5)


@pytest.mark.parametrize(("section", "patch"), SECTIONS)
def test_stack_and_transfer_are_sums_over_eigenfunctions(section, patch) -> None:
    direct = reference(section, patch)
    summed = direct(lambda s, kappa2: stack_impedance(STACK, "isothermal", s, kappa2), S)
    z = layered_impedance(STACK, "isothermal", section, patch, S).value
    assert_same(z, summed, patch)
    slow = S[S < 10]  # faster than that nothing comes through
    across = direct(lambda s, kappa2: stack_profile(STACK, "adiabatic", s, kappa2)[0][-1], slow)
    z = transfer_impedance(STACK, section, patch, patch, slow).value
    assert_same(z, across, patch)


@pytest.mark.parametrize("mode", ["T", "O"])
@pytest.mark.parametrize("fingertips", [1, 2])
def test_slopes_are_derivatives(mode: Mode, fingertips: Literal[1, 2]) -> None:
    """Central differences: their error falls by 4 when the step is halved, so Richardson's value is good to 1e-9."""
    geometry = Geometry(
        sensor("seed"), material("glass"), mode, 5e-5, "square", (0.04, 0.04, 0.01), fingertips
    )
    s = np.array([0.02, 1.0, 300.0])
    sampled = sample_bodies(geometry, s)

    def slope(name: str, step: float) -> np.ndarray:
        up, down = (sample_bodies(geometry, s * (1 + sign * step))[name].impedance.value for sign in (1, -1))
        return (up - down) / (2 * step * s[:, None, None])

    for name, body in sampled.items():
        expected = (4 * slope(name, 1e-3) - slope(name, 2e-3)) / 3
        np.testing.assert_allclose(
            body.impedance.slope, expected, atol=3e-8 * np.abs(expected).max(axis=(1, 2)).max(), rtol=1e-5
        )


def test_half_space_scales() -> None:
    """Z of a half-space depends on length and s through a sqrt(s/alpha) alone: twice the patch at a quarter of s has
    twice the impedance, as long as the section's sides are far."""
    near, far = Rectangle(0.2, 0.2), Rectangle(0.4, 0.4)
    s = np.array([5.0, 50.0])
    one = half_space_impedance(GLASS, near, SquarePatch(0.004), s).value
    two = half_space_impedance(GLASS, far, SquarePatch(0.008), s / 4).value
    np.testing.assert_allclose(two, 2 * one, rtol=1e-6, atol=1e-9)


def test_uniform_spreading_resistance_of_a_disc() -> None:
    """Static limit: a uniform flux over a disc of radius a on a half-space has the mean temperature 8 q a / (3 pi k)
    (Carslaw & Jaeger, section 8.2)."""
    patch = RoundPatch(0.002)
    z = half_space_impedance(GLASS, Disc(1.0), patch, np.array([1e-4])).value[0]
    expected = 8 * patch.radius / (3 * np.pi * GLASS.conductivity)
    # heat has come only as far as L = sqrt(alpha / s), which takes a^2 / (2 k L) from a point source's field, 2 % here
    length = np.sqrt(GLASS.diffusivity / 1e-4)
    static = expected - patch.radius**2 / (2 * GLASS.conductivity * length)
    assert patch.uniform @ z @ patch.uniform == pytest.approx(static, rel=1e-3)


@pytest.mark.parametrize("far", ["adiabatic", "isothermal"])
def test_a_layer_is_the_same_where_it_is_cut_a_micrometre_below_its_face(far: Far) -> None:
    whole, *below = STACK
    thin, rest = replace(whole, thickness=1e-6), replace(whole, thickness=whole.thickness - 1e-6)
    section, patch = Rectangle(0.0045, 0.003), SquarePatch(0.002, square=False)
    expected = layered_impedance(STACK, far, section, patch, S)
    found = layered_impedance((thin, rest, *below), far, section, patch, S)
    for at in range(len(S)):
        scale = np.abs(expected.value[at]).max()
        np.testing.assert_allclose(found.value[at], expected.value[at], rtol=0, atol=1e-6 * scale)
        scale = np.abs(expected.slope[at]).max()
        np.testing.assert_allclose(found.slope[at], expected.slope[at], rtol=0, atol=1e-6 * scale)
