"""What docs/plugin.md says of remembered places: beside networks of every place, and beside finite volumes."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, str(ROOT / "studies" / "scenes"))
    yield importlib.import_module("remembered_places")
    sys.path.remove(str(ROOT / "studies" / "scenes"))
    for name in ("remembered_places", "touch_volumes"):
        del sys.modules[name]


@pytest.mark.parametrize("mesh", [False, True])
def test_a_field_stays_where_a_fingertip_slides_away_and_returns(study: ModuleType, mesh: bool) -> None:
    """Over seven places of each of two fingertips."""
    errors = study.row("fast", "glass", (2, 12), mesh=mesh)["error_K"]
    assert errors[12] < 0.05 and errors[2] > 0.3  # so much is at stake


def test_twelve_places_serve_grasps_that_come_again(study: ModuleType) -> None:
    """At random, on nine places of each of two fingertips: with those in use fewer than there are."""
    found = study.row("regrasps", "wood", (12,))
    assert found["places"] == 18 and found["error_K"][12] < 0.12


@pytest.mark.parametrize(("slide", "sliding"), [("1 mm/s", 0.06), ("10 mm/s", 0.12)])
def test_a_slide_is_felt_as_by_finite_volumes(study: ModuleType, slide: str, sliding: float) -> None:
    """A place is as wide as a quarter of the sensor's face to each side, within which the face is taken as still."""
    found = study.beside_volumes(slide, "stainless_steel")
    assert found.sliding_K < sliding and found.back_K < sliding
