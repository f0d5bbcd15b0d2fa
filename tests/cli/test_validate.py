"""`thermograsp validate`."""

import json
from pathlib import Path

import numpy as np
import pytest

from thermograsp.cli import main


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """Three runs on glass, nothing of which looks like a touch."""
    t = np.linspace(-1, 3, 101)
    heated = 29.5 + 0.0 * t + np.zeros((3, 1)) + 0.01 * np.arange(3)[:, None] * (t > 0)
    file = tmp_path / "own.npz"
    np.savez(
        file,
        time_s=t,
        heated_degC=heated,
        passive_degC=np.full_like(heated, 22.0),
        force_N=np.broadcast_to(np.clip(2 + 2 * t, 0, 4), heated.shape),
        run=np.arange(3),
        material=np.array(["glass"] * 3),
    )
    return file


def test_the_shipped_touches_are_all_predicted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "validation.svg"
    assert main(f"validate --json --plot {picture}".split()) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["predicted"] == len(summary["touches"]) == 180
    assert [(p["runs"], p["label"]) for p in summary["parts"]][:2] == [
        ("runs up to 12", "cold_wood"),
        ("runs up to 12", "metal"),
    ]
    text = picture.read_text(encoding="utf-8")
    assert "cold wood" in text and "later runs" in text


def test_a_file_of_ones_own(recording: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["validate", str(recording), "--sample", "glass=glass@21.5"]) == 0
    assert "all runs, glass" in capsys.readouterr().out
    assert main(["validate", str(recording), "--split", "0", "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert {part["runs"] for part in summary["parts"]} == {"runs up to 0", "later runs"}
    assert summary["touches"][0]["sample_degC"] == 22.0


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("--split 9", "leaves all runs on one side"),
        ("--sensor seed", "unknown heated sensor 'seed'"),
        ("--sample clay", "give LABEL=MATERIAL"),
        ("--plot x.txt", ".svg"),
    ],
)
def test_what_cannot_be_is_refused(
    recording: Path, more: str, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(f"validate {recording} {more}".split()) == 2
    assert message in capsys.readouterr().err


def test_files_that_cannot_be_end_with_status_2_and_say_why(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    content = dict(np.load(recording))
    unknown = tmp_path / "unknown.npz"
    np.savez(unknown, **{**content, "material": np.array(["unobtainium"] * 3)})
    grams = tmp_path / "grams.npz"
    np.savez(grams, **{**content, "force_N": 102 * content["force_N"]})
    cut = tmp_path / "cut.npz"
    cut.write_bytes(recording.read_bytes()[:-40])
    for file, message in (
        (unknown, "unknown material 'unobtainium'"),
        (grams, "must be in N"),
        (cut, "cut short"),
        (tmp_path, "directory"),
    ):
        assert main(["validate", str(file)]) == 2
        assert message in capsys.readouterr().err
