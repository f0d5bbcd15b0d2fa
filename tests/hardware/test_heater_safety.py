"""What keeps heaters from doing harm: latches, a silent host, a runaway, unseen restarts, and off that stays off."""

import threading
import time
from pathlib import Path

import numpy as np
import pytest

from thermograsp.hardware import (
    CommandRefusedError,
    DeviceError,
    EmulatedFingertips,
    Feel,
    Fingertips,
    Flag,
    HeatersOff,
    LineFaults,
    LinkLostError,
    LinkSettings,
    Reset,
    SerialPort,
    StoppedError,
    VirtualLine,
)
from thermograsp.hardware.protocol.messages import KeepAlive, SetSetpoint

from .serving import COMING, driver, error_within, healthy_within, nothing_left, serving
from .test_fingertips import attended, lockstep, ramp

OFF = pytest.approx((np.nan, np.nan), nan_ok=True)


@pytest.mark.slow
def test_over_temperature_stays_until_it_is_cleared() -> None:
    """No setpoint ends it, nor a driver or a device that starts anew; nor can it be ended while it is hot."""
    device = EmulatedFingertips()
    tips, line = lockstep(device, setpoint=36.0)
    line.advance(0.1)
    device.overheat(1)
    line.advance(0.1)
    assert tips.take().faults & Flag.LATCHED_OFF
    with pytest.raises(CommandRefusedError, match="CLEAR_FAULTS"):
        tips.clear_faults()
    attended(tips, line, 300.0)  # it cools
    tips.set_setpoint(40.0, 40.0)
    device.reboot()  # as many boards do when their port is opened
    tips, line = Fingertips(line.open, clock=line.clock, background=False, setpoint=36.0), line
    samples = attended(tips, line, 2.0)
    assert (samples.flags & Flag.LATCHED_OFF).all()
    assert tips.thermostats().power == (0.0, 0.0)
    assert tips.condition().heaters_off == HeatersOff.TOO_HOT_RIGHT
    assert tips.clear_faults().heaters_off == 0
    samples = attended(tips, line, 2.0)
    assert not (samples.flags & Flag.LATCHED_OFF).any() and max(tips.thermostats().power) > 0


def test_a_fault_that_was_not_seen_is_not_cleared() -> None:
    device = EmulatedFingertips()
    device._plates.latched = HeatersOff.TOO_HOT_LEFT | HeatersOff.RUNAWAY_RIGHT
    assert device._plates.clear(HeatersOff.TOO_HOT_LEFT)
    assert device._plates.latched == HeatersOff.RUNAWAY_RIGHT


def test_heaters_go_off_when_the_host_falls_silent() -> None:
    device = EmulatedFingertips()
    tips, line = lockstep(device, setpoint=36.0)
    attended(tips, line, 30.0)
    assert tips.thermostats().setpoint == (36.0, 36.0)
    assert tips.condition().heaters_off == 0
    line.advance(7.0)  # 2 s at most since the last sign of life, as 8 s and this
    assert tips.thermostats().setpoint == (36.0, 36.0)
    line.advance(4.0)
    assert tips.thermostats().setpoint == OFF
    assert tips.condition().heaters_off == HeatersOff.HOST_SILENT
    line.advance(60.0)
    assert tips.take().thermostat[-1] == pytest.approx([36.0 - 12.0 * (1 - np.exp(-60 / 210))] * 2, abs=1.0)
    tips.set_setpoint(36.0, 36.0)
    assert tips.condition().heaters_off == 0


def test_only_the_host_of_the_session_keeps_them_on() -> None:
    """Not whoever asks for a report, nor another program that is still connected."""
    device = EmulatedFingertips()
    tips, line = lockstep(device, setpoint=36.0, rate=10)
    stranger = KeepAlive((device._session or 0) ^ 1)
    tips._link.keep_alive = lambda: None  # pyright: ignore[reportAttributeAccessIssue]
    assert stranger.session != device._session
    for _ in range(11):
        line.advance(1.0)
        tips.status()
    assert tips.thermostats().setpoint == OFF


def test_a_host_that_was_asleep_heats_again(tmp_path: Path) -> None:
    """The driver sends the setpoint again, as after a reconnect."""
    pytest.importorskip("serial")
    with nothing_left(), serving(tmp_path) as served, driver(served, setpoint=36.0) as tips:
        tips.wait(5, COMING)
        with served.paused():
            served.device._alive_at -= 20.0  # as if nothing had come for so long
        deadline = time.monotonic() + 3.0
        while not served.device._silenced and time.monotonic() < deadline:
            time.sleep(0.002)
        assert served.device._silenced
        while served.device._silenced and time.monotonic() < deadline:
            time.sleep(0.01)
        assert tips.thermostats().setpoint == (36.0, 36.0)


def test_a_heater_that_warms_nothing_is_a_runaway() -> None:
    device = EmulatedFingertips()
    device.broken_heaters.add(0)
    tips, line = lockstep(device, setpoint=36.0)
    attended(tips, line, 5.0)
    assert tips.condition().heaters_off == 0
    attended(tips, line, 2.0)  # 30 J at 5 W
    assert tips.condition().heaters_off == HeatersOff.RUNAWAY_LEFT
    assert tips.thermostats().power == (0.0, 0.0)
    assert tips.take().faults & Flag.LATCHED_OFF or attended(tips, line, 1.0).faults & Flag.LATCHED_OFF


@pytest.mark.parametrize("drawn", [0.0, 0.3, 3.0])
def test_a_heater_that_works_is_none(drawn: float) -> None:
    """From 24 °C, at once and with a contact that draws much of its power on the way, and while it holds."""
    device = EmulatedFingertips(lambda now: Feel(heat=(drawn * (now > 2.0), 0.0)))
    tips, line = lockstep(device, setpoint=60.0)
    attended(tips, line, 60.0)
    assert tips.condition().heaters_off == 0


def test_a_restart_while_unplugged_is_seen(tmp_path: Path) -> None:
    """Its clock begins at 0: samples are new, in true time, and the setpoint is there again."""
    pytest.importorskip("serial")
    with nothing_left(), serving(tmp_path, EmulatedFingertips(ramp)) as served:
        time.sleep(1.0)  # the device's clock is ahead
        with driver(served, setpoint=36.0) as tips:
            before = tips.wait(50, COMING)
            served.unplug()
            error_within(tips.take, LinkLostError)
            with served.paused():
                served.device.reboot(Reset.BROWN_OUT)
            served.plug()
            healthy_within(tips)
            after = tips.wait(50, COMING)
            assert tips.statistics().reboots == 1
            assert after.device_time[0] < before.device_time[-1]
            assert (np.diff(after.time) > 1e-3).all() and after.time[0] > before.time[-1]
            assert (abs(after.arrival - after.time) < 0.1).all()
            assert tips.thermostats().setpoint == (36.0, 36.0)
            assert tips.condition().reset == Reset.BROWN_OUT


@pytest.mark.parametrize("how", ["unplugged", "deaf"])
def test_off_that_failed_is_not_followed_by_heating(tmp_path: Path, how: str) -> None:
    pytest.importorskip("serial")
    with nothing_left(), serving(tmp_path) as served, driver(served, setpoint=36.0) as tips:
        tips.wait(5, COMING)
        if how == "unplugged":
            served.unplug()
        else:
            with served.paused():
                served.device.line = LineFaults(drop_answer=1.0)
                served.device.executed.clear()
                served.device.receive = lambda data: None
        with pytest.raises(DeviceError):
            tips.set_setpoint(None, 36.0)
        if how == "unplugged":
            served.plug()
        else:
            with served.paused():
                served.device.line = LineFaults()
                del served.device.receive
        deadline = time.monotonic() + 5.0
        report = None
        while time.monotonic() < deadline:
            try:
                report = tips.thermostats()
                if np.isnan(report.setpoint[0]):
                    break
            except DeviceError:
                pass
            time.sleep(0.02)
        assert report is not None and report.setpoint == pytest.approx((np.nan, 36.0), nan_ok=True)
        with served.paused():
            served.device.reboot()
        time.sleep(0.3)
        healthy_within(tips)
        assert tips.thermostats().setpoint == pytest.approx((np.nan, 36.0), nan_ok=True)


def test_off_that_failed_is_off_even_where_the_setpoint_was_not_known() -> None:
    device = EmulatedFingertips()
    lockstep(device, setpoint=36.0)
    tips, line = lockstep(device)
    device.line = LineFaults(drop_frame=1.0)
    with pytest.raises(DeviceError):
        tips.set_setpoint(None, None)
    assert tips._wish.setpoint == OFF


def test_while_off_is_not_confirmed_nothing_keeps_the_heaters_alive() -> None:
    device = EmulatedFingertips()
    tips, line = lockstep(device, setpoint=36.0)
    hears, device.receive = device.receive, lambda data: None
    with pytest.raises(DeviceError):
        tips.set_setpoint(None, 36.0)
    device.receive = hears
    attended(tips, line, 11.0)
    assert tips.thermostats().setpoint == OFF


class Listened:
    """A transport that notes which thread writes."""

    def __init__(self, path: str, writers: list[str]) -> None:
        self._port, self._writers = SerialPort(path), writers
        self.read, self.close = self._port.read, self._port.close

    def write(self, data: bytes) -> None:
        self._writers.append(threading.current_thread().name)
        self._port.write(data)


def test_off_waits_for_one_try_of_other_commands_at_most(tmp_path: Path) -> None:
    """However many threads ask, and whatever the line loses."""
    pytest.importorskip("serial")
    writers: list[str] = []
    with nothing_left(), serving(tmp_path) as served:
        settings = LinkSettings(answer_within=0.02, tries=60)
        with Fingertips(
            lambda: Listened(served.path, writers), setpoint=36.0, rate=200, settings=settings
        ) as tips:
            ended = threading.Event()

            def ask() -> None:
                while not ended.is_set():
                    tips.set_rate(200)

            threads = [threading.Thread(target=ask, name="other") for _ in range(4)]
            with served.paused():
                served.device.line = LineFaults(drop_answer=0.3)
            for thread in threads:
                thread.start()
            time.sleep(0.1)
            for _ in range(5):
                before = len(writers)
                tips.set_setpoint(None, None)
                assert writers.index("MainThread", before) - before <= 1
                tips.set_setpoint(36.0, 36.0)
            ended.set()
            for thread in threads:
                thread.join()


def test_a_setpoint_that_is_being_tried_ends_with_a_newer_one(tmp_path: Path) -> None:
    """Its answers are lost: it is not sent again once off was asked for."""
    pytest.importorskip("serial")
    with nothing_left(), serving(tmp_path) as served:
        with driver(served, setpoint=36.0, settings=LinkSettings(tries=30)) as tips:
            raised: list[Exception] = []

            def heat() -> None:
                try:
                    tips.set_setpoint(50.0, 50.0)
                except Exception as error:  # noqa: BLE001
                    raised.append(error)

            with served.paused():
                served.device.line = LineFaults(drop_answer=1.0)
            heating = threading.Thread(target=heat)
            heating.start()
            while SetSetpoint((50.0, 50.0)) not in served.device.executed:
                time.sleep(0.002)
            off = threading.Thread(target=lambda: tips.set_setpoint(None, None))
            off.start()
            while not np.isnan(served.device._plates.setpoint[0]):
                time.sleep(0.002)
            with served.paused():
                served.device.line = LineFaults()
            off.join()
            heating.join()
            assert isinstance(raised[0], StoppedError)
            assert np.isnan(served.device.executed[-1].setpoint).all()
            assert np.isnan(tips.thermostats().setpoint).all()


def test_a_keep_alive_takes_no_time_and_no_answer() -> None:
    device = EmulatedFingertips()
    line = VirtualLine(device)
    tips = Fingertips(line.open, clock=line.clock, background=False, rate=100, setpoint=36.0)
    for _ in range(250):
        line.advance(0.02)
        assert len(tips.take()) == 2
    assert tips.statistics().late_answers == 0
