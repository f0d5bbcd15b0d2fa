"""`thermograsp objects` lists the library, and `thermograsp grasp --object` takes from it."""

import json

import pytest

from thermograsp.cli import main
from thermograsp.envs import objects


def test_the_list_is_the_library(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["objects", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["objects"]
    assert [row["name"] for row in rows] == list(objects())
    can = next(row for row in rows if row["name"] == "cold_can")
    assert (
        can["temperature_degC"] == 5.0 and can["material"] == "aluminium" and can["contents"] == "water_gel"
    )
    assert can["width_m"] == pytest.approx(0.0662, abs=1e-4) and 0.3 < can["mass_kg"] < 0.4
    assert main(["objects", "dice", "mug"]) == 0
    assert capsys.readouterr().out.count("\n") == 4
    assert main(["objects", "mugg"]) == 2
    assert "did you mean 'mug'" in capsys.readouterr().err


def test_an_object_is_grasped_by_name(capsys: pytest.CaptureFixture[str]) -> None:
    assert main("grasp --object butter --seconds 4.5 --json".split()) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["object"] == "butter" and summary["material"] == "butter" and summary["success"]
    assert summary["final"]["object_temperature_degC"] < 8.0
    assert summary["final"]["force_left_N"] == pytest.approx(objects()["butter"].grip_force, rel=0.02)


@pytest.mark.parametrize("more", ["--width 0.05", "--mesh cup.stl", "--shape sphere --height 0.03"])
def test_its_shape_is_its_own(more: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["grasp", "--object", "dice", *more.split()]) == 2
    assert f"leave out {more.split()[0]}" in capsys.readouterr().err
