"""Mean temperatures of narrow contacts' faces: the elements' own check, and what docs/physics.md says of them."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

pytest.importorskip("skfem")
from thermograsp.thermal import PressProblem, material, sensor  # noqa: E402

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, str(ROOT / "studies" / "elements"))
    yield importlib.import_module("narrow_faces")
    sys.path.remove(str(ROOT / "studies" / "elements"))
    for name in ("narrow_faces", "fem"):
        del sys.modules[name]


def test_a_contact_that_is_added_place_by_place_is_the_even_one_of_the_reference(study: ModuleType) -> None:
    """And between its two means heat flows by its conductance."""
    width, through = 6e-3, 1e4
    problem = PressProblem(
        stack=sensor("seed"),
        material=material("steel"),
        mode="T",
        conductance=through,
        area=width**2,
        shape="square",
        object_size=study.BLOCK,
        air=0.0,
        sensor_temperature=study.WARM,
        object_temperature=study.COOL,
    )
    expected = importlib.import_module("fem").run(problem, np.array(study.TIMES), 0.7)
    found, driving = study.by_elements(study.Case("steel", width, through), 0.7)
    np.testing.assert_allclose(found.drop, expected.temperature_drop, atol=0.003)
    flow = through * width**2 * (found.sensor - found.object)
    np.testing.assert_allclose(flow, expected.heat_flow, rtol=0.002)
    np.testing.assert_allclose(driving.sensor, found.sensor, atol=1e-6)


@pytest.mark.parametrize("name", ["3 mm/aluminium", "3 mm, skin/steel", "even ball/steel", "3 mm/wood"])
def test_the_means_of_even_contacts_are_those_of_elements(study: ModuleType, name: str) -> None:
    case = study.cases()[name]
    expected, found = study.by_elements(case, 0.7)[0], study.by_touch(case)
    for side in ("drop", "sensor", "object"):
        np.testing.assert_allclose(getattr(found, side), getattr(expected, side), atol=0.1, err_msg=side)


@pytest.mark.parametrize("name", ["ball/aluminium", "ball/steel"])
def test_an_uneven_contact_counts_as_narrower(study: ModuleType, name: str) -> None:
    """What is said of both faces is what drives heat, which is colder than the mean over the area."""
    case = study.cases()[name]
    (expected, driving), found = study.by_elements(case, 0.7), study.by_touch(case)
    even = study.by_touch(replace(case, law=None))
    assert 0.15 < (even.drop - expected.drop).max() < 0.55
    np.testing.assert_allclose(found.drop, expected.drop, atol=0.08)
    np.testing.assert_allclose(found.sensor, driving.sensor, atol=0.18)
    np.testing.assert_allclose(found.object, driving.object, atol=0.08)
    assert (driving.sensor < expected.sensor).all()


def test_a_case_that_is_none_is_refused(study: ModuleType) -> None:
    with pytest.raises(SystemExit, match="2"):
        study.main(["lead"])
