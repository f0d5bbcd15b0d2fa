"""An even patch beside finite volumes of a round body's contact, place by place."""

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


@pytest.mark.parametrize("name", ["copper", "aluminium", "glass", "wood"])
@pytest.mark.parametrize("cylinder", [False, True])
@pytest.mark.parametrize("radius", [0.004, 0.02])
def test_under_a_skin_heat_takes_the_gas_beside_the_contact_too(
    name: str, cylinder: bool, radius: float
) -> None:
    """At any force. A patch as wide as the mean of what touches and the gas had 75 % more at the lightest, and a third
    less at the others as a patch of what touches."""
    for force in (0.003, 0.3, 30.0):
        row = STUDY["compared"](name, radius, force, cylinder, "filled_silicone")
        assert row["even"] == pytest.approx(row["placed"], rel=0.16)
        assert row["even"][1:] == pytest.approx(row["placed"][1:], rel=0.085)
