"""`thermograsp device`, and the pages that tell of it."""

import json
import re
import shlex
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermograsp.cli import main
from thermograsp.cli.shared.live_plot import LivePlot, braille
from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.hardware import (
    DeviceModel,
    EmulatedFingertips,
    Flag,
    HeatersOff,
    LineFaults,
    PtyDevice,
    replay,
)
from thermograsp.hardware.emulators.planned_faults import plan_fault
from thermograsp.hardware.protocol import Check

from .serving import serving
from .test_fingertips import CONSTANTS, lockstep, ramp

pytest.importorskip("serial")

PAGE = (Path(__file__).parents[2] / "docs" / "hardware.md").read_text(encoding="utf-8")


@pytest.fixture
def served(tmp_path: Path) -> Iterator[PtyDevice]:
    with serving(tmp_path, EmulatedFingertips(ramp)) as device:
        yield device


def printed(capsys: pytest.CaptureFixture[str], *argv: str, status: int = 0) -> dict[str, Any]:
    """The JSON document of a command."""
    assert main([*argv, "--json"]) == status
    return json.loads(capsys.readouterr().out)


@pytest.mark.slow
def test_the_page_s_code_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    assert len(blocks) == 4
    for block in blocks:
        exec(compile(block, "hardware.md", "exec"), {})
    said = capsys.readouterr().out
    assert "mV at most" in said and "29.6 mm, stopped while closing" in said and "1.00 mV/K" in said


def test_the_page_s_commands_parse(capsys: pytest.CaptureFixture[str]) -> None:
    lines = re.findall(r"^    thermograsp (.*)$", PAGE, re.MULTILINE)
    assert len(lines) >= 8
    for line in lines:
        assert main([*shlex.split(line), "--help"]) == 0
    capsys.readouterr()


def test_list(capsys: pytest.CaptureFixture[str]) -> None:
    assert isinstance(printed(capsys, "device", "list")["ports"], list)
    assert main(["device", "list"]) == 0
    assert capsys.readouterr().out


def test_no_action_or_a_wrong_one_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["device"]) == 2
    assert main(["device", "fly"]) == 2
    assert "ACTION" in capsys.readouterr().err


def test_monitor_in_a_pipe(served: PtyDevice, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["device", "monitor", served.path, "--seconds", "0.3"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert re.fullmatch(r" +\S+ +-\S+ mV +36.00 +35.00 degC +5.00 +0.00 N", lines[0])
    assert "0 frames lost" in lines[-1]


def test_monitor_tells_a_line_that_breaks(served: PtyDevice, capsys: pytest.CaptureFixture[str]) -> None:
    plan_fault(served, f"unplug=60@{served.now + 0.3}")
    assert main(["device", "monitor", served.path, "--seconds", "0.6", "--json"]) == 1
    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert "plugged in" in lines[-1]["end"]["broken"]
    assert sum("broken" in line for line in lines) == 1  # said once, however long it lasts


def test_monitor_streams_every_sample_as_json(served: PtyDevice, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--json", "device", "monitor", served.path, "--seconds", "0.6"]) == 0
    *samples, last = (json.loads(line) for line in capsys.readouterr().out.splitlines())
    assert last["end"]["port"] == served.path and last["end"]["lost"] == 0
    assert len(samples) >= 20
    times = [sample["time_s"] for sample in samples]
    assert times == sorted(times) and all(set(sample) == set(samples[0]) for sample in samples)
    assert samples[0]["thermostat_degC"] == pytest.approx([36.0, 35.0], abs=0.1)


def test_a_stream_is_lines_of_json_whatever_happens(
    tmp_path: Path, served: PtyDevice, capsys: pytest.CaptureFixture[str]
) -> None:
    """Also where it cannot begin; and a number that is missing says why."""
    for line in (
        [str(tmp_path / "nothing")],
        [served.path, "--seconds", "nan"],
        [served.path, "--seconds", "-1"],
    ):
        assert main(["device", "monitor", *line, "--json"]) == 2
        (only,) = capsys.readouterr().out.splitlines()
        assert json.loads(only)["status"] == 2
    with served.paused():
        served.device.broken_converters.add(1)
    assert main(["device", "monitor", served.path, "--seconds", "0.4", "--json"]) == 0
    *samples, _ = (json.loads(line) for line in capsys.readouterr().out.splitlines())
    assert samples[-1]["voltage_V"][1] is None and samples[-1]["voltage_V"][0] is not None
    assert "NO_VOLTAGE_RIGHT" in samples[-1]["faults"]


def test_record_and_replay(served: PtyDevice, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, csv = str(tmp_path / "line.tgr"), tmp_path / "line.csv"
    seen = printed(
        capsys, "device", "record", served.path, file, "--seconds", "0.5", "--rate", "200", "--note", "hello"
    )
    assert seen["samples"] >= 90 and seen["lost"] == 0
    again = printed(capsys, "device", "replay", file, "--csv", str(csv))
    assert again["samples"] >= seen["samples"] and again["complete"]
    assert again["metadata"]["note"] == "hello"
    table = np.genfromtxt(csv, delimiter=",", names=True)
    samples = replay(file).samples
    assert len(table) == len(samples)
    np.testing.assert_allclose(table["voltage_left_V"], samples.voltage[:, 0], rtol=1e-8)
    np.testing.assert_allclose(table["time_s"], samples.time - samples.time[0], atol=1e-8)
    assert main(["device", "record", served.path, file, "--seconds", "0.1"]) == 2
    assert "exists" in capsys.readouterr().err


def test_record_through_a_bad_line_is_not_a_success(served: PtyDevice, tmp_path: Path) -> None:
    plan_fault(served, "drop_frame=0.2@0.5")
    file = str(tmp_path / "line.tgr")
    assert main(["device", "record", served.path, file, "--seconds", "0.8", "--json"]) == 1
    assert replay(file).counts.lost > 0


def test_a_record_that_ends_on_a_lost_line_is_not_a_success(served: PtyDevice, tmp_path: Path) -> None:
    """It has what came before, and was told as a success."""
    unplugging, file = threading.Timer(1.0, served.unplug), str(tmp_path / "unplugged.tgr")
    unplugging.start()
    assert main(["device", "record", served.path, file, "--seconds", "2.0"]) == 1
    unplugging.join()
    assert len(replay(file).samples) > 10


def test_record_leaves_no_file_where_there_is_no_device(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "line.tgr"
    assert main(["device", "record", str(tmp_path / "port"), str(file)]) == 2
    assert not file.exists()
    assert "no such port" in capsys.readouterr().err


def test_selftest(served: PtyDevice, capsys: pytest.CaptureFixture[str]) -> None:
    good = printed(capsys, "device", "selftest", served.path)
    assert good["good"] and good["protocol"] == "2.0" and good["samples"] >= 100
    plan_fault(served, "open_thermistor=left")
    bad = printed(capsys, "device", "selftest", served.path, status=1)
    assert bad["failed"] == ["LEFT_THERMISTOR"]
    assert bad["reset"] == ["POWER_ON"] and bad["heaters_off"] == []


def test_selftest_calls_good_only_what_was_checked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = DeviceModel(checks=Check.CONVERTER | Check.MEMORY)
    with serving(tmp_path, EmulatedFingertips(model=model)) as served:
        assert main(["device", "selftest", served.path]) == 0
        lines = dict(line.split(None, 1) for line in capsys.readouterr().out.splitlines() if line.strip())
        assert lines["converter"].strip() == "good" and lines["memory"].strip() == "good"
        assert lines["left_heater"].strip() == "not checked" == lines["load_cells"].strip()
        document = printed(capsys, "device", "selftest", served.path)
        assert document["checked"] == ["CONVERTER", "MEMORY"]
        assert document["heater_current_A"] == [None, None]


def test_clear_faults(served: PtyDevice, capsys: pytest.CaptureFixture[str]) -> None:
    with served.paused():
        served.device._plates.latched = HeatersOff.RUNAWAY_LEFT
    assert printed(capsys, "device", "clear-faults", served.path) == {"cleared": ["RUNAWAY_LEFT"], "left": []}
    assert not served.device._plates.latched
    assert main(["device", "clear-faults", served.path]) == 0
    assert "nothing was latched" in capsys.readouterr().out


def test_calibrate(served: PtyDevice, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ("device", "calibrate", served.path)
    assert printed(capsys, *command)["calibration"]["date"] == 0
    changed = printed(
        capsys, *command, "--set", "voltage_offset=20e-6,-10e-6", "--set", "force_gain=.05,0,0,0,0,.1"
    )
    assert served.device.calibration.voltage_offset == CONSTANTS.voltage_offset
    assert served.device.calibration.force_gain == CONSTANTS.force_gain
    file = tmp_path / "constants.json"
    file.write_text(json.dumps(changed))
    printed(capsys, *command, "--set", "voltage_offset=0,0")
    assert served.device.calibration.voltage_offset == (0.0, 0.0)
    loaded = printed(capsys, *command, "--load", str(file))["calibration"]
    assert {**loaded, "date": 0} == {**changed["calibration"], "date": 0}
    assert main(list(command)) == 0
    assert "voltage_offset     2e-05  -1e-05" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (["--set", "voltage_ofset=1,2"], "did you mean 'voltage_offset'"),
        (["--set", "voltage_offset=1"], "takes 2 numbers"),
        (["--set", "voltage_offset"], "NAME=NUMBER"),
        (["--set", "voltage_gain=1e9,0"], "voltage_gain must be"),
        (["--load", "/nowhere"], "cannot load constants"),
    ],
)
def test_calibrate_with_bad_input(
    served: PtyDevice, more: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["device", "calibrate", served.path, *more]) == 2
    assert said in capsys.readouterr().err


def test_emulate_serves_another_process(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    link = str(tmp_path / "port")
    words = [
        "device",
        "emulate",
        "--material",
        "aluminium",
        "--mode",
        "T",
        "--link",
        link,
        "--seconds",
        "60",
        "--json",
    ]
    with subprocess.Popen(
        [sys.executable, "-m", "thermograsp", *words], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        printed = process.stdout.readline() + process.stdout.readline() + process.stdout.readline()
        assert json.loads(printed + process.stdout.readline() + process.stdout.readline())["port"] == link
        assert main(["device", "monitor", link, "--seconds", "0.5", "--json"]) == 0
        assert json.loads(capsys.readouterr().out.splitlines()[-1])["end"]["lost"] == 0
        process.terminate()


@pytest.mark.parametrize(
    ("text", "error", "said"),
    [
        ("corupt=0.1", UnknownNameError, "did you mean 'corrupt'"),
        ("corrupt=2", InvalidValueError, "chance"),
        ("corrupt", InvalidValueError, "not a number"),
        ("saturate=up", InvalidValueError, "saturate=left"),
        ("reboot@soon", InvalidValueError, "not a number"),
    ],
)
def test_a_fault_that_cannot_be_planned(
    served: PtyDevice, text: str, error: type[Exception], said: str
) -> None:
    with pytest.raises(error, match=said):
        plan_fault(served, text)


def test_planned_faults_happen() -> None:
    class Served:
        """What plan_fault uses of a PtyDevice, in virtual time."""

        def __init__(self) -> None:
            self.device = EmulatedFingertips()
            self.paused = served_paused

    from contextlib import nullcontext as served_paused

    served = Served()
    tips, line = lockstep(served.device, setpoint=30.0)
    faults = "saturate=left@0.5 open_thermistor=right@0.5 overheat=left@1 break_heater=left corrupt=0@1"
    for text in faults.split():
        plan_fault(served, text)  # pyright: ignore[reportArgumentType]
    line.advance(0.4)
    assert not tips.take().faults & (Flag.SATURATED_LEFT | Flag.OPEN_RIGHT | Flag.OVER_TEMPERATURE)
    line.advance(1.0)
    faults = tips.take().faults
    assert Flag.SATURATED_LEFT | Flag.OPEN_RIGHT | Flag.OVER_TEMPERATURE in faults
    assert served.device.line == LineFaults()


def test_braille_dots_are_where_the_points_are() -> None:
    lines = braille(np.array([0.0, 1.0, 0.5]), np.array([0.0, 1.0, 0.5]), 4, 3)
    assert [len(line) for line in lines] == [4, 4, 4]
    assert lines[2][0] == chr(0x2840)  # bottom left dot
    assert lines[0][3] == chr(0x2808)  # top right dot
    assert sum(bin(ord(c) - 0x2800).count("1") for line in lines for c in line) == 3


def test_the_live_plot_draws(capsys: pytest.CaptureFixture[str]) -> None:
    tips, line = lockstep(EmulatedFingertips(ramp))
    with LivePlot("a port") as plot:
        plot.show(None, "the line is lost")
        for _ in range(30):
            line.advance(0.5)
            plot.show(tips.take(), "")
        picture = plot._plot()
    assert "10 s" in picture and "mV" in picture
    assert sum(len(part[0]) for part in plot._parts) <= 1050
    capsys.readouterr()
