"""A sensor's properties fitted to touches: against an independent solver, with noise, and where nothing can be told."""

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Literal

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.thermal import (
    ADS1115,
    IDEAL,
    KnownTouch,
    SensorStack,
    fit_sensor,
    load_sensors,
    material,
    measure,
    press,
    sensor,
    settled,
    write_sensor,
)
from thermograsp.thermal.fitting.model import (
    POSITIVE,
    TouchModel,
    shared_of,
    with_shared,
)

TRUE = {"seebeck": 1.13e-3, "offset": 40e-6, "delay": 0.05, "conductivity": 1.85, "heat_capacity": 1.35e6}
STEP = 1e-3  # s, of curves
CHAIN = replace(
    ADS1115, offset=0.0, gain_error=0.0
)  # both are what TRUE's offset and Seebeck coefficient stand for


def times(rate: float, seconds: float = 4.0) -> np.ndarray:
    return np.arange(-1.0, seconds, 1 / rate)


@cache
def curve(name: str, conductance: float, fingertips: Literal[1, 2]) -> np.ndarray:
    """V of the true sensor by a network, every millisecond from 1.5 s before the touch, behind the low-pass."""
    found = press(
        name,
        sensor=with_shared(sensor("seed"), TRUE),
        conductance=conductance,
        opposite=conductance if fingertips == 2 else None,
        seconds=4.5,
        dt=STEP,
        tolerance=0.003,
        rung="network",
    )
    volts = np.concatenate((np.zeros(1500), found.voltage))[None]
    return measure(
        replace(IDEAL, bandwidth=CHAIN.bandwidth), settled(np.zeros(1), 1.0), volts, 1.0, STEP, volts
    )[1][0]


def recorded(
    name: str, conductance: float, rate: float, rng: np.random.Generator, fingertips: Literal[1, 2] = 1
) -> KnownTouch:
    """By the load cell the touch lies between two samples; the converter adds noise and rounds."""
    t = times(rate)
    late = rng.uniform(-0.5, 0.5) / rate
    volts = curve(name, conductance, fingertips)
    seen = np.interp(t - TRUE["delay"] - late, np.arange(len(volts)) * STEP - 1.5, volts) + TRUE["offset"]
    seen = measure(
        replace(CHAIN, bandwidth=np.inf),
        settled(np.zeros(1), 1.0),
        seen[None],
        1.0,
        1 / rate,
        rng.standard_normal((1, len(t))),
    )[1][0]
    return KnownTouch(
        name, t, seen, material(name), 12.0, fingertips=fingertips, touch_error=1 / rate / 12**0.5
    )  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize(("name", "fingertips"), [("glass", 1), ("aluminium", 2)])
def test_the_response_is_that_of_a_network(name: str, fingertips: Literal[1, 2]) -> None:
    t = times(100.0)
    touch = KnownTouch(name, t, t, material(name), 12.0, fingertips=fingertips)
    model = TouchModel([touch], sensor("seed"), CHAIN.bandwidth)  # started from another sensor
    volts = model.voltage(0, {**TRUE, "delay": 0.0}, 8e3, 0.0) - TRUE["offset"]
    expected = np.interp(t, np.arange(6001) * STEP - 1.5, curve(name, 8e3, fingertips))
    np.testing.assert_allclose(volts, expected, atol=0.006 * TRUE["seebeck"])  # of 12 K


def test_slopes_are_differences_of_voltages() -> None:
    t = times(100.0, 2.0)
    model = TouchModel([KnownTouch("glass", t, t, material("glass"), 12.0)], sensor("seed"), 30.0)
    slopes = model.slopes(0, TRUE, 7e3, 0.002)
    for name, slope in slopes.items():
        ends = []
        for sign in (1.0, -1.0):
            step = sign * (1e-3 if name in (*POSITIVE, "conductance") else 1e-5)
            if name == "conductance":
                ends.append(model.voltage(0, TRUE, 7e3 * np.exp(step), 0.002))
            else:
                moved = TRUE[name] * np.exp(step) if name in POSITIVE else TRUE[name] + step
                ends.append(model.voltage(0, {**TRUE, name: moved}, 7e3, 0.002))
        difference = (ends[0] - ends[1]) / (2e-3 if name in (*POSITIVE, "conductance") else 2e-5)
        np.testing.assert_allclose(slope, difference, atol=1e-4 * abs(slope).max(), err_msg=name)


def test_six_noisy_touches_tell_the_sensor() -> None:
    rng = np.random.default_rng(7)
    conductances = np.geomspace(3e3, 2e4, 3)
    touches = [
        recorded(name, h, 400.0, rng) for h in conductances.tolist() for name in ("glass", "aluminium")
    ]
    fit = fit_sensor(touches, chain=CHAIN)
    for name, estimate in fit.shared.items():
        assert estimate.value == pytest.approx(TRUE[name], rel=0.03 if name == "delay" else 0.02), name
        assert estimate.low < estimate.value < estimate.high
    found = [estimate.value for estimate in fit.conductances]
    np.testing.assert_allclose(found, np.repeat(conductances, 2), rtol=0.02)
    assert fit.untold == ()
    assert max(fit.misfit) < 0.01 and fit.noise == pytest.approx(np.hypot(1, 12**-0.5) * CHAIN.noise, rel=0.1)
    assert isinstance(fit.stack, SensorStack)
    assert with_shared(fit.stack, shared_of(fit.stack)) == fit.stack
    assert fit.stack.layers[0] == sensor("seed").layers[0]


@pytest.mark.slow
def test_intervals_hold_the_truth_as_often_as_they_say() -> None:
    t, conductances = times(100.0, 2.0), (4e3, 8e3, 1e4, 1.5e4)
    names = ("glass", "aluminium", "glass", "aluminium")
    blank = [KnownTouch(name, t, t, material(name), 12.0, touch_error=0.01 / 12**0.5) for name in names]
    model = TouchModel(blank, with_shared(sensor("seed"), TRUE), CHAIN.bandwidth)
    held, total = 0, 0
    for seed in range(10):
        rng = np.random.default_rng(seed)
        touches = []
        for r, touch in enumerate(blank):
            late = rng.uniform(-0.005, 0.005)
            noise = CHAIN.noise * rng.standard_normal(len(t))
            touches.append(replace(touch, voltage=model.voltage(r, TRUE, conductances[r], late) + noise))
        fit = fit_sensor(touches, chain=replace(CHAIN, bits=0), confidence=0.8)
        held += sum(e.low < TRUE[name] < e.high for name, e in fit.shared.items())
        held += sum(e.low < h < e.high for e, h in zip(fit.conductances, conductances, strict=True))
        total += len(fit.shared) + len(conductances)
    assert 0.7 < held / total < 0.9


def test_what_cannot_be_told_is_named_and_what_is_held_stays() -> None:
    start = with_shared(sensor("seed"), TRUE)
    fit = fit_sensor([recorded("cotton", 2e3, 100.0, np.random.default_rng(3))], chain=CHAIN, start=start)
    assert any("seebeck and conductivity are told only together" in sentence for sentence in fit.untold)
    assert any("seebeck is only known to lie between" in sentence for sentence in fit.untold)
    glass = recorded("glass", 2e3, 100.0, np.random.default_rng(3))
    fit = fit_sensor([glass], chain=CHAIN, start=start, hold=["heat_capacity"])
    assert fit.shared["heat_capacity"].low == fit.shared["heat_capacity"].high == pytest.approx(1.35e6)
    assert fit.shared["seebeck"].low < TRUE["seebeck"] < fit.shared["seebeck"].high


def test_nonsense_is_refused() -> None:
    rng = np.random.default_rng(4)
    glass = recorded("glass", 1e4, 100.0, rng)
    with pytest.raises(InvalidValueError, match="no touches"):
        fit_sensor([])
    with pytest.raises(InvalidValueError, match="nothing is felt"):
        fit_sensor([replace(glass, voltage=1e-5 * rng.standard_normal(len(glass.t)))])
    with pytest.raises(UnknownNameError, match="did you mean 'delay'"):
        fit_sensor([glass], hold=["delai"])
    with pytest.raises(InvalidValueError, match="confidence"):
        fit_sensor([glass], confidence=95.0)
    with pytest.raises(InvalidValueError, match="does not fit|bound"):
        fit_sensor([replace(glass, material=material("cotton")), recorded("aluminium", 1e4, 100.0, rng)])


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"difference": 0.1}, "heat the thermostat"),
        ({"difference": np.nan}, "finite"),
        ({"t": -times(100.0)}, "must rise"),
        ({"t": times(100.0) + 1.0}, "0 samples before the touch"),
        ({"t": times(100.0) - 4.0}, "0.00 s after"),
        ({"voltage": np.zeros(3)}, "alike"),
        ({"object_size": (0.0, 0.04, 0.01)}, "object_size"),
        ({"fingertips": 3}, "fingertips must be"),
        ({"touch_error": -1.0}, "touch_error"),
    ],
)
def test_what_no_touch_can_be(changed: dict[str, object], said: str) -> None:
    t = times(100.0)
    values = {"t": t, "voltage": np.zeros(len(t)), "difference": 12.0, **changed}
    with pytest.raises(InvalidValueError, match=said):
        KnownTouch("touch 3", material=material("glass"), **values)  # pyright: ignore[reportArgumentType]


def test_a_fitted_sensor_is_a_file_that_a_press_takes(tmp_path: Path) -> None:
    stack = replace(with_shared(sensor("seed"), TRUE), name='left "3"')
    file = tmp_path / "left.toml"
    write_sensor(file, stack, ["fitted", ""])
    assert sensor(str(file)) == sensor(file) == stack
    kept = press("glass", sensor=str(file), seconds=0.5, rung="layered")
    np.testing.assert_array_equal(
        kept.voltage, press("glass", sensor=stack, seconds=0.5, rung="layered").voltage
    )
    assert list(load_sensors(file)) == [stack.name]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "'sensors' is missing"),
        ("[sensors.a]\nwidth = 1", "'layers' is missing"),
        ("[sensors.a\n", "Expected"),
        ("[sensors.a]\nwidth=1\nsensed=0\nseebeck=-1\nlayers=[]", "no layers"),
        ("[sensors.a]\nsebeck=1\nlayers=[]", "unknown entry 'sebeck'"),
        ("[sensors]\na = 3", "a.toml"),
    ],
)
def test_a_file_that_is_no_sensor(tmp_path: Path, text: str, said: str) -> None:
    file = tmp_path / "a.toml"
    file.write_text(text)
    with pytest.raises(InvalidValueError, match=said):
        sensor(str(file))


def test_a_file_of_two_sensors_or_none_is_no_choice(tmp_path: Path) -> None:
    seed = sensor("seed")
    assert isinstance(seed, SensorStack)
    file = tmp_path / "two.toml"
    write_sensor(file, seed)
    text = file.read_text()
    file.write_text(text + text.replace('"seed"', "other"))
    with pytest.raises(InvalidValueError, match="holds 2 sensors"):
        sensor(file)
    with pytest.raises(InvalidValueError, match="cannot read"):
        sensor(tmp_path / "nowhere.toml")
    with pytest.raises(UnknownNameError, match="did you mean 'seed'"):
        sensor("sed")
