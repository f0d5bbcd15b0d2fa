"""The pad around the sensor in three dimensions, beside the discs that stand for both in the tables of the docs."""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from thermograsp.thermal import press

pytest.importorskip("skfem")
ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, str(ROOT / "studies" / "surround"))
    yield importlib.import_module("pad_square")
    sys.path.remove(str(ROOT / "studies" / "surround"))
    for name in ("pad_square", "pad_heat"):
        sys.modules.pop(name, None)


def test_squares_change_the_drop_a_little_more_than_discs(study: ModuleType) -> None:
    """Of glass; and without a pad the elements have the drop of the semi-analytic solution."""
    touch = study.Touch("glass", conductances=(1e4, 1e4))
    alone, padded = (study.drops(one, refine=0.8) for one in (touch.alone, touch))
    table = json.loads((ROOT / "tests" / "data" / "press_3d.json").read_text())["cases"]["glass/10000/T"]
    known = [table["Td"][table["t"].index(t)] for t in study.TIMES[:3]]
    np.testing.assert_allclose(alone[:3], known, atol=0.02)
    discs = study.pad_heat.drops(touch) - study.pad_heat.drops(touch.alone)
    assert (padded - alone < discs).all()
    np.testing.assert_allclose(padded - alone, discs, atol=0.04)


@pytest.mark.parametrize(
    ("name", "skin"),
    [("stainless_steel", None), ("glass", "filled_silicone"), ("aluminium", "filled_silicone")],
)
def test_a_press_with_a_surround_has_this_drop(study: ModuleType, name: str, skin: str | None) -> None:
    """The bound of the network and the grid's error of these elements."""
    touch = study.Touch(name, skin, conductances=(1e4, 1e4))
    padded = study.drops(touch, refine=0.8)
    pressed = press(
        name,
        skin=skin,
        surround="silicone",
        conductance=1e4,
        surround_conductance=1e4,
        dt=0.05,
        tolerance=0.045,
    )
    found = pressed.temperature_drop[np.round(np.array(study.TIMES) / 0.05).astype(int)]
    np.testing.assert_allclose(found, padded, atol=0.06)
    alone = press(name, skin=skin, conductance=1e4, dt=0.05).temperature_drop[-1]
    assert abs(alone - padded[-1]) > 0.07
