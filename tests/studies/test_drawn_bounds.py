"""What anybody could do: the study counts, and the teacher stays below its bound."""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def study() -> Iterator[ModuleType]:
    sys.path.insert(0, str(ROOT / "studies" / "agents"))
    yield importlib.import_module("drawn_bounds")
    sys.path.remove(str(ROOT / "studies" / "agents"))
    del sys.modules["drawn_bounds"]


def test_the_teacher_is_below_its_bound_and_later_is_surer(
    study: ModuleType, capsys: pytest.CaptureFixture[str]
) -> None:
    assert study.main(["--episodes", "60", "--examples", "500", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert 45 < found["taught"] <= found["liftable"] < 60
    right = list(found["right"].values())
    assert 0.3 < right[0] <= right[1] <= right[2] < 1
    forces = {name: list(shares.values()) for name, shares in found["forces"].items()}
    assert min(forces["nothing"][1:]) > 0.9  # from .5 s on
    assert 0.5 < max(forces["everything"]) <= found["liftable"] / 60
    with pytest.raises(SystemExit):
        study.main(["--episodes", "0"])
