"""`thermograsp identify`."""

import argparse
import json
from pathlib import Path

import numpy as np
import pytest

from thermograsp import thermal
from thermograsp.cli import identify, main
from thermograsp.columns import read_csv, write_csv

AMONG = "--among cotton plastic glass aluminium"


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A press on glass, touched at 0.5 s of the file's clock, as a converter reports it."""
    file = tmp_path_factory.mktemp("identify") / "touch.csv"
    press = thermal.press("glass", conductance=5e3, seconds=3.0, dt=0.01, tolerance=0.005)
    drop = np.concatenate((np.zeros(50), press.temperature_drop))[None]
    noise = np.random.default_rng(0).standard_normal(drop.shape)
    _, voltage = thermal.measure(thermal.ADS1115, thermal.settled(np.zeros(1), 1e-3), drop, 1e-3, 0.01, noise)
    write_csv(file, {"time_s": np.arange(drop.shape[1]) * 0.01, "voltage_V": voltage[0]})
    return file


@pytest.mark.slow
def test_a_recording_is_identified(recording: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = recording.with_name("touch.svg")
    assert main(f"identify {recording} {AMONG} --out {picture} --json".split()) == 0
    summary = json.loads(capsys.readouterr().out)
    assert (summary["verdict"], summary["best"]) == ("material", "glass")
    assert summary["touch_s"][0] == pytest.approx(0.5, abs=0.005)
    assert sum(summary["probability"].values()) == pytest.approx(1)
    low, high = summary["effusivity_90_Ws05_m2K"]
    assert low < thermal.material("glass").effusivity < high
    assert "effusivity" in picture.read_text(encoding="utf-8")


def test_a_part_of_it_tells_less(recording: Path, capsys: pytest.CaptureFixture[str]) -> None:
    widths = []
    for until in (1.0, 3.5):
        assert main(f"identify {recording} {AMONG} --until {until} --json".split()) == 0
        low, high = json.loads(capsys.readouterr().out)["effusivity_90_Ws05_m2K"]
        widths.append(np.log(high / low))
    assert widths[1] < widths[0]


def test_says_for_people_why_it_cannot_tell(recording: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(f"identify {recording} {AMONG} --until 0.4".split()) == 1
    assert "shows no touch" in capsys.readouterr().out
    assert main(f"identify {recording} --among cotton aluminium".split()) == 1
    assert "none of the materials" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("content", "more", "words"),
    [
        ("time_s,voltage_V\n", "", "no rows"),
        ("time_s,current_A\n0,1\n", "", "voltage_V"),
        ("time_s,voltage_V\n0\n", "", "row 2: 1 cells"),
        ("time_s,voltage_V, voltage_V\n0,1,2\n", "", "two columns are named 'voltage_V'"),
        ("time_s,voltage_V\n0,\n", "", "no sample"),
        ("time_s,voltage_V\n0,0\n0,0\n", AMONG, "must increase"),
        ("time_s,voltage_V\n0,0\n", "--among gold glas", "did you mean"),
        ("time_s,voltage_V\n0,0\n", "--out x.txt", "must end with"),
        ("time_s,voltage_V\n0,0\n1,0\n", f"{AMONG} --touch 99", "99 s is not before the last sample, at 1 s"),
        (
            "time_s,voltage_V\n0,0.3\n1,0.3\n2,0.3\n",
            AMONG,
            "every sample is at an end of the converter's range",
        ),
        ("time_s,voltage_V\n0,0\n", "--conductance 5 1", "conductance must be"),
    ],
)
def test_bad_input_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], content: str, more: str, words: str
) -> None:
    file = tmp_path / "bad.csv"
    file.write_text(content, encoding="utf-8")
    assert main(f"identify {file} {more}".split()) == 2
    assert words in capsys.readouterr().err


def test_a_missing_file_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["identify", "nowhere.csv"]) == 2
    assert "cannot read nowhere.csv: No such file or directory" in capsys.readouterr().err


@pytest.mark.slow
def test_a_grasp_is_identified(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Both fingertips, a force that grows, two touches at different times, a model of tolerance 0.05 K."""
    pytest.importorskip("mujoco")
    file = tmp_path / "grasp.csv"
    main(f"grasp --material marble --seconds 4 --csv {file} --json".split())
    capsys.readouterr()
    among = " ".join(thermal.SEED_MATERIALS)
    assert main(f"identify {file} --among {among} --json".split()) == 0
    summary = json.loads(capsys.readouterr().out)
    assert "marble" in summary["likely"][:2] and len(summary["likely"]) <= 3
    assert len(summary["touch_s"]) == 2
    assert summary["samples"] == 800 - 2 * 6  # without those in which the contacts opened, 60 ms each
    low, high = summary["effusivity_90_Ws05_m2K"]
    assert low < thermal.material("marble").effusivity < high


def test_csv_files_come_back(tmp_path: Path) -> None:
    columns = {"time_s": np.arange(3.0), "voltage_V": np.array([1e-9, np.nan, -2.5])}
    write_csv(tmp_path / "a.csv", columns)
    read = read_csv(tmp_path / "a.csv")
    assert list(read) == list(columns)
    for name, values in columns.items():
        np.testing.assert_array_equal(read[name], values)


def test_defaults_are_those_of_the_setup() -> None:
    parser = argparse.ArgumentParser()
    identify.add_arguments(parser)
    setup = identify._setup(parser.parse_args(["touch.csv"]), 1)
    assert setup == thermal.TouchSetup()
    assert identify._setup(parser.parse_args(["touch.csv"]), 2).object_size == (0.04, 0.04, 0.04)
