"""The table of docs/plugin.md: what an object's own shape changes, beside a grid that is fine at the place."""

from __future__ import annotations

import runpy
from pathlib import Path


def test_a_thin_bottle_is_felt_as_the_fine_grid_says_and_not_as_a_box() -> None:
    study = runpy.run_path(str(Path(__file__).parents[2] / "studies" / "meshes" / "own_shapes.py"))
    found = study["row"]("pill_bottle", "ceramic", 5000.0, 10.0)
    assert abs(found["own_shape_K"] - found["press_K"]) < 0.04
    assert found["box_K"] - found["press_K"] > 1.5
