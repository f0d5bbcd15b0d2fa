"""From recordings of an emulated device to a fitted sensor that the simulation loads, by the command line."""

import json
from dataclasses import replace
from pathlib import Path

import gymnasium
import numpy as np
import pytest

import thermograsp  # noqa: F401  (registers the environments)
from thermograsp.cli import main
from thermograsp.errors import InvalidValueError
from thermograsp.hardware import (
    DeviceModel,
    EmulatedFingertips,
    Feel,
    Fingertips,
    Recorder,
    SensorFaultError,
    VirtualLine,
    known_touch,
    press_source,
)
from thermograsp.hardware.protocol.samples import Samples
from thermograsp.thermal import ADS1115, press, sensor
from thermograsp.thermal.fitting.model import UNITS, shared_of, with_shared

DELAY = 0.05  # s
TRUE = {"seebeck": 0.9e-3, "conductivity": 1.3, "heat_capacity": 1.4e6, "offset": 0.0, "delay": 0.0}
HELD = 2.5  # s


def record(
    file: Path, material: str, conductance: float, rng: np.random.Generator, celsius: float = 24.0
) -> None:
    """A touch of both fingertips on an object of that temperature, °C, after a second, on an ADS1115, in virtual time;
    voltages come late."""
    source = press_source(
        material,
        sensor=with_shared(sensor("seed"), TRUE),
        conductance=conductance,
        object_temperature=celsius,
        touch=1.0 + 1e-3 * int(rng.integers(20)),
        hold=HELD,
        apart=0.2,
        dt=1e-3,
        tolerance=0.003,
    )

    def late(time: float) -> Feel:
        return replace(source(time), voltage=source(max(time - DELAY, 0.0)).voltage, thermostat=(36.0, 36.0))

    line = VirtualLine(EmulatedFingertips(late, DeviceModel(chain=ADS1115), rng=rng))
    with Recorder(file) as recorder:
        tips = Fingertips(line.open, clock=line.clock, background=False, rate=400, tap=recorder)
        for _ in range(37):
            line.advance(0.1)
            tips.take()


@pytest.fixture(scope="module")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """Of ten touches, as the command takes them."""
    return recorded(tmp_path_factory.mktemp("recordings"), 10)


@pytest.fixture(scope="module")
def few(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """The first three of them."""
    return recorded(tmp_path_factory.mktemp("few"), 3)


def recorded(folder: Path, count: int) -> list[str]:
    rng, named = np.random.default_rng(20), []
    for k, conductance in enumerate(np.geomspace(3e3, 2e4, 5).tolist()):
        for material in ("glass", "aluminium"):
            if len(named) == count:
                break
            file = folder / f"{material}{k}.tgr"
            record(file, material, conductance, rng)
            named.append(f"{material}={file}" if k else f"{material}@24={file}")
    return named


@pytest.mark.slow
def test_ten_recordings_tell_the_sensor_to_2_percent_and_the_simulation_loads_it(
    recordings: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    preset = tmp_path / "left.toml"
    assert main(["device", "fit", *recordings, "--save", str(preset), "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    true = {**TRUE, "offset": ADS1115.offset, "delay": DELAY}
    for name in UNITS:
        found = summary["shared"][name]
        assert found["value"] == pytest.approx(true[name], rel=0.02), name
        assert found["low"] < found["value"] < found["high"] and found["unit"] == UNITS[name]
    conductances = [touch["conductance"]["value"] for touch in summary["touches"]]
    np.testing.assert_allclose(conductances, np.repeat(np.geomspace(3e3, 2e4, 5), 2), rtol=0.02)
    assert summary["untold"] == [] and summary["preset"] == str(preset)

    text = preset.read_text()
    assert text.startswith("# Fitted to 10 touches of the left fingertip (aluminium, glass); 95% intervals:")
    assert sensor(preset).name == "left"
    assert shared_of(sensor(preset))["conductivity"] == pytest.approx(TRUE["conductivity"], rel=0.02)
    pressed = press("marble", sensor=str(preset), seconds=3.0).voltage
    expected = press("marble", sensor=with_shared(sensor("seed"), TRUE), seconds=3.0).voltage
    np.testing.assert_allclose(pressed, expected, atol=0.02 * expected.max())
    env = gymnasium.make("thermograsp/Grasp-v0", sensor=str(preset), material="glass")
    env.reset(seed=0)
    env.close()


@pytest.mark.slow
def test_the_recipe_two_touches_tell_the_sensor_and_a_third_colder_one_agrees(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A metal, glass, and glass 10 K colder: what docs/hardware.md recommends and what it says of the accuracy."""
    rng, files = np.random.default_rng(3), []
    for material, celsius in (("aluminium", 24.0), ("glass", 24.0), ("glass", 14.0)):
        files.append(tmp_path / f"{material}{celsius:g}.tgr")
        record(files[-1], material, 8e3, rng, celsius)
    metal, glass, cold = files
    fits = []
    for words in ([f"aluminium={metal}", f"glass={glass}"], [f"glass@14={cold}"]):
        preset = tmp_path / f"{len(words)}.toml"
        start = [] if not fits else ["--start", str(tmp_path / "2.toml"), "--hold", "conductivity"]
        assert main(["device", "fit", *words, *start, "--save", str(preset), "--json"]) == 0
        fits.append(json.loads(capsys.readouterr().out)["shared"])
    first, check = fits
    for name in ("seebeck", "conductivity", "heat_capacity"):
        assert first[name]["value"] == pytest.approx(TRUE[name], rel=0.01), name
    assert check["seebeck"]["value"] == pytest.approx(first["seebeck"]["value"], rel=0.005)


def test_what_recordings_do_not_tell_is_no_success(
    few: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    preset = tmp_path / "sensor.toml"
    words = ["device", "fit", few[2], "--fingertip", "right", "--save", str(preset)]
    assert main(words) == 1
    out = capsys.readouterr().out
    assert "not told: seebeck and conductivity are told only together" in out and f"wrote {preset}" in out
    assert "# not told: seebeck" in preset.read_text()
    assert main([*words, "--hold", "conductivity", "--hold", "heat_capacity"]) == 0
    kept = shared_of(sensor(preset))
    assert kept["conductivity"] == shared_of(sensor("seed"))["conductivity"]
    assert "conductivity" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["glass"], "give MATERIAL=FILE"),
        (["glass@warm=a.tgr"], "give MATERIAL=FILE"),
        (["glas=FILE"], "did you mean 'glass'"),
        (["glass=/nowhere.tgr"], "cannot read"),
        (["glass=FILE", "--fingertip", "middle"], "known: left, right"),
        (["glass=FILE", "--chain", "ads"], "did you mean 'ads1115'"),
        (["glass=FILE", "--hold", "gain"], "unknown parameter 'gain'"),
        (["glass=FILE", "--save", "sensor.txt"], ".toml"),
        (["glass@35.9=FILE"], "heat the thermostat"),
        (["cotton=FILE"], "ends at a bound"),
    ],
)
def test_a_fit_that_cannot_be(
    few: list[str], words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    file = few[0].partition("=")[2]
    assert main(["device", "fit", *(word.replace("FILE", file) for word in words)]) == 2
    assert said in capsys.readouterr().err


def samples(force: np.ndarray, **changed: np.ndarray) -> Samples:
    """At 100 Hz, the left pad's normal force given."""
    n = len(force)
    values = {
        "time": np.arange(n) / 100,
        "device_time": np.arange(n) / 100,
        "arrival": np.arange(n) / 100,
        "voltage": np.zeros((n, 2)),
        "thermostat": np.tile((36.0, 35.0), (n, 1)),
        "force": np.pad(force[:, None, None], ((0, 0), (0, 1), (0, 2))),
        "flags": np.zeros(n, np.uint8),
        "lost": np.zeros(n, int),
    }
    return Samples(**{**values, **changed})


def test_the_first_touch_is_cut_out() -> None:
    force = np.concatenate((np.zeros(300), np.full(150, 10.0), np.zeros(50), np.full(100, 10.0)))
    touch = known_touch(samples(force), "glass", name="a", object_temperature=20.0)
    assert len(touch.t) == 200 + 150  # 2 s before, to the release
    assert touch.t[200] == pytest.approx(0.005) and touch.t[199] == pytest.approx(-0.005)
    assert touch.difference == pytest.approx(16.0) and touch.fingertips == 1
    assert touch.touch_error == pytest.approx(0.01 / 12**0.5)
    both = samples(force)
    both.force[:, 1, 0] = force
    assert known_touch(both, "glass", fingertip=1).fingertips == 2
    assert known_touch(both, "glass", fingertip=1).difference == pytest.approx(11.0)
    long = np.concatenate((np.zeros(20), np.full(900, 10.0)))
    assert known_touch(samples(long), "glass").t[-1] == pytest.approx(5.0, abs=0.011)


def test_samples_without_a_usable_touch() -> None:
    force = np.concatenate((np.zeros(100), np.full(150, 10.0)))
    for none in (np.zeros(100), np.full(100, 10.0), np.zeros(0)):
        with pytest.raises(InvalidValueError, match="never rises"):
            known_touch(samples(none), "glass")
    flags = np.zeros(250, np.uint8)
    flags[150] = 0x01
    with pytest.raises(SensorFaultError, match="left voltage"):
        known_touch(samples(force, flags=flags), "glass")
    assert (
        known_touch(samples(force, flags=2 * flags), "glass").difference == 12.0
    )  # the other fingertip's fault
    rebooted = np.arange(250) / 100
    rebooted[150:] -= 1.5
    with pytest.raises(InvalidValueError, match="must rise"):
        known_touch(samples(force, device_time=rebooted), "glass")
