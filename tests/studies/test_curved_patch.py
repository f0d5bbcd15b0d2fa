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


@pytest.mark.parametrize(
    ("name", "force", "cylinder", "most"),
    [
        ("glass", 10.0, False, 0.06),  # touches 7.7 mm2: as a patch, .28 K less
        ("wood", 1.0, False, 0.02),
        ("aluminium", 10.0, False, 0.05),
        ("glass", 1.0, True, 0.11),  # .42 K less
        ("wood", 20.0, True, 0.06),
    ],
)
def test_under_a_skin_heat_takes_the_gas_beside_the_contact_too(
    name: str, force: float, cylinder: bool, most: float
) -> None:
    """After a second, on 20 mm."""
    row = STUDY["compared"](name, 0.02, force, cylinder, "filled_silicone")
    assert row["even"][1] == pytest.approx(row["placed"][1], abs=most)
