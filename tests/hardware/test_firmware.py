"""The firmware in simavr under the driver that real devices get, in simulated time."""

import re
from pathlib import Path

import numpy as np
import pytest

from thermograsp.hardware import Calibration, CommandRefusedError, Flag
from thermograsp.hardware.protocol.decoder import Decoder
from thermograsp.hardware.protocol.frame import Frame, encode_frame
from thermograsp.hardware.protocol.messages import (
    Acknowledgement,
    Code,
    Identify,
    Identity,
    Request,
    SetRate,
    decode_message,
    encode_message,
)

from .board import Board
from .firmware_line import after, ask, attended, driven, sent

CONSTANTS = Calibration(
    date=1_700_000_000,
    voltage_offset=(20e-6, -10e-6),
    voltage_gain=(0.01, -0.02),
    thermostat_offset=(0.5, -0.25),
    force_offset=((0.1, 0.0, 0.0), (0.0, 0.2, 0.0)),
)


@pytest.mark.slow
def test_it_holds_36_degrees_and_streams_without_a_gap_for_a_minute(board: Board) -> None:
    """From 24 °C; after 20 s a contact draws 0.3 W from one plate, after 40 s no longer."""
    board.signals.voltage[:] = (1.234e-3, -5.678e-3)
    tips, line = driven(board, rate=100, setpoint=36.0)
    begun, plates, parts = line.clock(), [], []
    for step in range(600):
        board.signals.heat[0] = 0.3 if 200 <= step < 400 else 0.0
        line.advance(0.1)
        parts.append(tips.take())
        plates.append(tuple(board.signals.plate))
    statistics = tips.statistics()
    assert abs(np.array(plates)[100:] - 36.0).max() < 0.1
    thermostat = np.concatenate([part.thermostat for part in parts])
    assert abs(thermostat[1000:] - 36.0).max() < 0.1
    device_time = np.concatenate([part.device_time for part in parts])
    assert len(device_time) >= 100 * (line.clock() - begun) - 1 - 1e-6  # the clock's rounding
    assert abs(np.diff(device_time) - 0.01).max() < 1e-3  # while a command is answered
    assert np.median(abs(np.diff(device_time) - 0.01)) < 10e-6
    assert (statistics.lost, statistics.rejected, statistics.late, statistics.duplicates) == (0, 0, 0, 0)
    assert tips.status().overruns == 0
    voltage = np.concatenate([part.voltage for part in parts])
    assert abs(voltage.mean(axis=0) - (1.234e-3, -5.678e-3)).max() < 1e-6
    assert voltage.std(axis=0) == pytest.approx(7.8125e-6 * np.sqrt(1 + 1 / 12), rel=0.1)
    assert abs(voltage / 7.8125e-6 - np.rint(voltage / 7.8125e-6)).max() < 1e-3


def test_the_same_run_gives_the_same_bytes(made: tuple[Path, str]) -> None:
    def run() -> bytes:
        board = Board(made[0])
        board.advance(0.05)
        board.receive(encode_frame(Frame(Code.SET_RATE, 0, 3, 0, encode_message(SetRate(50)))))
        for step in range(1, 31):
            board.advance(0.1 * step)
            board.outgoing()
        board.close()
        return bytes(board.wire)

    first = run()
    assert first == run() and len(first) > 4000


def test_what_it_takes_of_flash_and_memory(made: tuple[Path, str], board: Board) -> None:
    """Of 32 kB without the bootloader's, and of 2 kB, where the stack has its room as well."""
    flash, static = (int(found) for found in re.findall(r"(?:Program|Data): +(\d+) bytes", made[1]))
    assert flash < 12_000
    tips, line = driven(board, rate=100, setpoint=36.0)
    tips.set_calibration(CONSTANTS)
    tips.self_test()
    line.advance(1.1)
    tips.thermostats()
    free = [board.memory(address) for address in range(0x100 + static, 0x900)]
    untouched = next(i for i, byte in enumerate(free) if byte)
    assert untouched > 512


def test_samples_are_the_board_s(board: Board) -> None:
    board.signals.noise = 0.0
    board.signals.voltage[:] = (0.1234, -0.0567)
    board.signals.force[:] = (10.0, 1.0, -2.0, 20.0, 3.0, -4.0)
    board.signals.plate[:] = board.signals.thermistor[:] = (31.5, 22.25)
    board.signals.heat_capacity = 1e9
    tips, line = driven(board)
    samples = after(tips, line, 0.5)
    assert abs(samples.voltage - (0.1234, -0.0567)).max() <= 7.8125e-6 / 2 + 1e-9
    assert abs(samples.thermostat - (31.5, 22.25)).max() < 0.02
    assert abs(samples.force.mean(axis=0) - [[10, 1, -2], [20, 3, -4]]).max() < 0.25  # two steps of 10 bits
    assert not samples.faults


@pytest.mark.parametrize("rate", [1, 10, 30, 50, 100])
def test_every_rate_comes_at_that_rate(board: Board, rate: int) -> None:
    tips, line = driven(board, rate=rate)
    samples = after(tips, line, 3.0)
    assert abs(len(samples) - 3 * rate) <= 1
    assert abs(np.diff(samples.device_time) - 1 / rate).max() <= (1e-3 if 100 % rate == 0 else 0.01)
    tips.set_rate(0)
    tips.take()
    assert len(after(tips, line, 0.5)) == 0


def test_the_supply_is_measured_and_made_up_for(board: Board) -> None:
    """Temperatures are by ratio, and a heater's power follows the square of the voltage."""
    board.signals.supply = 4.6
    board.signals.ambient = 24.0
    tips, line = driven(board, setpoint=36.0)
    attended(tips, line, 12.0)
    assert tips.status().supply == pytest.approx(4.6, abs=0.001)
    assert abs(np.array(board.signals.plate[:]) - 36.0).max() < 0.1
    assert tips.thermostats().power == pytest.approx(board.signals.power[:], abs=0.02)


def test_reports_come_once_a_second(board: Board) -> None:
    tips, line = driven(board, rate=10, setpoint=30.0)
    line.advance(3.0)
    tips.take()
    assert 3 <= len(sent(board, Code.STATUS)) <= 4
    assert 3 <= len(sent(board, Code.THERMOSTAT)) <= 4
    assert tips.status().uptime == 3
    tips.set_rate(0)
    before = len(sent(board, Code.STATUS))
    line.advance(2.0)
    assert len(sent(board, Code.STATUS)) == before


def test_constants_outlive_a_reset_and_boots_are_counted(board: Board) -> None:
    tips, line = driven(board)
    assert tips.calibration == Calibration() and tips.identity.boots == 1
    tips.set_calibration(CONSTANTS)
    assert tips.calibration == CONSTANTS
    assert len(after(tips, line, 1.0)) == 100
    board.reset()
    line.advance(0.1)
    again, _ = driven(board)
    assert again.calibration == CONSTANTS and again.identity.boots == 2


def test_from_boot_until_identify_it_does_nothing(board: Board) -> None:
    board.advance(1.0)
    (boot,) = Decoder().feed(b"".join(board.outgoing()))
    assert boot.code == Code.IDENTITY and boot.flags == Flag.UNIDENTIFIED and boot.sequence == 0
    assert board.signals.power[:] == [0.0, 0.0]
    identity, answer = ask(board, Identify(1, 1, 77), 5)
    assert not identity.flags and identity.sequence == 1
    assert decode_message(answer.code, answer.payload) == Acknowledgement(5, Code.IDENTIFY, 0)


@pytest.mark.parametrize(
    ("oldest", "newest", "protocol"), [(2, 2, (2, 0)), (0, 9, (2, 0)), (1, 1, (0, 0)), (3, 9, (0, 0))]
)
def test_versions_are_negotiated(board: Board, oldest: int, newest: int, protocol: tuple[int, int]) -> None:
    board.advance(0.1)
    board.outgoing()
    frame = ask(board, Identify(oldest, newest, 1), 1)[0]
    identity = decode_message(frame.code, frame.payload)
    assert isinstance(identity, Identity) and identity.protocol == protocol


def test_what_is_out_of_range_is_refused(board: Board) -> None:
    tips, _ = driven(board, setpoint=30.0)
    for act in (
        lambda: tips.set_rate(101),
        lambda: tips.set_setpoint(60.01, 20),
        lambda: tips.set_setpoint(20, -0.01),
    ):
        with pytest.raises(CommandRefusedError, match="refuses this value"):
            act()
    assert tips.thermostats().setpoint == (30.0, 30.0)
    board.outgoing()
    (answer,) = [f for f in ask(board, Request(Code.SAMPLE), 9) if f.code == Code.ACKNOWLEDGEMENT]
    assert decode_message(answer.code, answer.payload) == Acknowledgement(9, Code.REQUEST, 1)
