"""From temperature to record, presets in files, and what is refused."""

from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from scipy.signal import butter, lfilter, savgol_filter

from thermograsp import thermal
from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.thermal.matter import Layer
from thermograsp.thermal.stack import (
    Divider,
    ForceContact,
    HeatedStack,
    Place,
    Recorder,
    heated_stack,
    heated_stacks,
    load_heated_stacks,
)


def test_the_recorder_filters_as_scipy_does_sample_by_sample() -> None:
    curve = np.random.default_rng(0).standard_normal((1, 300)).cumsum(axis=1)
    recorder = Recorder(rate=200.0, corner=10.0, order=2, window=99, degree=3)
    b, a = cast(Any, butter(2, 0.1))
    low = lfilter(b, a, curve - curve[:, :1]) + curve[:, :1]
    assert recorder.record(curve, 0.005) == pytest.approx(savgol_filter(low, 99, 3), abs=1e-9)


def test_the_low_pass_is_causal_and_the_smoothing_looks_ahead() -> None:
    late = np.zeros((1, 400))
    late[0, 200] = 1.0
    causal = Recorder(rate=50.0, corner=5.0).record(late, 0.02)
    assert np.abs(causal[0, :200]).max() < 1e-12
    assert np.abs(Recorder(rate=50.0, window=25).record(late, 0.02)[0, 188:200]).max() > 0.01


def test_a_record_shorter_than_the_window_is_refused() -> None:
    with pytest.raises(InvalidValueError, match="shorter than the recorder's window"):
        Recorder(rate=200.0, window=99).record(np.zeros((1, 20)), 0.02)


def test_a_divider_reads_back_its_temperature() -> None:
    degrees = np.array([0.0, 25.0, 60.0])
    divider = Divider()
    assert divider.temperature(divider.voltage(degrees)) == pytest.approx(degrees)
    assert divider.voltage(np.array(25.0)) == pytest.approx(3.3 / 2)


def test_presets_are_the_sensors_of_the_same_name() -> None:
    for name, stack in heated_stacks().items():
        assert stack.layers == thermal.sensor(name).layers
    with pytest.raises(UnknownNameError, match="heated_thermistor"):
        heated_stack("heated_thermister")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('kind = "cut_at_contact"', 'kind = "cut"', "unknown heater law 'cut'"),
        ("readout = { layer = 1,", "readout = { layer = 5,", "readout in layer 5"),
        ("backing = {", "behind = {", "unknown entry 'behind'"),
        ("window = 99", "window = 98", "odd number"),
        ("preload = 0.7405", "preload = 4.5", "preload must be below"),
    ],
)
def test_a_broken_file_is_named_with_what_is_wrong(tmp_path: Path, old: str, new: str, message: str) -> None:
    from thermograsp.assets import asset

    text = asset("sensors.toml").read_text(encoding="utf-8")
    assert old in text
    file = tmp_path / "own.toml"
    file.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(InvalidValueError, match=message) as raised:
        load_heated_stacks(file)
    assert str(file) in str(raised.value)


def test_places_outside_the_stack_are_refused() -> None:
    layer = Layer("cover", 1e-3, 0.5, 1500.0, 1400.0)
    with pytest.raises(InvalidValueError, match="heater in layer 1"):
        HeatedStack("pad", (layer,), Place(0, 0.5), Place(1, 0.0), ForceContact(1000.0))
    with pytest.raises(InvalidValueError, match="depth"):
        Place(0, 1.5)


def test_a_preset_may_be_put_on_an_ideal_thermostat() -> None:
    element = thermal.sensor("heated_thermistor")
    drops = [
        thermal.press(name, sensor=element, seconds=3.0, rung="layered").temperature_drop[-1]
        for name in ("aluminium", "wood")
    ]
    assert drops[0] > drops[1] > 0
