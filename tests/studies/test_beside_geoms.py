"""Meshes beside the geoms that they stand for: the study's own lines."""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

FOLDER = str(Path(__file__).parents[2] / "studies" / "meshes")


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, FOLDER)
    yield importlib.import_module("beside_geoms")
    sys.path.remove(FOLDER)
    del sys.modules["beside_geoms"]


def test_a_block_and_a_ball_are_felt_as_their_meshes(
    study: ModuleType, capsys: pytest.CaptureFixture
) -> None:
    study.main(["block", "ball", "--seconds", "0.3", "--json"])
    found = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert len(found) == len(study.TOUCHES["block"]) + len(study.TOUCHES["ball"])
    for touch in found:
        assert touch["geom"][1] > 0.2
        assert touch["mesh"] == pytest.approx(touch["geom"], rel=0.04)


def test_an_ellipsoid_is_felt_as_its_mesh_also_between_its_axes(
    study: ModuleType, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where a view of the mesh is near: 0.0589 W/K at 45 degrees by the nearest axis, 0.0207 of the mesh."""
    monkeypatch.setitem(study.TOUCHES, "ellipsoid", ((0.0, 0.0), (10.0, None), (45.0, None), (90.0, 0.0)))
    study.main(["ellipsoid", "--seconds", "0.3", "--json"])
    for touch in map(json.loads, capsys.readouterr().out.splitlines()):
        assert touch["geom"] == pytest.approx(touch["mesh"], rel=0.06)


def test_an_unknown_solid_is_named(study: ModuleType, capsys: pytest.CaptureFixture) -> None:
    with pytest.raises(SystemExit):
        study.main(["torus"])
    assert "torus" in capsys.readouterr().err
