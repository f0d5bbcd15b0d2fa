"""The pad around the sensor, which the models leave out: how much the docs say that it changes."""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

pytest.importorskip("skfem")
ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, str(ROOT / "studies"))
    yield importlib.import_module("pad_heat")
    sys.path.remove(str(ROOT / "studies"))
    del sys.modules["pad_heat"]


@pytest.mark.parametrize(("name", "least", "most"), [("glass", 0.2, 0.27), ("stainless_steel", 0.28, 0.37)])
def test_a_pad_changes_the_drop_by_what_the_docs_say(
    study: ModuleType, name: str, least: float, most: float
) -> None:
    alone, padded = (study.drops(name, with_it, refine=0.7) for with_it in (False, True))
    table = json.loads((ROOT / "tests" / "data" / "press_3d.json").read_text())["cases"][f"{name}/10000/T"]
    known = [table["Td"][table["t"].index(t)] for t in study.TIMES[:3]]
    np.testing.assert_allclose(alone[:3], known, atol=0.08)  # a disc stands for the square
    assert least < abs(padded - alone).max() < most
    assert (padded < alone).all()
