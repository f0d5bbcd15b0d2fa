"""Everything that a line does to a driver: it goes on or raises its typed error within a second, and leaves nothing."""

import errno
import os
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from thermograsp.hardware import (
    DeviceModel,
    EmulatedFingertips,
    Feel,
    Fingertips,
    Flag,
    LineFaults,
    LinkLostError,
    LinkSettings,
    NoAnswerError,
    PortBusyError,
    PortError,
    PortForbiddenError,
    PortMissingError,
    ProtocolVersionError,
    PtyDevice,
    SensorFaultError,
    SerialPort,
    StaleSensorError,
    WrongDeviceError,
)
from thermograsp.hardware.protocol.messages import SetRate, SetSetpoint

from .serving import (
    COMING,
    PATIENCE,
    QUICK,
    driver,
    error_within,
    healthy_within,
    nothing_left,
    plugged_elsewhere,
    serving,
)

pytest.importorskip("serial")


@pytest.fixture(autouse=True)
def no_leak() -> Iterator[None]:
    with nothing_left():
        yield


def test_port_missing(tmp_path: Path) -> None:
    with pytest.raises(PortMissingError, match="no such port; plug the device in"):
        Fingertips(str(tmp_path / "nothing"))


def test_port_busy(tmp_path: Path) -> None:
    with serving(tmp_path) as served, driver(served), pytest.raises(PortBusyError, match="another program"):
        driver(served)


def test_port_forbidden(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Root may open everything, so the system's refusal is imitated where pyserial meets it."""

    def refuse(path: str, flags: int, *more: object) -> int:
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), path)

    with serving(tmp_path) as served:
        monkeypatch.setattr("serial.serialposix.os.open", refuse)
        with pytest.raises(PortForbiddenError, match="dialout"):
            SerialPort(served.path)
        monkeypatch.undo()


def test_a_port_without_low_latency_is_used_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """A pseudo-terminal refuses it, Windows has no such method, other systems no such mode; nothing else is hidden."""
    with serving(tmp_path) as served:
        with caplog.at_level("INFO", "thermograsp"):
            SerialPort(served.path).close()
        assert "no low latency mode" in caplog.text
        for error in (NotImplementedError, TypeError):

            def refuse(port: object, wanted: bool, error: type[Exception] = error) -> None:
                raise error("no")

            monkeypatch.setattr("serial.Serial.set_low_latency_mode", refuse)
            if error is TypeError:
                with pytest.raises(TypeError):
                    SerialPort(served.path)
            else:
                SerialPort(served.path).close()


def test_port_that_is_none(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("")
    with pytest.raises(PortError, match="cannot open it at 500000 baud"):
        Fingertips(str(file))


class Chatter(EmulatedFingertips):
    """Another kind of device: text, and no ear."""

    def receive(self, data: bytes) -> None:
        self._out.append(b"$GPGGA,092750.000,5321.6802,N,00630.3372,W,1,8,1.03,61.7,M,55.2,M,,*76\r\n")


class Mute(EmulatedFingertips):
    def receive(self, data: bytes) -> None:
        pass

    def outgoing(self) -> list[bytes]:
        return []


@pytest.mark.parametrize(
    ("kind", "message"), [(Chatter, "not a fingertip, or has another baud"), (Mute, "nothing came")]
)
def test_wrong_device(tmp_path: Path, kind: type[EmulatedFingertips], message: str) -> None:
    begun = time.monotonic()
    with serving(tmp_path, kind()) as served, pytest.raises(NoAnswerError, match=message):
        driver(served, settings=LinkSettings(open_within=0.2, tries=2))
    assert time.monotonic() - begun < PATIENCE


def test_wrong_model(tmp_path: Path) -> None:
    device = EmulatedFingertips(model=DeviceModel(model=0x1234))
    with serving(tmp_path, device) as served, pytest.raises(WrongDeviceError, match="model 0x1234"):
        driver(served)


@pytest.mark.parametrize("version", [(3, 0), (1, 0)])
def test_wrong_version(tmp_path: Path, version: tuple[int, int]) -> None:
    device = EmulatedFingertips(model=DeviceModel(protocol=version))
    with serving(tmp_path, device) as served, pytest.raises(ProtocolVersionError, match="update the older"):
        driver(served)


def test_unplugged_while_reading_and_back_under_another_number(tmp_path: Path) -> None:
    with serving(tmp_path) as served, driver(served, setpoint=36.0) as tips:
        tips.wait(5, COMING)
        before = os.readlink(served.path)
        served.unplug()
        assert "plugged in" in str(error_within(tips.take, LinkLostError))
        with plugged_elsewhere(served, before):
            healthy_within(tips)
        statistics = tips.statistics()
        assert (statistics.reconnects, statistics.reboots) == (1, 0)
        assert tips.thermostats().setpoint == (36.0, 36.0)


def test_unplugged_while_writing(tmp_path: Path) -> None:
    with serving(tmp_path) as served, driver(served) as tips:
        served.unplug()
        error_within(lambda: tips.set_rate(50), LinkLostError)
        served.plug()
        healthy_within(tips)
        tips.set_rate(50)


def test_another_device_in_its_place(tmp_path: Path) -> None:
    with serving(tmp_path) as served, driver(served) as tips:
        served.unplug()
        with served.paused():
            served.device = EmulatedFingertips(model=DeviceModel(serial=2))
        served.plug()
        assert "number 0x2 instead of 0x1" in str(error_within(tips.take, WrongDeviceError))


def test_a_silent_hang_is_told_and_repaired(tmp_path: Path) -> None:
    with serving(tmp_path) as served, driver(served) as tips:
        tips.wait(5, COMING)
        with served.paused():
            served.device.stall_until = served.now + 0.6
        assert "no sample for" in str(error_within(tips.take, StaleSensorError))
        healthy_within(tips)
        assert tips.statistics().reconnects == 1


def test_a_hang_for_ever_stays_told(tmp_path: Path) -> None:
    with serving(tmp_path) as served, driver(served) as tips:
        with served.paused():
            served.device.stall_until = float("inf")
        error_within(tips.take, StaleSensorError)
        error_within(lambda: tips.wait(1, 0.1), StaleSensorError)
        begun = time.monotonic()
        tips.close()
        assert time.monotonic() - begun < PATIENCE


@pytest.mark.parametrize(
    "fault", ["corrupt", "drop_byte", "truncate", "drop_frame", "merge", "garbage", "duplicate"]
)
def test_a_bad_line(tmp_path: Path, fault: str) -> None:
    """What arrives is right, what does not is counted. At a rate that a busy machine keeps up with: a line that is full
    loses samples too."""

    def constant(time: float) -> Feel:
        return Feel(voltage=(1e-3, -1e-3), thermostat=(36.0, 36.5))

    device = EmulatedFingertips(constant)
    with serving(tmp_path, device) as served, driver(served, rate=250) as tips:
        with served.paused():
            device.line = LineFaults(**{fault: 0.2})
            sent = device._samples
        samples = tips.wait(150, 6.0)
        with served.paused():
            device.line = LineFaults()
        tips.set_setpoint(30.0, None)  # through whatever is left of the bad line
        time.sleep(0.05)
        samples_more = tips.take()
        with served.paused():
            sent = device._samples - sent
        statistics = tips.statistics()
    for part in (samples, samples_more):
        assert (part.voltage == (1e-3, -1e-3)).all() and (part.thermostat == (36.0, 36.5)).all()
        assert (part.device_time[1:] > part.device_time[:-1]).all()
    got = len(samples) + len(samples_more)
    if fault in ("garbage", "duplicate"):
        assert statistics.lost == 0
        assert statistics.duplicates > 0 or statistics.rejected > 0
    elif fault == "merge":
        assert got < sent
    else:
        assert statistics.lost > 10
    assert statistics.lost >= sent - got - 20  # the last few may be on their way


def test_garbage_at_boot(tmp_path: Path) -> None:
    device = EmulatedFingertips()
    device._out.append(bytes(range(1, 256)) * 4)
    with serving(tmp_path, device) as served, driver(served) as tips:
        tips.wait(5, COMING)
        assert tips.statistics().lost == 0


def test_commands_through_a_bad_line_run_once(tmp_path: Path) -> None:
    """5 % of frames corrupted and 30 % of acknowledgements lost: repeated by the host, executed once by the device."""
    device = EmulatedFingertips()
    with (
        serving(tmp_path, device) as served,
        driver(served, settings=LinkSettings(answer_within=0.01, tries=20)) as tips,
    ):
        with served.paused():
            device.line = LineFaults(corrupt=0.05, drop_answer=0.3)
            device.executed.clear()
        wanted = [20.0 + 0.1 * k for k in range(100)]
        for value in wanted:
            tips.set_setpoint(value, value)
        repeats = tips.statistics().repeats
    done = [message.setpoint[0] for message in device.executed if isinstance(message, SetSetpoint)]
    assert done == pytest.approx(wanted, abs=0.005)
    assert repeats > 10


def test_a_late_answer_belongs_to_its_command(tmp_path: Path) -> None:
    device = EmulatedFingertips()
    with serving(tmp_path, device) as served, driver(served) as tips:
        with served.paused():
            device.line = LineFaults(answer_delay=0.15)
            device.executed.clear()
        tips.set_rate(150)
        tips.set_rate(250)
        time.sleep(0.3)
        statistics = tips.statistics()
    assert [message.rate for message in device.executed if isinstance(message, SetRate)] == [150, 250]
    assert statistics.late_answers > 0


def test_no_acknowledgement_at_all(tmp_path: Path) -> None:
    device = EmulatedFingertips()
    with serving(tmp_path, device) as served, driver(served) as tips:
        with served.paused():
            device.line = LineFaults(drop_answer=1.0)
        begun = time.monotonic()
        with pytest.raises(NoAnswerError, match="SET_RATE: no answer after 8 tries"):
            tips.set_rate(100)
        assert time.monotonic() - begun < PATIENCE


def test_a_reboot_in_mid_run(tmp_path: Path) -> None:
    with serving(tmp_path) as served, driver(served, rate=500, setpoint=36.0) as tips:
        before = tips.wait(50, COMING)
        with served.paused():
            served.device.reboot()
        healthy_within(tips)
        after = tips.wait(50, COMING)
        statistics = tips.statistics()
        assert (statistics.reboots, statistics.reconnects, statistics.late) == (1, 0, 0)
        assert tips.thermostats().setpoint == (36.0, 36.0)
        assert tips.status().rate == 500
    assert after.device_time[-1] < 5.0 and after.time[0] > before.time[-1]
    assert (abs(after.arrival - after.time) < 0.5).all()


def test_numbers_and_time_wrap(tmp_path: Path) -> None:
    device = EmulatedFingertips()
    device._booted -= 2**32 / 1e6 - 0.3
    device._sequence = 65500
    device._out.clear()
    with serving(tmp_path, device) as served, driver(served, rate=500) as tips:
        samples = tips.wait(400, COMING)
        statistics = tips.statistics()
    assert (statistics.lost, statistics.late, statistics.duplicates) == (0, 0, 0)
    assert samples.device_time[0] < 2**32 / 1e6 < samples.device_time[-1]
    steps = samples.device_time[1:] - samples.device_time[:-1]
    assert abs(steps - 0.002).max() < 1e-5


def test_host_overrun_keeps_the_newest(tmp_path: Path) -> None:
    with serving(tmp_path) as served, driver(served, rate=1000, settings=LinkSettings(kept=50)) as tips:
        time.sleep(0.3)
        samples = tips.take()
        assert len(samples) == 50
        assert tips.statistics().overruns > 50
        assert tips.statistics().lost == 0


def test_a_host_that_does_not_read_costs_whole_samples(tmp_path: Path) -> None:
    """The kernel takes 22 kB or less; the device drops what finds no room, and never half a frame."""
    device = EmulatedFingertips()
    with serving(tmp_path, device) as served:
        with driver(served, rate=1000) as tips:
            tips.wait(10, COMING)
        with served.paused():
            served.device.advance(served.now)
        for _ in range(60):  # 6 s of samples at once, in steps that a real device would take
            with served.paused():
                served._begun -= 0.1
            time.sleep(0.005)
        time.sleep(0.1)
        port = SerialPort(served.path)  # which forgets what the kernel had kept
        port.close()
        with driver(served, rate=1000) as tips:
            tips.wait(100, COMING)
            assert tips.statistics().rejected <= 1  # the frame that was being written
            assert tips.status().overruns > 0


def test_a_device_that_takes_no_bytes(tmp_path: Path) -> None:
    """A full line on the way to the device: the write ends with an error instead of waiting for ever."""
    ends = os.openpty()
    port = SerialPort(os.ttyname(ends[1]))
    begun = time.monotonic()
    with pytest.raises(LinkLostError):
        for _ in range(100):
            port.write(b"\0" * 4096)
    assert time.monotonic() - begun < PATIENCE
    port.close()
    for end in ends:
        os.close(end)


@pytest.mark.parametrize(
    ("break_it", "flag", "message"),
    [
        (lambda device: device.broken_thermistors.add(0), Flag.OPEN_LEFT, "left thermistor is open"),
        (lambda device: device.saturated.add(1), Flag.SATURATED_RIGHT, "end of the converter's range"),
        (lambda device: device.overheat(0), Flag.OVER_TEMPERATURE, "too hot"),
        (lambda device: device.broken_converters.add(0), Flag.NO_VOLTAGE_LEFT, "left voltage is missing"),
        (lambda device: None, Flag.OFF_SETPOINT_LEFT | Flag.OFF_SETPOINT_RIGHT, "off its setpoint"),
    ],
    ids=["open", "saturated", "hot", "deaf", "cold"],
)
def test_sensor_faults_are_told(tmp_path: Path, break_it, flag: Flag, message: str) -> None:  # noqa: ANN001
    with serving(tmp_path) as served, driver(served, setpoint=36.0) as tips:
        with served.paused():
            break_it(served.device)
        time.sleep(0.1)
        tips.take()
        samples = tips.wait(5, COMING)
    assert samples.faults & flag
    assert np.isnan(samples.voltage[:, 0]).all() == (flag == Flag.NO_VOLTAGE_LEFT)
    with pytest.raises(SensorFaultError, match=message):
        samples.require_healthy()
    samples.require_healthy(but=samples.faults)
    if flag == Flag.OPEN_LEFT:
        assert (samples.thermostat[:, 0] != samples.thermostat[:, 0]).all()  # NaN


def test_closed_twice_and_used_after(tmp_path: Path) -> None:
    with serving(tmp_path) as served:
        tips = driver(served)
        tips.close()
        tips.close()
        with pytest.raises(LinkLostError):
            tips.set_rate(10)


def test_an_existing_file_is_not_replaced_by_a_link(tmp_path: Path) -> None:
    (tmp_path / "fingertips").write_text("mine")
    with pytest.raises(ValueError, match="is not a link"):
        PtyDevice(EmulatedFingertips(), tmp_path / "fingertips")
    assert QUICK.tries == 8
