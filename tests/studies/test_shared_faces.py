"""Several objects under one sensor beside finite volumes in three dimensions."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
BOUND = 0.16  # K of 12


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, str(ROOT / "studies" / "scenes"))
    yield importlib.import_module("shared_faces")
    sys.path.remove(str(ROOT / "studies" / "scenes"))
    for name in ("shared_faces", "placed_patches"):
        del sys.modules[name]


VOLUMES = {
    "halves of aluminium": (9.949, 10.765),
    "halves of glass": (3.161, 4.379),
    "halves, aluminium and wood": (6.123, 8.121),
    "halves, aluminium and glass": (6.946, 8.723),
    "halves, glass and wood": (2.135, 3.068),
    "a quarter of aluminium, wood": (3.964, 5.887),
    "a quarter of wood, aluminium": (8.266, 10.002),
    "aluminium, 3 mm apart": (8.111, 10.16),
    "steel, 3 mm apart": (7.228, 9.561),
    "thirds of aluminium": (9.913, 10.722),
    "thirds, glass between aluminium": (8.479, 10.187),
    "two rods of aluminium": (6.373, 9.458),
    "a rod of aluminium, one of glass": (3.95, 6.511),
    "two balls of aluminium": (3.673, 6.906),
    "two balls of glass": (0.818, 1.511),
    "two balls of aluminium, nearer": (2.114, 4.671),
    "corners of aluminium": (3.778, 6.969),
}
"""K after .5 and 2 s, by the study's volumes of two grids, extrapolated by the square of their cells."""


@pytest.mark.parametrize("case", VOLUMES)
def test_the_drop_is_that_of_volumes(study: ModuleType, case: str) -> None:
    found = study.by_network(study.CASES[case])
    assert np.abs(found - VOLUMES[case]).max() < BOUND


@pytest.mark.parametrize("case", ["halves, aluminium and wood", "two balls of glass"])
def test_the_volumes_are_what_was_noted(study: ModuleType, case: str) -> None:
    coarse, fine = (np.array(study.by_volumes(study.CASES[case], refine)) for refine in (1.0, 1.5))
    assert np.abs(fine - coarse).max() < 0.04
    assert study.extrapolated(coarse, fine) == pytest.approx(VOLUMES[case], abs=2e-3)
