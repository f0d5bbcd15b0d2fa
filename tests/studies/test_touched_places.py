"""What depends on where things touch, beside finite elements: the face's temperature, a touch beside a warm place."""

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


@pytest.fixture(scope="module")
def benchmarks() -> Iterator[dict[str, ModuleType]]:
    sys.path.insert(0, str(ROOT / "studies" / "elements"))
    names = ("fem", "face_map", "second_touch")
    yield {name: importlib.import_module(name) for name in names}
    sys.path.remove(str(ROOT / "studies" / "elements"))
    for name in names:
        del sys.modules[name]


@pytest.mark.parametrize(
    ("case", "pattern", "whole"),
    [
        ("aluminium/half", 0.2, 2.6),
        ("glass/half", 0.45, 1.0),
        ("glass/full", 0.3, 0.3),
        ("stainless_steel/spot", 0.1, 0.4),
    ],
)
def test_a_face_s_pattern_is_that_of_the_elements(
    benchmarks: dict[str, ModuleType], case: str, pattern: float, whole: float
) -> None:
    """K, the bounds that docs/taxels.md tells."""
    face_map = benchmarks["face_map"]
    each = face_map.cases()[case]
    expected = face_map.solved(each, 0.6)
    found = face_map.modelled(each, expected.flow, expected.contact)
    assert np.abs(found - expected.face).max() < pattern
    assert np.abs(face_map.modelled(each, *face_map.networked(each)) - expected.face).max() < whole


def test_a_touch_beside_a_warm_place_keeps_the_tolerance(benchmarks: dict[str, ModuleType]) -> None:
    second = benchmarks["second_touch"]
    expected, _ = second.by_elements("glass", 0.8)
    late = slice(2, None)
    for tolerance in (0.05, 0.03):  # heat kernels, and a mesh
        assert np.abs(second.by_networks("glass", tolerance) - expected)[late].max() < tolerance
    forgetful = second.by_networks("glass", 0.05, anywhere=False)
    assert np.abs(forgetful - expected)[late].max() > 0.1  # so much is at stake
