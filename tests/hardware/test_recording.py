"""Recordings: whole, cut anywhere, damaged, killed; and replayed through the driver's decoder."""

import errno
import io
import json
import math
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from thermograsp.cli import main
from thermograsp.errors import InvalidValueError
from thermograsp.hardware import (
    EmulatedFingertips,
    Fingertips,
    LineFaults,
    Recorder,
    RecordingError,
    VirtualLine,
    read_recording,
    replay,
)
from thermograsp.hardware.protocol.samples import Samples
from thermograsp.hardware.recordings.recording import MAGIC, SENT

from .serving import COMING, driver, serving
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


def test_one_bad_byte_costs_one_entry(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    """Wherever it is: in the head, a length, data, a checksum, the file's first line or its end."""
    recorded(tmp_path / "whole.tgr")
    content = (tmp_path / "whole.tgr").read_bytes()
    whole = read_recording(tmp_path / "whole.tgr")
    assert whole.damage == ()
    bad = tmp_path / "bad.tgr"
    places = [*range(0, 200), *range(200, len(content), 131), *range(len(content) - 40, len(content))]
    for place in places:
        for flipped in (0x01, 0x80):
            spoiled = bytearray(content)
            spoiled[place] ^= flipped
            bad.write_bytes(spoiled)
            part = read_recording(bad)
            kept = [entry for entry in part.entries if b"left out" not in entry.data]
            assert kept == [entry for entry in whole.entries if entry in kept]
            assert len(whole.entries) - len(kept) <= 1
            if part.damage:
                assert sum(damage.bytes for damage in part.damage) < 1000
                assert any(damage.at <= place < damage.at + damage.bytes for damage in part.damage)
            else:
                assert place >= len(content) - 17 and not part.complete
    assert "damaged and left out" in caplog.text


def test_a_beginning_that_is_damaged_costs_only_itself(tmp_path: Path) -> None:
    """A byte too many or too few there moves all that follows; and the first entry may be damaged as well."""
    file = tmp_path / "line.tgr"
    recorded(file)
    whole, entries = file.read_bytes(), len(read_recording(file).entries)
    beginnings = {
        "lost": whole[:5] + whole[6:],
        "added": whole[:5] + b"m" + whole[5:],
        "missing": whole[len(MAGIC) :],
        "both": b"T" + whole[1:40] + bytes([whole[40] ^ 1]) + whole[41:],
    }
    for what, content in beginnings.items():
        file.write_bytes(content)
        found = read_recording(file)
        kept = [entry for entry in found.entries if not entry.data.endswith(b"left out")]
        assert len(kept) == entries and found.complete, what
        assert (found.metadata.get("note") == "a test") == (what != "both")
        assert found.damage or what == "missing"


def test_no_sample_is_lost_where_what_was_asked_is_damaged(tmp_path: Path) -> None:
    """A whole replay waits for the first answer; without its question there would be none."""
    file = tmp_path / "line.tgr"
    recorded(file)
    whole, content = replay(file), bytearray(file.read_bytes())
    at = len(MAGIC)
    while at < len(content):
        length, kind = int.from_bytes(content[at : at + 4], "little"), content[at + 4]
        if kind == SENT:
            content[at + 14] ^= 1
        at += length + 17
    file.write_bytes(content)
    again = replay(file)
    assert again.damage and len(again.samples) == len(whole.samples) > 0


def test_nothing_is_recorded_after_the_end(tmp_path: Path) -> None:
    """The line's thread may be about to write when another one closes the recording."""
    file = tmp_path / "line.tgr"
    recorder = Recorder(file)
    late = threading.Thread(target=recorder.received, args=(1.0, b"late"))
    inner = recorder._file

    class Slow:
        closed = False

        def write(self, data: bytes) -> int:
            return inner.write(data) or 0

        def close(self) -> None:
            late.start()
            late.join(0.2)  # where it does not wait, it writes
            self.closed = True
            inner.close()

    recorder._file = Slow()  # pyright: ignore[reportAttributeAccessIssue]
    recorder.close()
    late.join()
    found = read_recording(file)
    assert found.complete and not found.entries


def test_a_damaged_stretch_is_left_out_and_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recorded(tmp_path / "line.tgr")
    whole = replay(tmp_path / "line.tgr")
    content = bytearray((tmp_path / "line.tgr").read_bytes())
    middle = len(content) // 2
    content[middle : middle + 300] = bytes(range(256)) + bytes(44)
    (tmp_path / "line.tgr").write_bytes(content)
    again = replay(tmp_path / "line.tgr")
    assert len(whole.samples) - 10 <= len(again.samples) < len(whole.samples)
    assert again.counts.lost > 0 and again.complete
    assert main(["device", "replay", str(tmp_path / "line.tgr"), "--json"]) == 0
    (damage,) = json.loads(capsys.readouterr().out)["damage"]
    assert damage["at"] <= middle and damage["at"] + damage["bytes"] >= middle + 300
    assert main(["device", "replay", str(tmp_path / "line.tgr")]) == 0
    assert f"{damage['bytes']} bytes from byte {damage['at']}" in capsys.readouterr().out


def test_what_is_no_recording(tmp_path: Path) -> None:
    (tmp_path / "text.tgr").write_text("time_s,voltage_left_V\n" * 100)
    with pytest.raises(InvalidValueError, match="not a recording"):
        replay(tmp_path / "text.tgr")
    with pytest.raises(InvalidValueError, match="cannot read"):
        replay(tmp_path / "none.tgr")


def test_two_recordings_in_one_file_are_refused(tmp_path: Path) -> None:
    """Their clocks do not agree: the second one's samples were all given the last time of the first."""
    content = b""
    for name in ("a", "b"):
        with Recorder(tmp_path / name) as recorder:
            recorder.received(1.0, b"x")
        content += (tmp_path / name).read_bytes()
    (tmp_path / "both").write_bytes(content)
    with pytest.raises(InvalidValueError, match="both is 2 recordings, one behind the other"):
        read_recording(tmp_path / "both")


class SmallDisk:
    """A file that takes a few bytes at a time, and then no more."""

    def __init__(self, file: io.FileIO, room: float) -> None:
        self._file, self._room = file, room
        self.truncate, self.close = file.truncate, file.close

    @property
    def closed(self) -> bool:
        return self._file.closed

    def write(self, data: memoryview) -> int:
        if self._room <= 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        written = self._file.write(data[: int(min(self._room, 7))])
        self._room -= written
        return written


@pytest.mark.parametrize("room", [math.inf, 0, 5000, 5003, 5006])
def test_short_writes_and_a_full_disk(tmp_path: Path, room: float) -> None:
    """The driver goes on; the file has whole entries; who closes it is told."""
    file = tmp_path / "line.tgr"
    recorder = Recorder(file)
    recorder._file = SmallDisk(recorder._file, room)  # pyright: ignore[reportAttributeAccessIssue]
    line = VirtualLine(EmulatedFingertips(ramp))
    tips = Fingertips(line.open, clock=line.clock, background=False, tap=recorder)
    for _ in range(50):
        line.advance(0.02)
        assert len(tips.take()) == 2
    if room == math.inf:
        assert recorder.failure == ""
        recorder.close()
        assert len(replay(file).samples) == 100
        return
    assert "No space left" in recorder.failure
    with pytest.raises(RecordingError, match="No space left on device; the file has what came before"):
        recorder.close()
    recorder.close()
    again = replay(file)
    assert again.damage == () and not again.complete
    assert file.stat().st_size <= room + 300
    assert len(again.samples) > 30 or room == 0


def test_a_full_disk_is_told_at_the_end_of_the_block(tmp_path: Path) -> None:
    with pytest.raises(RecordingError), Recorder(tmp_path / "a.tgr") as recorder:
        recorder._file = SmallDisk(recorder._file, 0)  # pyright: ignore[reportAttributeAccessIssue]
        recorder.event(0.0, "something")
    with pytest.raises(KeyError), Recorder(tmp_path / "b.tgr") as recorder:
        recorder._file = SmallDisk(recorder._file, 0)  # pyright: ignore[reportAttributeAccessIssue]
        recorder.event(0.0, "something")
        raise KeyError


def test_a_tap_that_fails_does_not_disturb_the_line(caplog: pytest.LogCaptureFixture) -> None:
    class Broken:
        def received(self, now: float, data: bytes) -> None:
            raise RuntimeError("no")

        def sent(self, now: float, data: bytes) -> None:
            pass

        def event(self, now: float, what: str) -> None:
            pass

    line = VirtualLine(EmulatedFingertips(ramp))
    tips = Fingertips(line.open, clock=line.clock, background=False, tap=Broken())
    line.advance(0.1)
    assert len(tips.take()) == 10
    assert "tap" in caplog.text


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
        print(len(tips.wait(50, 10.0)), flush=True)
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
            tips.wait(20, COMING)
            served.unplug()
            time.sleep(0.05)
            served.plug()
            deadline = time.monotonic() + 2.0
            while tips.statistics().reconnects == 0 and time.monotonic() < deadline:
                time.sleep(0.01)
            tips.wait(20, COMING)
            with served.paused():
                served.device.reboot()
            time.sleep(0.3)
            tips.wait(20, COMING)
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
