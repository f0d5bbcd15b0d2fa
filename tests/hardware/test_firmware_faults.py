"""The firmware in simavr when its line, its sensors or its converters fail."""

import random
from pathlib import Path

import numpy as np
import pytest

from thermograsp.hardware import (
    Fingertips,
    Flag,
    LinkSettings,
    PtyDevice,
    VirtualLine,
)
from thermograsp.hardware.protocol.decoder import Decoder
from thermograsp.hardware.protocol.messages import (
    Check,
    Code,
    Identify,
    Request,
    SetRate,
    Status,
)

from .board import Board, build, require_tools
from .firmware_line import after, ask, driven, sent


class BadLine(VirtualLine[Board]):
    """Three of ten commands are lost on their way and as many come twice; three of ten answers are lost."""

    rng = random.Random(5)

    def write(self, data: bytes) -> None:
        for _ in range(self.rng.choice([0, 0, 0, 1, 1, 1, 1, 2, 2, 2])):
            super().write(data)

    def read(self, timeout: float) -> bytes:
        data = super().read(timeout)
        answers = [f for f in Decoder().feed(data) if f.code == Code.ACKNOWLEDGEMENT]
        return b"" if answers and self.rng.random() < 0.3 else data


def test_commands_through_a_bad_line_run_once(board: Board) -> None:
    """A self-test that ran twice would tell twice."""
    line = BadLine(board)
    patient = LinkSettings(tries=30)
    tips = Fingertips(line.open, clock=line.clock, background=False, settings=patient, rate=0)
    for count in range(1, 11):
        tips.self_test()
        tips.set_setpoint(20 + count, None)
        assert tips.thermostats().setpoint[0] == 20 + count
        assert len(sent(board, Code.SELF_TEST)) == count
    assert tips.status().repeats > 3 and tips.statistics().repeats > 10


def test_a_ninth_command_forgets_the_first(board: Board) -> None:
    board.advance(0.1)
    ask(board, Identify(1, 1, 1), 100)
    for number in range(9):
        ask(board, SetRate(number), number)
    ask(board, SetRate(0), 1)  # is remembered: not executed
    board.outgoing()
    assert last_status(board).rate == 8
    ask(board, SetRate(5), 0)  # is forgotten
    assert last_status(board).rate == 5
    ask(board, Identify(1, 1, 2), 101)  # another host: all is forgotten
    ask(board, SetRate(0), 3)
    assert last_status(board).rate == 0


def last_status(board: Board) -> Status:
    ask(board, Request(Code.STATUS), 999)
    status = sent(board, Code.STATUS)[-1]
    assert isinstance(status, Status)
    return status


def test_garbage_is_survived_and_counted(board: Board) -> None:
    rng = random.Random(4)
    tips, line = driven(board)
    for _ in range(20):
        board.receive(rng.randbytes(200))
        line.advance(0.02)
    board.receive(b"\0")
    assert tips.status().bad_frames > 10
    assert len(after(tips, line, 1.0)) == 100


@pytest.mark.parametrize("side", [0, 1])
def test_a_broken_thermistor_turns_its_heater_off(board: Board, side: int) -> None:
    tips, line = driven(board, setpoint=36.0)
    line.advance(2.0)
    assert min(board.signals.power[:]) > 4.9
    board.signals.open[side] = 1
    samples = after(tips, line, 0.3)
    assert samples.faults & (Flag.OPEN_LEFT << side) and not samples.faults & (Flag.OPEN_LEFT << (1 - side))
    assert np.isnan(samples.thermostat[-1, side]) and samples.thermostat[-1, 1 - side] > 24
    assert board.signals.power[side] == 0.0 and board.signals.power[1 - side] > 4.9
    result = tips.self_test()
    assert result.failed == Check.LEFT_THERMISTOR << side
    board.signals.open[side] = 0
    line.advance(0.5)
    assert board.signals.power[side] > 4.9


def test_a_voltage_beyond_the_range_is_told(board: Board) -> None:
    board.signals.voltage[:] = (0.3, -0.3)
    tips, line = driven(board)
    samples = after(tips, line, 0.2)
    assert samples.faults & Flag.SATURATED_LEFT and samples.faults & Flag.SATURATED_RIGHT
    assert samples.voltage[-1] == pytest.approx([0.256 - 7.8125e-6, -0.256], abs=1e-8)
    assert tips.self_test().failed & Check.CONVERTER


def test_converters_that_do_not_answer(board: Board) -> None:
    """Samples go on without what is not known; nothing heats blindly."""
    tips, line = driven(board, setpoint=36.0)
    line.advance(0.5)
    board.signals.deaf[:] = (1, 0)
    samples = after(tips, line, 0.5)
    assert len(samples) >= 50 and np.isnan(samples.voltage[5:]).all()
    assert samples.faults & (Flag.NO_VOLTAGE_LEFT | Flag.NO_VOLTAGE_RIGHT) == 0x300
    assert tips.self_test().failed == Check.CONVERTER
    board.signals.deaf[:] = (0, 1)
    samples = after(tips, line, 0.5)
    assert len(samples) >= 50 and np.isfinite(samples.voltage[5:]).all()
    assert np.isnan(samples.thermostat[5:]).all() and board.signals.power[:] == [0.0, 0.0]
    board.signals.deaf[:] = (0, 0)
    samples = after(tips, line, 0.5)
    assert np.isfinite(samples.thermostat[5:]).all() and min(board.signals.power[:]) > 4.9


@pytest.mark.parametrize("slow", [0.9, 1.0, 1.1])
def test_converters_within_their_tolerance(board: Board, slow: float) -> None:
    """TI gives 10 % on the rate."""
    board.signals.conversion = slow / 475
    board.signals.voltage[:] = (1e-3, 2e-3)
    tips, line = driven(board, setpoint=30.0)
    line.advance(5.0)
    samples = after(tips, line, 0.5)
    assert abs(samples.voltage - (1e-3, 2e-3)).max() < 5e-5
    assert abs(samples.thermostat - np.array(board.signals.plate[:])).max() < 0.05


def test_a_conversion_that_does_not_end_heats_nothing(board: Board) -> None:
    """The result that waits in the converter is another input's."""
    tips, line = driven(board, setpoint=36.0)
    line.advance(1.0)
    board.signals.conversion = 0.003
    samples = after(tips, line, 0.3)
    assert np.isnan(samples.voltage[5:]).all() and np.isnan(samples.thermostat[5:]).all()
    assert board.signals.power[:] == [0.0, 0.0]


def test_numbers_and_time_wrap(tmp_path: Path) -> None:
    """Boots 2 s before its clock of 32 bits turns over, and 100 frames before its numbers do."""
    require_tools()
    folder, _ = build(tmp_path, f"-DCLOCK_START={2**32 - 2_000_000}UL -DSEQUENCE_START={2**16 - 100}U")
    board = Board(folder)
    tips, line = driven(board, setpoint=30.0)
    samples = after(tips, line, 5.0)
    statistics = tips.statistics()
    assert samples.device_time[0] < 2**32 / 1e6 < samples.device_time[-1]
    assert abs(np.diff(samples.device_time) - 0.01).max() < 1e-3
    assert len(samples) >= 499 and (statistics.lost, statistics.late, statistics.duplicates) == (0, 0, 0)
    assert abs(np.array(board.signals.plate[:]) - 30.0).max() < 1.0
    assert tips.status().uptime == 5
    board.close()


def test_a_load_cell_at_its_end_fails_the_self_test(board: Board) -> None:
    tips, line = driven(board)
    result = tips.self_test()
    assert not result.failed and not result.checks & (
        Check.LEFT_HEATER | Check.RIGHT_HEATER
    )  # without sensors
    assert result.voltage_noise == pytest.approx((8.1e-6, 8.1e-6), rel=0.3)
    board.signals.force[4] = 100.0
    assert tips.self_test().failed == Check.LOAD_CELLS
    samples = after(tips, line, 0.2)
    assert samples.faults == Flag.NO_FORCE_RIGHT
    assert np.isnan(samples.force[-1, 1, 1]) and np.isfinite(samples.force[-1, 0]).all()
    board.signals.force[4] = 61.0
    assert abs(after(tips, line, 0.2).force[-1, 1, 1] - 61.0) < 0.5


def test_on_a_pseudo_terminal_it_is_a_device(board: Board, tmp_path: Path) -> None:
    """As fast as the simulation runs, up to real time, for the driver with its thread."""
    pytest.importorskip("serial")
    slow = LinkSettings(answer_within=0.5, open_within=10.0, stale_after=5.0)
    with (
        PtyDevice(board, tmp_path / "board") as served,
        Fingertips(served.path, rate=100, setpoint=36.0, settings=slow) as tips,
    ):
        samples = tips.wait(100, 20.0)
        statistics = tips.statistics()
    # The first may be of the rate before.
    assert abs(np.diff(samples.device_time[2:]) - 0.01).max() < 1e-3
    assert (statistics.lost, statistics.reconnects, statistics.reboots) == (0, 0, 0)
