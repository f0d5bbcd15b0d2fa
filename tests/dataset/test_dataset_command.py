"""`thermograsp dataset`."""

import json
from pathlib import Path

import pytest

from thermograsp import dataset
from thermograsp.cli import main
from thermograsp.dataset.shards import read_plan
from thermograsp.thermal import material
from thermograsp.thermal.matter.materials import UNITS

pytest.importorskip("pyarrow")


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    line = [
        "dataset",
        "--episodes",
        "3",
        "--shard",
        "2",
        "--out",
        str(tmp_path / "d"),
        "--material",
        "glass",
        "wood",
    ]
    assert main([*line, "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert (summary["episodes"], summary["shards"], summary["found"]) == (3, 2, 0)
    assert main(line) == 0
    shown = capsys.readouterr()
    assert "2 of them found done" in shown.out and shown.err == ""
    assert set(dataset.load(tmp_path / "d", ["material"])["material"]) <= {"glass", "wood"}
    assert main([*line, "--mode", "O"]) == 2
    assert "its mode is T, not O" in capsys.readouterr().err
    assert main([*line, "--set", "tolerance=0.1"]) == 2
    assert "its keyword tolerance is left out, not 0.1" in capsys.readouterr().err
    assert main([*line, "--set", "tolerance"]) == 2
    assert "--set takes NAME=VALUE" in capsys.readouterr().err
    for wrong in (["dataset"], ["dataset", "--episodes", "1", "--name", "x-v0"]):
        assert main([*wrong, "--out", str(tmp_path / "e")]) == 2
    assert not (tmp_path / "e").exists()


def test_the_command_with_materials_of_ones_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    entry = {name: (getattr(material("glass"), name), unit) for name, unit in UNITS.items()}
    entry["conductivity"] = (5.0, "W/(m K)")
    lines = [f'{name} = {{ value = {v}, unit = "{u}", source = "s" }}' for name, (v, u) in entry.items()]
    (tmp_path / "own.toml").write_text(
        "\n".join(['[sources]\ns = "me"\n[materials.own]', *lines]), encoding="utf-8"
    )
    line = [
        "dataset",
        "--episodes",
        "1",
        "--out",
        str(tmp_path / "d"),
        "--materials",
        str(tmp_path / "own.toml"),
    ]
    assert main(line) == 2
    assert "--materials needs --material" in capsys.readouterr().err
    assert main([*line, "--material", "own"]) == 0
    assert read_plan(tmp_path / "d").materials[0].conductivity == 5.0
    assert dataset.load(tmp_path / "d")["material"].tolist() == ["own"]
