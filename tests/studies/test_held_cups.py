"""How a cup's wall is felt: the thinner, the less."""

import json
import runpy
import sys
from pathlib import Path

import pytest

STUDY = Path(__file__).parents[2] / "studies" / "meshes" / "held_cups.py"


def test_the_thinner_the_wall_the_less_it_is_felt(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", [str(STUDY), "--json"])
    runpy.run_path(str(STUDY), run_name="__main__")
    solid, thick, thin = json.loads(capsys.readouterr().out).values()
    assert solid[-1] > thick[-1] + 0.1 and thick[-1] > thin[-1] + 0.9
    assert solid[0] == pytest.approx(thick[0], abs=0.02)
