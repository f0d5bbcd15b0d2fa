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


def test_an_unknown_solid_is_named(study: ModuleType, capsys: pytest.CaptureFixture) -> None:
    with pytest.raises(SystemExit):
        study.main(["torus"])
    assert "torus" in capsys.readouterr().err
