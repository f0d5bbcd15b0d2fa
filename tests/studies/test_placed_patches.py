"""Contacts at the edge of a face beside finite volumes in three dimensions."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
BOUND, ON_BARS = 0.09, 0.19  # K of 12; the most on bars, of aluminium, 1 mm aside of the face's middle


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, str(ROOT / "studies" / "scenes"))
    yield importlib.import_module("placed_patches")
    sys.path.remove(str(ROOT / "studies" / "scenes"))
    del sys.modules["placed_patches"]


VOLUMES = {
    ("quarter", "steel"): (1.953, 3.833),
    ("quarter", "aluminium"): (2.135, 4.135),
    ("quarter", "glass"): (0.69, 1.224),
    ("quarter", "wood"): (0.23, 0.386),
    ("half", "steel"): (3.575, 6.096),
    ("half", "aluminium"): (3.915, 6.587),
    ("half", "glass"): (1.314, 2.159),
    ("half", "wood"): (0.448, 0.722),
    ("three quarters", "steel"): (5.194, 8.172),
    ("three quarters", "aluminium"): (5.679, 8.801),
    ("three quarters", "glass"): (1.938, 3.074),
    ("three quarters", "wood"): (0.666, 1.054),
    ("rod in the middle", "steel"): (1.755, 4.196),
    ("rod in the middle", "aluminium"): (1.883, 4.478),
    ("rod in the middle", "glass"): (0.58, 1.191),
    ("rod in the middle", "wood"): (0.18, 0.33),
    ("line of a bare rod", "steel"): (2.091, 4.634),
    ("line of a bare rod", "aluminium"): (2.407, 5.189),
    ("line of a bare rod", "glass"): (0.293, 0.671),
    ("line of a bare rod", "wood"): (0.064, 0.139),
    ("rod off the middle", "steel"): (1.707, 3.66),
    ("rod off the middle", "aluminium"): (1.828, 3.868),
    ("rod off the middle", "glass"): (0.573, 1.141),
    ("rod off the middle", "wood"): (0.179, 0.326),
    ("rod at the face's edge", "steel"): (1.543, 3.253),
    ("rod at the face's edge", "aluminium"): (1.643, 3.419),
    ("rod at the face's edge", "glass"): (0.549, 1.092),
    ("rod at the face's edge", "wood"): (0.177, 0.322),
    ("rod that ends", "steel"): (0.91, 2.316),
    ("rod that ends", "aluminium"): (0.979, 2.494),
    ("rod that ends", "glass"): (0.293, 0.612),
    ("rod that ends", "wood"): (0.09, 0.166),
    ("ball in the middle", "steel"): (0.992, 2.599),
    ("ball in the middle", "aluminium"): (1.066, 2.785),
    ("ball in the middle", "glass"): (0.319, 0.672),
    ("ball in the middle", "wood"): (0.098, 0.181),
    ("ball off the middle", "steel"): (0.978, 2.434),
    ("ball off the middle", "aluminium"): (1.05, 2.595),
    ("ball off the middle", "glass"): (0.318, 0.659),
    ("ball off the middle", "wood"): (0.098, 0.18),
    ("ball at the face's edge", "steel"): (0.928, 2.265),
    ("ball at the face's edge", "aluminium"): (0.993, 2.406),
    ("ball at the face's edge", "glass"): (0.311, 0.643),
    ("ball at the face's edge", "wood"): (0.097, 0.178),
    ("ball at the block's edge", "steel"): (0.969, 2.525),
    ("ball at the block's edge", "aluminium"): (1.055, 2.757),
    ("ball at the block's edge", "glass"): (0.306, 0.617),
    ("ball at the block's edge", "wood"): (0.095, 0.169),
    ("rod on a wall of 1.5 mm", "steel"): (1.706, 3.926),
    ("rod on a wall of 1.5 mm", "aluminium"): (1.831, 4.301),
    ("rod on a wall of 1.5 mm", "glass"): (0.581, 1.181),
    ("rod on a wall of 1.5 mm", "wood"): (0.18, 0.33),
    ("rod on a wall of 0.6 mm", "steel"): (1.528, 3.354),
    ("rod on a wall of 0.6 mm", "aluminium"): (1.71, 3.968),
    ("rod on a wall of 0.6 mm", "glass"): (0.564, 0.9),
    ("rod on a wall of 0.6 mm", "wood"): (0.181, 0.302),
    ("bar of 8 mm", "aluminium"): (6.643, 9.541),
    ("bar of 8 mm", "glass"): (2.263, 3.456),
    ("bar of 8 mm", "wood"): (0.78, 1.207),
    ("bar of 8 mm, 1 mm aside", "aluminium"): (6.195, 9.214),
    ("bar of 8 mm, 1 mm aside", "glass"): (2.145, 3.338),
    ("bar of 8 mm, 1 mm aside", "wood"): (0.739, 1.162),
    ("bar of 8 mm, 2 mm aside", "aluminium"): (5.449, 8.482),
    ("bar of 8 mm, 2 mm aside", "glass"): (1.869, 2.975),
    ("bar of 8 mm, 2 mm aside", "wood"): (0.642, 1.018),
    ("bar of 8 mm, 4 mm aside", "aluminium"): (3.903, 6.533),
    ("bar of 8 mm, 4 mm aside", "glass"): (1.314, 2.159),
    ("bar of 8 mm, 4 mm aside", "wood"): (0.448, 0.722),
    ("bar of 9 mm, 2.5 mm aside", "aluminium"): (5.465, 8.508),
    ("bar of 9 mm, 2.5 mm aside", "glass"): (1.869, 2.976),
    ("bar of 9 mm, 2.5 mm aside", "wood"): (0.642, 1.018),
    ("bar of 5 mm, 3 mm aside", "aluminium"): (3.467, 5.93),
    ("bar of 5 mm, 3 mm aside", "glass"): (1.175, 1.949),
    ("bar of 5 mm, 3 mm aside", "wood"): (0.4, 0.647),
}
"""K after .5 and 2 s, by the study's volumes of two grids, extrapolated by the square of their cells."""


@pytest.mark.parametrize(("case", "made_of"), VOLUMES)
def test_the_drop_is_that_of_volumes(study: ModuleType, case: str, made_of: str) -> None:
    found = study.by_network(study.CASES[case], made_of)
    bound = ON_BARS if case.startswith("bar") else BOUND
    assert np.abs(np.subtract(found, VOLUMES[case, made_of])).max() < bound


@pytest.mark.parametrize(
    ("case", "made_of"),
    [("half", "steel"), ("rod at the face's edge", "wood"), ("bar of 8 mm, 2 mm aside", "glass")],
)
def test_the_volumes_are_what_was_noted(study: ModuleType, case: str, made_of: str) -> None:
    coarse, fine = (np.array(study.by_volumes(study.CASES[case], made_of, refine)) for refine in (1.0, 1.5))
    assert np.abs(fine - coarse).max() < 0.04
    assert study.extrapolated(coarse, fine) == pytest.approx(VOLUMES[case, made_of], abs=2e-3)
