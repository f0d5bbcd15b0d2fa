"""Recordings: whole, cut anywhere, damaged, killed; and replayed through the driver's decoder."""

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.hardware import (
    EmulatedFingertips,
    Fingertips,
    LineFaults,
    Recorder,
    VirtualLine,
    read_recording,
    replay,
)
from thermograsp.hardware.samples import Samples

from .serving import driver, serving
from .test_fingertips import CONSTANTS, ramp

SIDES = [
    [
        f"voltage_{side}_V",
        f"thermostat_{side}_degC",
        f"force_{side}_N",
        f"shear_1_{side}_N",
        f"shear_2_{side}_N",
    ]
    for side in ("left", "right")
]


def recorded(path: Path, faults: LineFaults | None = None) -> tuple[Fingertips, list[Samples]]:
    """A second in virtual time, calibrated half-way, on a line that may be bad."""
    device = EmulatedFingertips(ramp, rng=np.random.default_rng(2))
    line = VirtualLine(device)
    with Recorder(path, {"note": "a test"}) as recorder:
        tips = Fingertips(line.open, clock=line.clock, background=False, tap=recorder)
        device.line = faults or LineFaults()
        parts = []
        for step in range(50):
            line.advance(0.02)
            parts.append(tips.take())
            if step == 25:
                tips.set_calibration(CONSTANTS)
    return tips, parts


@pytest.mark.parametrize(
    "faults", [LineFaults(), LineFaults(corrupt=0.1, drop_frame=0.05, garbage=0.1, duplicate=0.1)]
)
def test_a_replay_is_what_the_driver_saw(tmp_path: Path, faults: LineFaults) -> None:
    tips, parts = recorded(tmp_path / "line.tgr", faults)
    again = replay(tmp_path / "line.tgr")
    assert again.complete and again.metadata["note"] == "a test"
    assert again.identity == tips.identity
    assert again.calibration == tips.calibration == CONSTANTS
    for name in ("time", "device_time", "arrival", "voltage", "thermostat", "force", "flags", "lost"):
        live = np.concatenate([getattr(part, name) for part in parts])
        np.testing.assert_array_equal(getattr(again.samples, name), live)
    assert again.counts == tips._link.session.counts
    assert again.decoder == tips._link.session.decoder.counts


def test_a_file_cut_anywhere_loses_its_last_entry_only(tmp_path: Path) -> None:
    recorded(tmp_path / "whole.tgr")
    content = (tmp_path / "whole.tgr").read_bytes()
    whole = read_recording(tmp_path / "whole.tgr")
    cut = tmp_path / "cut.tgr"
    ends = np.cumsum([len(entry.data) + 17 for entry in whole.entries])
    ends += len(content) - 17 - ends[-1]  # after magic and metadata, before the end's entry
    for length in range(int(ends[0]), len(content), 97):
        cut.write_bytes(content[:length])
        part = read_recording(cut)
        assert not part.complete
        assert part.entries == whole.entries[: int((ends <= length).sum())]


def test_a_damaged_file_is_told_with_the_place(tmp_path: Path) -> None:
    recorded(tmp_path / "line.tgr")
    content = bytearray((tmp_path / "line.tgr").read_bytes())
    content[len(content) // 2] ^= 1
    (tmp_path / "line.tgr").write_bytes(content)
    with pytest.raises(InvalidValueError, match="damaged at byte"):
        read_recording(tmp_path / "line.tgr")
    (tmp_path / "text.tgr").write_text("time_s,voltage_left_V\n")
    with pytest.raises(InvalidValueError, match="not a recording"):
        replay(tmp_path / "text.tgr")
    with pytest.raises(InvalidValueError, match="cannot read"):
        replay(tmp_path / "none.tgr")


def test_an_existing_file_is_kept(tmp_path: Path) -> None:
    (tmp_path / "line.tgr").write_text("mine")
    with pytest.raises(InvalidValueError, match="exists; give the recording another name"):
        Recorder(tmp_path / "line.tgr")
    with pytest.raises(InvalidValueError, match="cannot write"):
        Recorder(tmp_path / "no" / "line.tgr")
    assert (tmp_path / "line.tgr").read_text() == "mine"


KILLED = """
import sys, time
from thermograsp.hardware import Fingertips, Recorder
with Recorder(sys.argv[2], {}) as recorder, Fingertips(sys.argv[1], rate=500, tap=recorder) as tips:
    while True:
        print(len(tips.wait(50, 1.0)), flush=True)
"""


def test_a_killed_recorder_loses_at_most_a_frame(tmp_path: Path) -> None:
    pytest.importorskip("serial")
    with serving(tmp_path, EmulatedFingertips(ramp)) as served:
        file = tmp_path / "line.tgr"
        command = [sys.executable, "-c", KILLED, served.path, str(file)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as recorder:
            assert recorder.stdout is not None
            taken = sum(int(recorder.stdout.readline()) for _ in range(4))
            recorder.send_signal(signal.SIGKILL)
    again = replay(file)
    assert not again.complete
    assert len(again.samples) >= taken
    assert again.counts.lost == 0
    np.testing.assert_allclose(np.diff(again.samples.voltage[:, 0]), 2e-6, atol=3e-9)


def test_a_recording_through_an_unplugged_line(tmp_path: Path) -> None:
    pytest.importorskip("serial")
    file = tmp_path / "line.tgr"
    with serving(tmp_path, EmulatedFingertips(ramp)) as served, Recorder(file) as recorder:
        with driver(served, tap=recorder) as tips:
            tips.wait(20, 1.0)
            served.unplug()
            time.sleep(0.05)
            served.plug()
            deadline = time.monotonic() + 2.0
            while tips.statistics().reconnects == 0 and time.monotonic() < deadline:
                time.sleep(0.01)
            tips.wait(20, 1.0)
            with served.paused():
                served.device.reboot()
            time.sleep(0.3)
            tips.wait(20, 1.0)
        counts = tips._link.session.counts
    again = replay(file)
    assert [text for _, text in again.events if text == "rebooted"] == ["rebooted"]
    assert len(again.samples) == again.counts.samples == counts.samples
    assert again.counts.lost == counts.lost


def test_columns_are_the_package_s(tmp_path: Path) -> None:
    recorded(tmp_path / "line.tgr")
    columns = replay(tmp_path / "line.tgr").samples.columns
    assert list(columns) == ["time_s", "device_time_s", *SIDES[0], *SIDES[1], "flags", "lost_frames"]
    assert columns["time_s"][0] == 0.0
    assert len({len(column) for column in columns.values()}) == 1
    assert json.dumps({name: float(column[0]) for name, column in columns.items()})
