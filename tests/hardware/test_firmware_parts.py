"""The firmware's parts, compiled for this machine, beside the package's."""

import ctypes
import zlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thermograsp.hardware.protocol import cobs
from thermograsp.hardware.protocol.decoder import Decoder
from thermograsp.hardware.protocol.frame import encode_frame
from thermograsp.hardware.protocol.messages import LENGTHS
from thermograsp.thermal import Thermostat, ThermostatState, thermostat_step

from .board import Controller, Receiver, portable
from .test_protocol_page import GOLDEN


@pytest.fixture(scope="module")
def parts(made: tuple[Path, str]) -> ctypes.CDLL:
    return portable(made[0])


def framed(parts: ctypes.CDLL, wire: bytes) -> tuple[list[bytes], int]:
    """What the firmware's receiver takes for frames, without checksums, and how many chunks for none."""
    receiver, found = Receiver(), []
    for byte in wire:
        length = parts.receive(ctypes.byref(receiver), byte)
        if length:
            found.append(bytes(receiver.bytes[:length]))
    return found, receiver.bad


@pytest.mark.parametrize(("name", "header", "wire", "values"), GOLDEN, ids=[entry[0] for entry in GOLDEN])
def test_the_golden_frames(parts: ctypes.CDLL, name: str, header: dict, wire: bytes, values: dict) -> None:
    del name, header, values
    block = cobs.decode(wire[1:-1])
    assert block is not None
    assert framed(parts, wire) == ([block[:-4]], 0)
    assert parts.crc32(block[:-4], len(block) - 4) == int.from_bytes(block[-4:], "little")
    stuffed = ctypes.create_string_buffer(65)
    parts.cobs_encode(block, len(block), stuffed)
    assert stuffed.raw[: len(block) + 1] == wire[1:-1]


@given(st.binary(max_size=64))
def test_checksum_and_stuffing_are_the_package_s(parts: ctypes.CDLL, block: bytes) -> None:
    assert parts.crc32(block, len(block)) == zlib.crc32(block)
    stuffed = ctypes.create_string_buffer(66)
    parts.cobs_encode(block, len(block), stuffed)
    assert stuffed.raw[: len(block) + 1] == cobs.encode(block)
    if len(block) >= 8 and len(block) <= 60:
        wire = b"\0" + cobs.encode(block + zlib.crc32(block).to_bytes(4, "little")) + b"\0"
        assert framed(parts, wire) == ([block], 0)


@settings(max_examples=200)
@given(
    st.lists(
        st.one_of(st.binary(max_size=80), st.just(b"\0"), st.sampled_from([g[2] for g in GOLDEN])),
        max_size=20,
    )
)
def test_any_bytes_are_read_as_the_package_reads_them(parts: ctypes.CDLL, pieces: list[bytes]) -> None:
    wire = b"".join(pieces) + b"\0"
    known = [frame for frame in framed(parts, wire)[0] if len(frame) - 8 == LENGTHS.get(frame[0])]
    accepted = [encode_frame(frame) for frame in Decoder().feed(wire)]
    assert [b"\0" + cobs.encode(f + zlib.crc32(f).to_bytes(4, "little")) + b"\0" for f in known] == accepted


def test_the_controller_is_the_package_s(parts: ctypes.CDLL) -> None:
    """Random temperatures around the setpoint, so that both limits and windup occur: powers equal to a float's
    rounding."""
    rng = np.random.default_rng(2)
    model = Thermostat(sensor_lag=0.0, heat_capacity=1e12)
    controller = Controller(setpoint=36.0, measured=35.0, on=True)
    state = ThermostatState(*(np.array([value]) for value in (35.0, 35.0, 35.0, 0.0, 0.0)))
    measured, at_limits = 35.0, 0
    for _ in range(3000):
        previous, measured = measured, float(np.float32(36.0 + rng.normal(0, 0.3) + 0.5 * np.sin(_ / 200)))
        state = ThermostatState(
            state.temperature, np.array([measured]), np.array([previous]), state.integral, state.power
        )
        state = thermostat_step(model, state, np.zeros(1), 0.02)
        power = parts.thermostat_step(ctypes.byref(controller), measured, False)
        assert power == pytest.approx(float(state.power[0]), abs=2e-3)
        at_limits += power in (0.0, 5.0)
        controller.integral = float(state.integral[0])  # so that rounding does not add up
    assert 300 < at_limits < 2700
    assert parts.thermostat_step(ctypes.byref(controller), 30.0, True) == 0.0
    controller.on = False
    assert parts.thermostat_step(ctypes.byref(controller), 30.0, False) == 0.0


def test_the_thermistor_s_law(parts: ctypes.CDLL) -> None:
    """The vendor's B25/85 puts 10 kohm at 25 °C and 1070 ohm at 85 °C (within 1 %)."""
    assert parts.thermistor_temperature(0.5) == pytest.approx(25.0, abs=1e-3)
    assert parts.thermistor_temperature(1070 / 11070) == pytest.approx(85.0, abs=0.3)
    for celsius in np.linspace(0, 100, 21):
        resistance = np.exp(3977 * (1 / (celsius + 273.15) - 1 / 298.15))
        part = resistance / (1 + resistance)
        assert parts.thermistor_temperature(part) == pytest.approx(celsius, abs=2e-3)
        assert not parts.thermistor_broken(part)
    for part in (0.0, 0.81, 1.0, float("nan"), float("inf")):
        assert parts.thermistor_broken(part)
