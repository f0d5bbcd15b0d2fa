"""Lateral heat kernels and flux patterns against sums over eigenfunctions."""

import numpy as np
import pytest

from thermograsp.thermal.plates.patch import RoundPatch, SquarePatch
from thermograsp.thermal.plates.section import Disc, Rectangle

CASES = [
    (Rectangle(0.02, 0.02), SquarePatch(0.0045, intervals=4)),
    (Rectangle(0.02, 0.013), SquarePatch(0.0045, square=False, intervals=4)),
    (Rectangle(0.0045, 0.0045), SquarePatch(0.0045, intervals=4)),
    (Disc(0.02), RoundPatch(0.005, intervals=5)),
    (Disc(0.005), RoundPatch(0.005, intervals=5)),
]


@pytest.mark.parametrize(("section", "patch"), CASES)
def test_kernel_is_the_sum_over_eigenfunctions(section, patch) -> None:
    """Images where the diffusion length is short, cosines where it is long: one function, down to lengths that the sum
    can still resolve (kappa_max^2 tau = 36)."""
    kappa_max = 2.5e4
    kappa2, overlaps = section.modes(patch, kappa_max)
    tau = np.geomspace(36 / kappa_max**2, 10 * section.area, 25)
    summed = np.einsum("tm,mc,md->tcd", np.exp(-np.outer(tau, kappa2)), overlaps, overlaps, optimize=True)
    np.testing.assert_allclose(section.kernel(patch, tau), summed, atol=2e-11)


@pytest.mark.parametrize(("section", "patch"), CASES)
def test_kernel_spreads_from_the_identity_to_the_mean(section, patch) -> None:
    kernel = section.kernel(patch, np.array([1e-18, 1e3]))
    np.testing.assert_allclose(kernel[0], np.eye(kernel.shape[1]), atol=1e-4)
    uniform = patch.uniform
    assert np.linalg.norm(uniform) == pytest.approx(1, abs=1e-12)
    np.testing.assert_allclose(kernel[1], np.outer(uniform, uniform) * patch.area / section.area, atol=1e-12)


@pytest.mark.parametrize(("section", "patch"), CASES)
def test_heat_stays_in_a_patch_as_wide_as_its_section(section, patch) -> None:
    """Adiabatic sides: the uniform pattern over the whole section neither decays nor leaks."""
    whole = SquarePatch(section.half_x) if isinstance(section, Rectangle) else RoundPatch(section.radius)
    if isinstance(section, Rectangle) and section.half_x != section.half_y:
        return
    kernel = section.kernel(whole, np.geomspace(1e-12, 1e-2, 7))
    np.testing.assert_allclose(
        kernel @ whole.uniform, np.broadcast_to(whole.uniform, kernel.shape[:2]), atol=1e-9
    )
