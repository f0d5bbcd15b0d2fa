"""ThermalTouch beside finite volumes driven with the conductances that it recorded: the bounds of docs/plugin.md."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, str(ROOT / "studies" / "scenes"))
    yield importlib.import_module("touch_volumes")
    sys.path.remove(str(ROOT / "studies" / "scenes"))
    del sys.modules["touch_volumes"]


def test_an_evenly_touched_element_ends_where_a_chain_of_resistances_does(study: ModuleType) -> None:
    """The volumes themselves, by a closed form: an element on a body of its own width that holds very much heat."""
    half = study.face(1.0)
    tip = study.body(study.element(half, half, 1.0))
    endless = study.Grid((np.linspace(0, 1e-5, 3), half, half), np.full(2, 1e4), np.full(2, 1e15))
    found = study.by_volumes(
        [tip], [study.body(endless)], [study.Joint(0, 0, False)], np.full((3000, 1), 0.05), 1
    )
    early, middle, late = found[[199, 399, 599], 0]
    settled = (early * late - middle**2) / (early + late - 2 * middle)  # of one exponential that is left
    area = 4 * study.HALF**2
    layers = [layer.thickness / (layer.conductivity * area) for layer in study.STACK.layers]
    expected = (study.WARM - study.COOL) * layers[study.STACK.sensed] / (sum(layers) + 1 / 0.05)
    assert settled == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(
    ("scene", "made_of", "bound"),
    [
        ("three", "glass", 0.05),
        ("shared", "glass", 0.05),
        ("regrasp", "aluminium", 0.05),
        ("curved", "aluminium", 0.05),
        ("chatter", "aluminium", 0.06),
        ("chatter", "glass", 0.05),
    ],
)
def test_a_scene_keeps_what_the_docs_tell(study: ModuleType, scene: str, made_of: str, bound: float) -> None:
    """K."""
    found = study.judged(scene, made_of)
    assert found.grid_error < 0.1
    assert found.error < bound
    assert found.changes >= 1
