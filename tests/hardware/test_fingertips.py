"""The driver on a device that behaves: samples, settings, reports, clocks, and a kilohertz without a loss."""

import math
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.hardware import (
    Calibration,
    CommandRefusedError,
    DeviceModel,
    EmulatedFingertips,
    Feel,
    Fingertips,
    LinkLostError,
    PtyDevice,
    Samples,
    StaleSensorError,
    VirtualLine,
    press_source,
    samples_source,
)
from thermograsp.hardware.protocol.messages import Flag, RunSelfTest
from thermograsp.thermal import ADS1115, Thermostat

from .serving import COMING, driver, nothing_left, serving
from .tiers import size

CONSTANTS = Calibration(
    date=1_700_000_000,
    voltage_offset=(20e-6, -10e-6),
    voltage_gain=(0.01, -0.02),
    thermostat_offset=(0.5, -0.25),
    force_offset=((0.1, 0.0, 0.0), (0.0, 0.2, 0.0)),
    force_gain=((0.05, 0.0, 0.0), (0.0, 0.0, 0.1)),
)


def ramp(time: float) -> Feel:
    """Voltages that tell when they were taken."""
    return Feel(voltage=(time * 1e-3, -time * 1e-3), thermostat=(36.0, 35.0), force=((5, 0, 0), (0, 6, -7)))


def lockstep(device: EmulatedFingertips, **keywords: object) -> tuple[Fingertips, VirtualLine]:
    line = VirtualLine(device)
    return Fingertips(line.open, clock=line.clock, background=False, **keywords), line  # pyright: ignore[reportArgumentType]


def attended(tips: Fingertips, line: VirtualLine, seconds: float) -> Samples:
    """The samples of the last second, taken every second, as a host does that is there."""
    for _ in range(round(seconds) - 1):
        line.advance(1.0)
        tips.take()
    line.advance(1.0)
    return tips.take()


def test_what_came_while_nobody_listened_is_not_taken_for_new(tmp_path: Path) -> None:
    """A device goes on when its host is gone, and adapters and systems keep what they have room for."""
    pytest.importorskip("serial")
    with serving(tmp_path, EmulatedFingertips(ramp)) as served:
        driver(served, rate=1000).close()
        time.sleep(1.0)
        begun = served.now
        with driver(served, rate=1000) as tips:
            samples = tips.wait(40, COMING)
            rejected = tips.statistics().rejected
    assert samples.device_time[0] > begun and rejected == 0


def test_a_kilohertz_without_a_loss(tmp_path: Path) -> None:
    pytest.importorskip("serial")
    seconds = size(1.5, 60.0)
    with (
        nothing_left(),
        serving(tmp_path, EmulatedFingertips(ramp)) as served,
        driver(served, rate=1000) as tips,
    ):
        parts, begun = [], time.monotonic()
        while time.monotonic() - begun < seconds:
            time.sleep(0.02)
            parts.append(tips.take())
        statistics, status = tips.statistics(), tips.status()
    device_time = np.concatenate([part.device_time for part in parts])
    # A slow machine starts late and stops late: what counts is that the device's own clock tells of no gap.
    assert len(device_time) > 500 * seconds
    assert (statistics.lost, statistics.rejected, statistics.overruns, status.overruns) == (0, 0, 0, 0)
    np.testing.assert_allclose(np.diff(device_time), 1e-3, atol=2e-6)
    voltage = np.concatenate([part.voltage for part in parts])
    np.testing.assert_allclose(voltage[:, 0], device_time * 1e-3, atol=1e-8)


def test_times_are_the_host_s() -> None:
    """A device whose clock runs 0.2 % fast: its samples' times on the host's clock are when they were taken."""
    tips, line = lockstep(EmulatedFingertips(ramp, DeviceModel(drift=2e-3)), rate=200)
    begun = line.clock()
    line.advance(5.0)
    tips.take()
    line.advance(0.25)
    samples = tips.take()
    true = begun + samples.voltage[:, 0] * 1e3  # the ramp is in true time
    assert len(samples) >= 50 and np.median(abs(samples.time - true)) < 2e-3
    assert (np.diff(samples.time) >= 0).all() and (samples.time <= samples.arrival).all()


def test_lockstep_gives_exactly_the_samples_of_each_step() -> None:
    device = EmulatedFingertips(ramp, DeviceModel(chain=ADS1115), rng=np.random.default_rng(1))
    tips, line = lockstep(device)
    begun = line.clock()
    for step in range(size(500, 50_000)):
        line.advance(0.02)
        samples = tips.take()
        assert len(samples) == 2
        np.testing.assert_allclose(samples.time - begun, [0.02 * step + 0.01, 0.02 * step + 0.02], atol=2e-6)
    assert tips.statistics().lost == 0


def test_lockstep_is_the_same_every_time() -> None:
    def run() -> bytes:
        source = press_source("glass", hold=0.5)
        device = EmulatedFingertips(source, DeviceModel(chain=ADS1115), rng=np.random.default_rng(5))
        tips, line = lockstep(device, setpoint=36.0)
        for _ in range(100):
            line.advance(0.02)
        samples = tips.take()
        return samples.voltage.tobytes() + samples.thermostat.tobytes() + samples.time.tobytes()

    assert run() == run()


def test_lockstep_tells_silence() -> None:
    device = EmulatedFingertips()
    tips, line = lockstep(device)
    device.stall_until = 5.0
    line.advance(1.0)
    with pytest.raises(StaleSensorError):
        tips.take()


def test_calibration_is_kept_by_the_device_and_applied_by_the_host() -> None:
    device = EmulatedFingertips(lambda time: Feel((1e-3, 2e-3), (0, 0), ((1, 2, 3), (4, 5, 6)), (36.0, 36.0)))
    tips, line = lockstep(device)
    tips.set_calibration(CONSTANTS)
    device.reboot()
    again, line = lockstep(device)
    assert again.calibration == tips.calibration == CONSTANTS
    line.advance(0.1)
    samples = again.take()
    np.testing.assert_allclose(samples.voltage[0], [(1e-3 - 20e-6) * 1.01, (2e-3 + 10e-6) * 0.98], rtol=1e-12)
    np.testing.assert_allclose(samples.thermostat[0], [35.5, 36.25], rtol=1e-12)
    np.testing.assert_allclose(samples.force[0], [[0.9 * 1.05, 2, 3], [4, 4.8, 6 * 1.1]], rtol=1e-12)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("voltage_gain", (math.nan, 0.0)),
        ("voltage_gain", (0.0, -1.0)),
        ("force_gain", ((-1.0, 0.0, 0.0), (0.0, 0.0, 0.0))),
        ("force_gain", ((-3.0, 0.0, 0.0), (0.0, 0.0, 0.0))),
        ("thermostat_offset", (math.nan, 0.0)),
    ],
)
def test_constants_that_leave_nothing_of_a_measurement(name: str, value: Any) -> None:
    """They are refused, for a force that is always 0 or below trips no guard; those that a device has are told."""
    device = EmulatedFingertips(lambda time: Feel((1e-3, 2e-3), (0, 0), ((9, 0, 0), (9, 0, 0)), (36.0, 36.0)))
    tips, line = lockstep(device)
    with pytest.raises(InvalidValueError, match=f"{name} must be finite"):
        tips.set_calibration(Calibration(**{name: value}))
    assert tips.calibration == Calibration()
    tips.calibration = Calibration(**{name: value})  # as if another program had stored them
    line.advance(0.1)
    samples = tips.take()
    missing = {
        "voltage": (Flag.NO_VOLTAGE_LEFT, samples.voltage),
        "thermostat": (Flag.OPEN_LEFT, samples.thermostat),
        "force": (Flag.NO_FORCE_LEFT, samples.force[:, :, 0]),
    }
    for flag, values in missing.values():
        assert (flag in samples.faults) == bool(np.isnan(values[:, 0]).all())


def test_a_setpoint_is_meant_as_calibrated() -> None:
    device = EmulatedFingertips()
    tips, line = lockstep(device)
    tips.set_setpoint(36.0, None)
    assert tips.thermostats().setpoint[0] == 36.0
    tips.set_calibration(CONSTANTS)
    report = tips.thermostats()
    assert report.setpoint[0] == 36.5
    assert report.setpoint[1] != report.setpoint[1]  # NaN: off
    samples = attended(tips, line, 20.0)
    assert samples.thermostat[-1, 0] == pytest.approx(36.0, abs=0.05)
    assert samples.thermostat[-1, 1] == pytest.approx(24.25, abs=0.05)


def test_the_thermostat_warms_up_with_the_power_it_has() -> None:
    """24 to 36 °C: heat capacity x 12 K at the heater's limit, less what is lost to the air."""
    plate = Thermostat()
    tips, line = lockstep(EmulatedFingertips(), setpoint=36.0)
    line.advance(1.0)
    power = tips.thermostats().power[0]
    assert power == pytest.approx(plate.power_limit, abs=1e-3)
    attended(tips, line, 30.0)
    report = tips.thermostats()
    assert report.temperature == pytest.approx((36.0, 36.0), abs=0.02)
    assert report.power[0] == pytest.approx(plate.loss * 12.0, rel=0.05)


@pytest.mark.parametrize(
    "act", [lambda tips: tips.set_rate(5000), lambda tips: tips.set_setpoint(90.0, None)]
)
def test_what_the_device_refuses(act) -> None:  # noqa: ANN001
    tips, _ = lockstep(EmulatedFingertips())
    with pytest.raises(CommandRefusedError, match="refuses this value"):
        act(tips)


def test_self_test_finds_what_is_broken() -> None:
    device = EmulatedFingertips()
    tips, _ = lockstep(device)
    assert tips.self_test().failed == 0
    device.broken_thermistors.add(0)
    device.broken_heaters.add(1)
    assert tips.self_test().failed == 0x02 | 0x10
    assert tips.self_test(checks=0x02).failed == 0x02


def test_a_busy_device_is_asked_again() -> None:
    device = EmulatedFingertips()
    tips, line = lockstep(device)
    device.executed.clear()
    tips._link.command(RunSelfTest(0x01))
    begun = line.clock()
    tips._link.command(RunSelfTest(0x02))  # refused while the first one runs
    assert line.clock() - begun > 0.2
    assert device.executed == [RunSelfTest(0x01), RunSelfTest(0x02)]


def test_a_press_is_felt() -> None:
    from thermograsp import thermal

    device = EmulatedFingertips(press_source("glass", touch=0.5, hold=2.0, apart=0.5, tolerance=0.05))
    tips, line = lockstep(device, setpoint=36.0)
    line.advance(2.4)
    samples = tips.take()
    step = thermal.press(
        "glass",
        conductance=lambda time: 1e4 if time >= 0.5 else 0.0,
        opposite=lambda time: 1e4 if time >= 0.5 else 0.0,
        seconds=2.4,
        dt=0.01,
    )
    expected = np.interp(samples.time, step.t, step.voltage)
    assert abs(samples.voltage[:, 0] - expected).max() < 1e-4
    assert (samples.force[samples.time < 0.49] == 0).all() and (
        samples.force[samples.time > 0.51, :, 0] == 10
    ).all()


def test_samples_can_be_felt_again() -> None:
    tips, line = lockstep(EmulatedFingertips(ramp))
    line.advance(1.0)
    first = tips.take()
    tips, line = lockstep(EmulatedFingertips(samples_source(first)))
    line.advance(1.0)
    second = tips.take()
    shift = len(first) - len(set(second.voltage[:, 0]) & set(first.voltage[:, 0]))
    assert shift <= 1
    with pytest.raises(ValueError, match="too few"):
        samples_source(Fingertips(line.open, clock=line.clock, background=False).take())


def test_without_pyserial_the_extra_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import sys

    from thermograsp.errors import MissingDependencyError

    monkeypatch.setitem(sys.modules, "serial", None)
    with pytest.raises(MissingDependencyError, match=r"thermograsp\[hardware\]"):
        Fingertips(str(tmp_path / "port"))


def test_a_source_that_breaks_is_told(tmp_path: Path) -> None:
    served = PtyDevice(EmulatedFingertips(lambda time: Feel(thermostat=(1e3 * (time > 0.2), 0.0))))
    with (
        pytest.raises(ValueError, match="thermostat must be -327.67 to 327.67"),
        served,
        driver(served) as tips,
    ):
        time.sleep(0.4)
        with pytest.raises(LinkLostError):
            tips.take()


def test_the_link_goes_with_the_device(tmp_path: Path) -> None:
    with nothing_left(), PtyDevice(EmulatedFingertips(), tmp_path / "name") as served:
        assert Path(served.path).is_symlink()
    assert not (tmp_path / "name").is_symlink()


@pytest.mark.parametrize("rate", ["100", 2.5, -1, 70_000, None, True])
def test_rates_that_cannot_be_are_refused_before_anything_is_sent(rate: Any) -> None:
    with pytest.raises(InvalidValueError, match="rate"):
        lockstep(EmulatedFingertips(), rate=rate)
    tips, line = lockstep(EmulatedFingertips())
    with pytest.raises(InvalidValueError, match="rate"):
        tips.set_rate(rate)
    line.advance(0.1)
    assert len(tips.take()) > 5


@pytest.mark.parametrize("seconds", [-1.0, math.nan, math.inf])
def test_virtual_time_goes_on(seconds: float) -> None:
    _, line = lockstep(EmulatedFingertips())
    with pytest.raises(InvalidValueError, match="seconds"):
        line.advance(seconds)
