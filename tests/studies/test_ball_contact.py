"""Footprints beside finite elements of a ball on a half-space, on a skin and on the pad."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

pytest.importorskip("skfem")
ROOT = Path(__file__).parents[2]
FORCES = (1.0, 10.0, 30.0)


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, str(ROOT / "studies" / "contact"))
    yield importlib.import_module("ball_contact")
    sys.path.remove(str(ROOT / "studies" / "contact"))
    del sys.modules["ball_contact"]


@pytest.mark.parametrize(
    ("name", "radius", "peak", "conductance"),
    [
        # Hertz's solution, which shows what the finite elements themselves are good to
        ("bare", 0.01, 0.02, 0.01),
        # a skin's springs are fitted at one half width to what bulges beside the contact
        ("skin 0.2 mm", 0.1, 0.27, 0.15),
        ("skin 1 mm", 0.03, 0.21, 0.18),
        # what can be compressed bulges less than the springs suppose
        ("skin 0.2 mm, compressible", 0.07, 0.09, 0.22),
        # springs do not carry along the pad, which is nearly incompressible: docs/physics.md states this
        ("pad", 0.18, 0.75, 0.27),
    ],
)
def test_a_footprint_is_that_of_finite_elements(
    study: ModuleType, name: str, radius: float, peak: float, conductance: float
) -> None:
    layer, pair, law = study.cases()[name]
    flexible = study.compliance(layer, 80)
    for force in FORCES:
        fem, package = study.contact_of(*flexible, pair, force), study.ours(law, force, name != "bare")
        assert package.radius == pytest.approx(fem.radius, rel=radius)
        assert package.peak == pytest.approx(fem.peak, rel=peak)
        assert package.conductance == pytest.approx(fem.conductance, rel=conductance)
        assert package.share == pytest.approx(fem.share, abs=0.01)


def test_nodes_press_or_part_and_the_forces_balance(study: ModuleType) -> None:
    layer, _, _ = study.cases()["skin 0.2 mm"]
    places, rings, flexible = study.compliance(layer, 60)
    assert np.allclose(flexible, flexible.T, rtol=1e-6, atol=1e-12 * flexible.max())
    for force in FORCES:
        loads, gap, depth = study.pressed(places, flexible, force, study.RADIUS)
        assert loads.sum() == pytest.approx(force, rel=1e-6)
        assert (loads >= 0).all() and depth > 0
        assert abs(loads * gap).max() < 1e-9 * force * depth
    assert rings.sum() == pytest.approx(np.pi * places[-1] ** 2, rel=0.05)
