"""What a step costs by what is held: the study runs."""

import json
import runpy
import sys
from pathlib import Path

import pytest

STUDY = Path(__file__).parents[2] / "studies" / "speed" / "held_objects.py"


def test_each_object_has_a_time(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(sys, "argv", [str(STUDY), "--blocks", "1", "--json"])
    runpy.run_path(str(STUDY), run_name="__main__")
    found = json.loads(capsys.readouterr().out)
    assert set(found) == {"box", "cylinder", "sphere"}
    assert all(0 < time < 1e5 for ways in found.values() for time in ways.values())
