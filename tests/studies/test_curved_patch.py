"""An even patch beside finite volumes of a ball's contact on a bare face, place by place."""

from __future__ import annotations

import runpy
from pathlib import Path

import numpy as np
import pytest

STUDY = runpy.run_path(str(Path(__file__).parents[2] / "studies" / "contact" / "curved_patch.py"))


@pytest.mark.parametrize("name", ["steel", "glass"])
def test_drops_are_those_of_a_conductance_place_by_place(name: str) -> None:
    """A ball of 20 mm at 10 N; the largest difference to 4 s, of 12 K. The whole face as a patch is off by 0.2 K."""
    row = STUDY["compared"](name, 0.02, 10.0)
    placed, even = np.array(row["placed"]), np.array(row["even"])
    assert placed[-1] > 0.9
    assert np.abs(placed - even).max() < 0.05
