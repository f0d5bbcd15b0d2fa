"""Straight fingertips that lean on a flat face: the springs' own closed form, and what docs/plugin.md says of them."""

from __future__ import annotations

import importlib
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from thermograsp.thermal import cylinder_contact

ROOT = Path(__file__).parents[2]
COARSE = 5e-5
"""m, sides of the springs' cells."""


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, str(ROOT / "studies" / "scenes"))
    yield importlib.import_module("leaning")
    sys.path.remove(str(ROOT / "studies" / "scenes"))
    del sys.modules["leaning"]


def test_level_springs_bear_what_a_cylinder_on_a_pad_does(study: ModuleType) -> None:
    """The closed form knows square pads: the line's load counts, of the pad's length."""
    pad = study.leant("cylinder", None, "glass", 10.0, 0.0)._pads[0]
    found, long = study.springs(pad, 10.0, 0.0, cell=COARSE), pad.size.max()
    sheet = pad.silicone
    expected = cylinder_contact(sheet, np.array(10.0 * sheet.width / long), study.RADIUS)
    assert found.force_N == pytest.approx(10.0 * sheet.face / long, rel=0.01)
    assert found.force_N == pytest.approx(float(expected.face_force), rel=0.01)
    assert found.area_m2 == pytest.approx(float(expected.face), rel=0.04)


def test_a_line_that_touches_with_its_end_alone_bears_strips_of_growing_depth(study: ModuleType) -> None:
    """Summed over the line, 4/3 k sqrt(2 R) slope^1.5 l^2.5/2.5 is the force (touch/contacts/tilt.py), l in contact."""
    pad, slope = study.leant("cylinder", None, "glass", 10.0, 0.0)._pads[0], 0.05
    stiffness = pad.silicone.foundation_modulus / pad.silicone.thickness
    reach = pad.size.max() / 2 + pad.stack.width / 2  # to the face's far end
    force = 4 / 3 * stiffness * math.sqrt(2 * study.RADIUS) * slope**1.5 * reach**2.5 / 2.5
    near = (pad.size.max() - pad.stack.width) / 2
    found = study.springs(pad, force, slope, cell=COARSE)
    assert found.force_N == pytest.approx(force * (1 - near / reach) ** 2.5, rel=0.03)


@pytest.mark.parametrize("tip", ["capsule", "cylinder"])
@pytest.mark.parametrize(("degrees", "drop"), [(0.0, 4.6), (3.0, 4.6), (4.0, 3.2), (5.0, 1.3), (6.5, 0.1)])
def test_the_face_bears_what_springs_less_the_zone_do(
    study: ModuleType, tip: str, degrees: float, drop: float
) -> None:
    """K on aluminium as docs/plugin.md has it."""
    found = study.row(tip, None, "aluminium", degrees, cell=COARSE)
    assert found.drop_K == pytest.approx(drop, abs=0.06)
    assert found.touch.force_N == pytest.approx(found.less_zone.force_N, abs=0.05)
    assert found.touch.area_m2 == pytest.approx(found.less_zone.area_m2, rel=0.03, abs=1e-9)


def test_the_zone_costs_what_the_docs_say(study: ModuleType) -> None:
    drops = [
        study.row("capsule", None, "aluminium", degrees, cell=COARSE).without_zone_K
        for degrees in (1.0, 2.0, 3.0)
    ]
    assert drops == pytest.approx([3.6, 1.5, 0.4], abs=0.06)


@pytest.mark.parametrize(("degrees", "bound"), [(0.0, 0.75), (4.0, 0.05)])
def test_under_a_skin_springs_beside_the_face_bear_a_part_of_a_level_one(
    study: ModuleType, degrees: float, bound: float
) -> None:
    """N."""
    found = study.row("capsule", "filled_silicone", "aluminium", degrees, cell=COARSE)
    assert 0.0 < abs(found.touch.force_N - found.less_zone.force_N) < bound


@pytest.mark.parametrize(
    "bad", [["--force", "0"], ["--force", "nan"], ["--angles", "80"], ["--seconds", "-1"]]
)
def test_what_would_never_touch_is_refused(study: ModuleType, bad: list[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        study.main(bad)
