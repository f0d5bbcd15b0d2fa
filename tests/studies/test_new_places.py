"""What new places cost: the study runs, and what is new is made anew."""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, str(ROOT / "studies" / "speed"))
    yield importlib.import_module("new_places")
    sys.path.remove(str(ROOT / "studies" / "speed"))
    del sys.modules["new_places"]


def test_it_tells_of_each_case(study: ModuleType, monkeypatch, capsys) -> None:
    monkeypatch.setattr(study, "WARM", 1)
    study.main(["--rows", "2", "--starts", "2", "--again", "1", "--json"])
    costs = json.loads(capsys.readouterr().out)["2"]
    assert set(costs) == set(study.CASES) and min(costs.values()) > 0


def test_whole_faces_touch_and_parts_of_them(study: ModuleType) -> None:
    """Every start has two places a row; in wide boxes all of the sensor's face touches."""
    width = study.STACK.width
    for wide in (True, False):
        start = study.drawn(np.random.default_rng(0), 8, wide)
        run, heat = study.touches(start)
        assert run() == 16
        covered = [
            np.ptp(each.foot.covered, axis=1).min() for prints in heat._prints.values() for each in prints
        ]
        assert (np.min(covered) > 0.999 * width) == wide


def test_new_places_are_made_anew(study: ModuleType) -> None:
    start = study.drawn(np.random.default_rng(0), 2, False)
    study.touches(start)[0]()
    study.forget(study.OF_PLACES)
    assert study.OF_PLACES[0] is study.boxes._UNDER and len(study.boxes._UNDER) == 0
    for each in study.OF_PLACES[1:]:
        assert each.cache_info().currsize == 0
    study.touches(start)[0]()
    assert len(study.boxes._UNDER) == len(start.bodies)
    assert study.tip_at.cache_info().misses >= 4
