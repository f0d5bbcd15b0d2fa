"""`thermograsp bench --from`: an earlier run is printed and drawn again, and nothing is measured."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from thermograsp import cli
from thermograsp.bench import provenance
from thermograsp.bench.peer import measure
from thermograsp.cli.bench import BENCHMARKS


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    """A made-up record of two plates."""
    plates = [
        {
            "plate": name,
            "exact": exact,
            "column": [exact] * 3,
            "slab": [exact] * 3,
            "soft": [exact] * 3,
            "peer": [exact + 3.0, exact, exact - 1.0],
            "first_millimetre": exact + 2.0,
            "heat": [3e4, 3e4],
        }
        for name, exact in (("wood", 32.0), ("aluminium", 25.0))
    ]
    record = {
        "published_by": "nobody",
        "times_s": [0.1, 1.0, 5.0],
        "tip_C": 36.0,
        "plate_C": 24.0,
        "plates": plates,
        "peer_first_millimetre": {"wood": 35.0},
        "peer_heat_J_per_m2": {"aluminium": 1e4},
    }
    path = tmp_path / "peer.json"
    path.write_text(json.dumps({"provenance": provenance(7), "quick": False, "peer": record}))
    return path


def test_a_label_changes_without_measuring_again(
    saved: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(measure, "touches", lambda: pytest.fail("measured"))
    saved.write_text(saved.read_text().replace('"wood"', '"oak"'))
    assert cli.main(["bench", "peer", "--from", str(saved), "--out", str(tmp_path / "drawn")]) == 0
    drawn = tmp_path / "drawn"
    assert {file.name for file in drawn.iterdir()} == {"peer.png", "peer.svg"}
    assert ">oak<" in (drawn / "peer.svg").read_text(encoding="utf-8")
    printed = capsys.readouterr().out
    assert "oak: 34.00, peer 35.00" in printed and "seed 7" in printed


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["speed"], "holds no record of speed, but of ['peer']"),
        (["peer", "--quick"], "leave out --quick"),
        (["--seed", "1"], "leave out --quick and --seed"),
    ],
)
def test_what_makes_no_sense_with_a_record_is_refused(
    saved: Path, arguments: list[str], complaint: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["bench", *arguments, "--from", str(saved), "--out", str(saved.parent / "drawn")]) == 2
    assert complaint in capsys.readouterr().err
    assert not (saved.parent / "drawn").exists()


@pytest.mark.parametrize("content", ["", "[1]", '{"peer": {}}', '{"provenance": {}}'])
def test_a_file_that_bench_did_not_write_is_refused(
    content: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "it.json").write_text(content)
    assert cli.main(["bench", "--from", str(tmp_path / "it.json"), "--out", str(tmp_path)]) == 2
    assert "give a file that bench wrote" in capsys.readouterr().err


def test_drawing_and_printing_load_nothing_that_measures() -> None:
    modules = [
        f"thermograsp.{part}" for name in BENCHMARKS for part in (f"bench.{name}.figure", f"cli.bench.{name}")
    ]
    code = (
        f"import importlib, sys; [importlib.import_module(name) for name in {modules!r}]; "
        "print([name for name in sys.modules if name in ('mujoco', 'numba', 'scipy') "
        "or name.startswith('thermograsp.bench') and name.endswith('measure')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
