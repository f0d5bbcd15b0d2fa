"""The study of meshes' networks runs, says what it compared, and finds what the docs say."""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, str(ROOT / "studies" / "meshes"))
    yield importlib.import_module("mesh_places")
    sys.path.remove(str(ROOT / "studies" / "meshes"))
    del sys.modules["mesh_places"]


def test_places_at_a_mug_s_rim_keep_the_bound(study: ModuleType, monkeypatch, capsys) -> None:
    monkeypatch.setattr(sys, "argv", ["mesh_places.py", "rim", "--json"])
    assert study.main() == 0
    found = json.loads(capsys.readouterr().out)
    assert {row["case"] for row in found} >= {"mug, over the rim", "mug, over and below the rim"}
    assert all(abs(row["error"]) < 0.036 for row in found)


def test_contents_are_felt_through_a_mug_s_wall_and_at_its_rim(study: ModuleType, monkeypatch) -> None:
    """Within what is stated of still water."""
    monkeypatch.setattr(study, "FILMS", (500.0,))
    monkeypatch.setattr(study, "MATERIALS", ("ceramic",))
    found = [row for name in ("mug, wall", "mug, over the rim") for row in study.filled_rows(name)]
    assert len(found) == 2 and all(abs(row.error) < 0.048 for row in found)


def test_a_steel_cup_in_a_sleeve_is_felt_within_what_is_stated(study: ModuleType, monkeypatch) -> None:
    """Through the sleeve, which no box with modes behind it stands for."""
    monkeypatch.setattr(study, "VESSEL_FILMS", (500.0,))
    monkeypatch.setattr(study, "DRAWN", 1)
    (row,) = study.vessel_rows("sleeved_mug")
    assert max(map(abs, row.errors)) < 0.002


def test_an_unknown_case_is_refused_with_those_there_are(study: ModuleType, monkeypatch, capsys) -> None:
    monkeypatch.setattr(sys, "argv", ["mesh_places.py", "teapot"])
    with pytest.raises(SystemExit):
        study.main()
    assert "cube, corner" in capsys.readouterr().err
