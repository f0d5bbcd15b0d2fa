"""The springs that a mesh's tables are compared with, beside closed forms; a table beside them."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from thermograsp.thermal import cylinder_contact
from thermograsp.thermal.contact import skinned

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, str(ROOT / "studies" / "contact"))
    yield importlib.import_module("pressed_meshes")
    sys.path.remove(str(ROOT / "studies" / "contact"))
    del sys.modules["pressed_meshes"]


def test_point_by_point_a_rod_is_touched_as_the_closed_form_s_cylinder(study: ModuleType) -> None:
    sheet = skinned(study.PAD, study.SKIN)
    expected = cylinder_contact(sheet, np.array(study.FORCE_N), 0.01, 0.05)
    pressure = study.pressures("rod", 0.0, 0.0)
    met = study.direct(pressure, 0.0, 0.02)
    borne = pressure.mean() * study.PAD.face**2
    assert borne == pytest.approx(float(expected.face_force), rel=0.02)
    assert met.area == pytest.approx(float(expected.face), rel=0.08)  # facets of .35 mm, points of .05 mm
    assert met.long == pytest.approx(study.PAD.face, rel=0.01)


def test_a_table_makes_a_rod_as_cold_as_its_springs_and_the_gas_beside_them(study: ModuleType) -> None:
    """The springs have no gas beside what touches, through which a skin lets heat pass as well: by finite volumes
    (studies/contact/curved_patch.py --skin) a tenth more on metals."""
    row = study.row("rod", 0.0, 0.0)
    assert row.drop[0] > 9.0
    assert 0.0 < row.drop[1] - row.drop[2] < 0.13 * row.drop[2]
