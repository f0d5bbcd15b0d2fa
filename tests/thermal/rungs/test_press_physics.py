"""What a press must show whatever computes it: the order of materials, round patches, air, two fingertips."""

from __future__ import annotations

import numpy as np
import pytest

from thermograsp.thermal import SEED_MATERIALS, Mode, press


def test_ten_materials_are_in_the_order_of_effusivity_at_equal_conductance() -> None:
    """From .2 to 5 s in T mode; plastic and rubber, 3 % apart, are the closest."""
    runs = [press(name, seconds=5.0, dt=0.1, tolerance=0.005) for name in SEED_MATERIALS]
    drops = np.array([run.temperature_drop for run in runs])[:, runs[0].t >= 0.2]
    assert np.all(np.diff(drops, axis=0) > 0)


@pytest.mark.parametrize("mode", ["T", "O"])
def test_a_round_patch_agrees_with_the_axisymmetric_grid(mode: Mode) -> None:
    network, grid = (
        press("glass", mode=mode, shape="round", area=5e-5, seconds=5.0, dt=0.1, tolerance=0.005, rung=rung)
        for rung in ("network", "axisymmetric")
    )
    assert np.max(np.abs(network.temperature_drop - grid.temperature_drop)) < 0.012


@pytest.mark.parametrize("mode", ["T", "O"])
@pytest.mark.parametrize("name", ["cotton", "aluminium"])
def test_air_is_lumped_to_two_hundredths_of_a_kelvin(mode: Mode, name: str) -> None:
    """Against convection on every free face of the grid, the worst for a poor conductor."""
    still, same = (
        press(name, mode=mode, seconds=10.0, dt=0.2, tolerance=0.005, rung=rung)
        for rung in ("network", "axisymmetric")
    )
    network, grid = (
        press(name, mode=mode, air=10.0, seconds=10.0, dt=0.2, rung=rung)
        for rung in (still.rung, "axisymmetric")
    )
    shape = still.temperature_drop - same.temperature_drop  # what the disc of equal area costs
    assert np.max(np.abs(network.temperature_drop - grid.temperature_drop - shape)) < 0.02


@pytest.mark.parametrize("mode", ["T", "O"])
@pytest.mark.parametrize("name", ["glass", "aluminium"])
def test_two_equal_presses_see_half_the_plate_each(mode: Mode, name: str) -> None:
    """By symmetry the middle plane is adiabatic."""
    both = press(name, mode=mode, opposite=1e4, seconds=10.0, dt=0.1, tolerance=0.005)
    half = press(name, mode=mode, object_size=(0.04, 0.04, 0.005), seconds=10.0, dt=0.1, tolerance=0.005)
    assert np.max(np.abs(both.temperature_drop - half.temperature_drop)[1:]) < 0.01
    assert both.stored_heat[-1, 1] == pytest.approx(2 * half.stored_heat[-1, 1], rel=2e-3)
