"""The table of what biotac_like's assumed numbers do."""

import importlib.util
from pathlib import Path

import pytest

from thermograsp.thermal.stack import heated_stack

_SPEC = importlib.util.spec_from_file_location(
    "fingertip_ranges", Path(__file__).parents[3] / "studies/sensors/fingertip_ranges.py"
)
assert _SPEC is not None and _SPEC.loader is not None
STUDY = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(STUDY)
cases, falls_of = STUDY.cases, STUDY.falls_of


def test_fluid_and_skin_decide_when_the_reading_falls() -> None:
    sensor, known = heated_stack("biotac_like"), cases()
    usual = falls_of(sensor, "aluminium")
    assert usual[:3] == pytest.approx([0.12, 1.01, 2.18], abs=0.01)  # as docs/validation.md says
    for name in ("fluid 1.5 mm", "skin 2.5 mm"):
        assert falls_of(known[name](sensor), "aluminium")[0] < 0.1 * usual[0]
    for name in ("core's capacity 3000", "core's loss 40"):
        assert falls_of(known[name](sensor), "aluminium") == pytest.approx(usual, rel=0.05)


def test_metal_takes_more_than_wood_whatever_is_assumed() -> None:
    sensor = heated_stack("biotac_like")
    for change in cases().values():
        metal, wood = (falls_of(change(sensor), name)[2] for name in ("aluminium", "wood"))
        assert metal > 1.5 * wood
