"""The pad around the sensor, which the models leave out: how much the docs say that it changes."""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

pytest.importorskip("skfem")
ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, str(ROOT / "studies" / "surround"))
    yield importlib.import_module("pad_heat")
    sys.path.remove(str(ROOT / "studies" / "surround"))
    del sys.modules["pad_heat"]


@pytest.mark.parametrize(("name", "least", "most"), [("glass", 0.2, 0.27), ("stainless_steel", 0.28, 0.37)])
def test_a_pad_changes_the_drop_by_what_the_docs_say(
    study: ModuleType, name: str, least: float, most: float
) -> None:
    touch = study.Touch(name, conductances=(1e4, 1e4))
    alone, padded = (study.drops(one, refine=0.7) for one in (touch.alone, touch))
    table = json.loads((ROOT / "tests" / "data" / "press_3d.json").read_text())["cases"][f"{name}/10000/T"]
    known = [table["Td"][table["t"].index(t)] for t in study.TIMES[:3]]
    np.testing.assert_allclose(alone[:3], known, atol=0.08)  # a disc stands for the square
    assert least < abs(padded - alone).max() < most
    assert (padded < alone).all()


def test_the_two_exchanges_of_the_pad_do_not_add_up(study: ModuleType) -> None:
    """Silicone that warms the object has no heat left for the sensor: a model of either alone is worse than none."""
    touch = study.Touch("wood")
    cases = touch, replace(touch, front=False), replace(touch, sides=False)
    alone = study.drops(touch.alone, refine=0.6)
    both, sensor, body = (study.drops(one, refine=0.6)[2] - alone[2] for one in cases)
    assert abs(both) < 0.04
    assert sensor < -0.1 and body < both


def test_on_a_metal_sheet_the_pad_changes_the_drop_by_a_tenth_of_the_difference(study: ModuleType) -> None:
    sheet = study.Touch("aluminium", size=(0.040, 0.001))
    changed = study.drops(sheet, refine=0.6) - study.drops(sheet.alone, refine=0.6)
    assert -1.5 < changed[-1] < -1.0
