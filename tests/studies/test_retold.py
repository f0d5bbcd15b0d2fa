"""One touch told in several ways: what docs/plugin.md says of them."""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

FOLDER = str(Path(__file__).parents[2] / "studies" / "scenes")


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, FOLDER)
    yield importlib.import_module("retold")
    sys.path.remove(FOLDER)
    del sys.modules["retold"]


@pytest.mark.parametrize(
    ("case", "drops"),
    [
        ("seam", (9.9, 9.9, 9.9, 9.9, 9.84)),
        ("leaning", (9.9, 5.9, 5.6, 9.9, 5.8)),
        ("capsule", (5.9, 7.9, 9.9, 5.9, 6.4)),
        ("overlap", (9.9, 10.5, 10.5)),
        ("edge", (5.8, 7.4)),
    ],
)
def test_aluminium_is_felt_as_the_docs_have_it(
    study: ModuleType, case: str, drops: tuple[float, ...]
) -> None:
    (row,) = study.CASES[case]("aluminium")
    assert tuple(row.drops_K.values()) == pytest.approx(drops, abs=0.06)


@pytest.mark.parametrize("material", ["aluminium", "glass", "wood"])
def test_a_round_fingertip_on_a_block_feels_what_a_flat_one_does_on_such_a_body(
    study: ModuleType, material: str
) -> None:
    for row in study.swapped(material):
        one, other = row.drops_K.values()
        assert other == pytest.approx(one, rel=0.02)


def test_two_that_pinch_a_sheet_feel_what_one_does_on_half_of_it(study: ModuleType) -> None:
    """A wide pad, a narrow one and a ball."""
    for row in study.pinch("glass"):
        one, two = row.drops_K.values()
        assert two == pytest.approx(one, abs=0.01)


def test_the_order_of_fingertips_counts_aside_of_their_middles(
    study: ModuleType, capsys: pytest.CaptureFixture
) -> None:
    study.main(["--cases", "order", "--json"])
    rows = json.loads(capsys.readouterr().out)
    apart = [abs(one - other) for one, other in (row["drops_K"].values() for row in rows)]
    assert max(apart[::3]) < 1e-3
    assert max(apart) < 0.4


def test_an_unknown_case_is_named(study: ModuleType, capsys: pytest.CaptureFixture) -> None:
    with pytest.raises(SystemExit):
        study.main(["--cases", "torus"])
    assert "torus" in capsys.readouterr().err
