"""`thermograsp materials`."""

import json
from pathlib import Path

import pytest

from thermograsp import thermal
from thermograsp.cli import main

TABLE = """
[sources]
guess = "A guess"
[materials.soap]
family = "food"
conductivity = { value = 0.3, unit = "W/(m K)", source = "guess" }
density = { value = 1000, unit = "kg/m3", source = "guess" }
specific_heat = { value = 1800, unit = "J/(kg K)", source = "guess" }
"""


def test_json_holds_all_in_si(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["materials", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)["materials"]
    assert {one["name"] for one in listed} == set(thermal.materials())
    effusivities = [one["effusivity_Ws05_m2K"] for one in listed]
    assert effusivities == sorted(effusivities)
    glass = next(one for one in listed if one["name"] == "glass")
    assert glass["conductivity_W_mK"] == thermal.material("glass").conductivity
    assert set(glass["sources"]) >= {"conductivity", "density", "specific_heat"}


def test_a_comparison_names_its_sources(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["materials", "aluminium", "glass"]) == 0
    out = capsys.readouterr().out
    assert out.index("\nglass ") < out.index("\naluminium ")
    for name in ("glass", "aluminium"):
        for citation in thermal.material(name).sources.values():
            assert citation in out
    assert "cotton" not in out


def test_ones_own_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = tmp_path / "own.toml"
    table.write_text(TABLE)
    assert main(["materials", "--materials", str(table), "--sort", "name", "--json"]) == 0
    assert [one["name"] for one in json.loads(capsys.readouterr().out)["materials"]] == ["soap"]
    assert main(["press", "soap", "--materials", str(table), "--seconds", "1", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["material"] == "soap"
    assert main(["press", "glass", "--materials", str(table)]) == 2
    assert "known: soap" in capsys.readouterr().err
