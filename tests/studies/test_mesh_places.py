"""The study of meshes' networks runs, says what it compared, and finds what the docs say."""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def study() -> Iterator[Callable[[str], ModuleType]]:
    """A file of the study, by its name."""
    before = set(sys.modules)
    sys.path.insert(0, str(ROOT / "studies" / "meshes"))
    yield importlib.import_module
    sys.path.remove(str(ROOT / "studies" / "meshes"))
    for name in set(sys.modules) - before:
        if name.startswith(("mesh_places", "place_")):
            del sys.modules[name]


def test_places_at_a_mug_s_rim_keep_the_bound(study, monkeypatch, capsys) -> None:
    monkeypatch.setattr(sys, "argv", ["mesh_places.py", "rim", "--json"])
    assert study("mesh_places").main() == 0
    found = json.loads(capsys.readouterr().out)
    assert {row["case"] for row in found} >= {"mug, over the rim", "mug, over and below the rim"}
    assert all(abs(row["error"]) < 0.036 for row in found)


def test_contents_are_felt_through_a_mug_s_wall_and_at_its_rim(study, monkeypatch) -> None:
    """Within what is stated of still water."""
    films = study("place_films")
    monkeypatch.setattr(films, "FILMS", (500.0,))
    monkeypatch.setattr(films, "MATERIALS", ("ceramic",))
    found = [row for name in ("mug, wall", "mug, over the rim") for row in films.filled_rows(name)]
    assert len(found) == 2 and all(abs(row.error) < 0.048 for row in found)


def test_a_steel_cup_in_a_sleeve_is_felt_within_what_is_stated(study, monkeypatch) -> None:
    """Through the sleeve, which no box with modes behind it stands for."""
    vessels = study("place_vessels")
    monkeypatch.setattr(vessels, "VESSEL_FILMS", (500.0,))
    monkeypatch.setattr(vessels, "DRAWN", 1)
    (row,) = vessels.vessel_rows("sleeved_mug")
    assert max(map(abs, row.errors)) < 0.002


def test_fingertips_that_have_slid_on_are_felt_without_a_grid(study, monkeypatch) -> None:
    pairs = study("place_pairs")
    monkeypatch.setattr(pairs, "VESSELS", ("plastic_cup",))
    found = [*pairs.pair_rows("slid down from the rim"), *pairs.pair_rows("slid along the foot")]
    assert len(found) == 2 and not any(row.grids for row in found)
    assert max(abs(row.error) for row in found) < 0.044


def test_an_unknown_case_is_refused_with_those_there_are(study, monkeypatch, capsys) -> None:
    monkeypatch.setattr(sys, "argv", ["mesh_places.py", "teapot"])
    with pytest.raises(SystemExit):
        study("mesh_places").main()
    assert "cube, corner" in capsys.readouterr().err
