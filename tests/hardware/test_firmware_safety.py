"""What the firmware does by itself so that heaters do no harm, and what it keeps and tells of a failing supply."""

import numpy as np
import pytest

from thermograsp.hardware import (
    Calibration,
    CommandRefusedError,
    Fingertips,
    Flag,
    HeatersOff,
    Reset,
    ThermostatReport,
    VirtualLine,
)
from thermograsp.hardware.protocol.frame import Frame, encode_frame
from thermograsp.hardware.protocol.messages import (
    Check,
    Code,
    Identify,
    KeepAlive,
    Request,
    SetSetpoint,
    constants_command,
    encode_message,
)

from .board import Board
from .firmware_line import after, ask, attended, driven, sent

OLD = Calibration(date=1, voltage_offset=(1e-6, 2e-6))
NEW = Calibration(date=2, voltage_offset=(3e-6, 4e-6))
STORED, SIZE = 2, 52  # of a copy in the EEPROM


def test_too_hot_is_off_until_it_is_cleared(board: Board) -> None:
    """Not by a setpoint, a host that connects anew, or while it is hot."""
    tips, line = driven(board, setpoint=50.0)
    line.advance(1.0)
    board.signals.plate[0] = board.signals.thermistor[0] = 75.0
    samples = after(tips, line, 0.2)
    assert samples.faults & Flag.LATCHED_OFF
    assert board.signals.power[:] == [0.0, 0.0]
    with pytest.raises(CommandRefusedError):
        tips.clear_faults()
    board.signals.plate[0] = board.signals.thermistor[0] = 24.0
    tips.set_setpoint(50.0, 50.0)
    samples = after(tips, line, 0.2)
    assert board.signals.power[:] == [0.0, 0.0] and samples.faults & Flag.LATCHED_OFF
    tips = again(line, setpoint=50.0)
    samples = after(tips, line, 0.2)
    assert board.signals.power[:] == [0.0, 0.0] and samples.faults & Flag.LATCHED_OFF
    for cause in (Reset.EXTERNAL, Reset.POWER_ON):  # a port that is opened restarts many boards
        board.reset(cause)
        line.advance(0.6)
        tips = again(line, setpoint=50.0)
        samples = after(tips, line, 0.2)
        assert board.signals.power[:] == [0.0, 0.0] and samples.faults & Flag.LATCHED_OFF
    assert tips.condition().heaters_off == HeatersOff.TOO_HOT_LEFT
    assert tips.clear_faults().heaters_off == 0
    line.advance(0.1)
    samples = after(tips, line, 0.2)
    assert min(board.signals.power[:]) > 4.9
    assert not samples.faults & Flag.LATCHED_OFF and samples.faults & Flag.OFF_SETPOINT_LEFT
    board.reset()
    line.advance(0.6)
    assert again(line).condition().heaters_off == 0


@pytest.mark.slow
def test_heaters_go_off_ten_seconds_after_the_last_sign_of_the_host(board: Board) -> None:
    tips, line = driven(board, setpoint=36.0)
    attended(tips, line, 13.0)
    assert tips.thermostats().setpoint == (36.0, 36.0)
    line.advance(7.5)
    assert tips.thermostats().setpoint == (36.0, 36.0)
    line.advance(3.5)
    assert board.signals.power[:] == [0.0, 0.0]
    assert tips.condition().heaters_off == HeatersOff.HOST_SILENT
    line.advance(2.0)
    assert board.signals.power[:] == [0.0, 0.0]
    tips.set_setpoint(36.0, 36.0)
    line.advance(0.1)
    assert min(board.signals.power[:]) > 1.0 and tips.condition().heaters_off == 0


def test_only_the_session_s_host_is_a_sign_and_is_not_answered(board: Board) -> None:
    board.advance(0.1)
    ask(board, Identify(2, 2, 7), 1)
    ask(board, SetSetpoint((36.0, 36.0)), 2)
    for number in range(9):
        frames = ask(board, KeepAlive(7), 10 + number)
        assert not [frame for frame in frames if frame.code == Code.ACKNOWLEDGEMENT]
        board.advance(board.now + 2.0)
    assert setpoints(board) == (36.0, 36.0)
    for number in range(6):
        ask(board, KeepAlive(8), 20 + number)
        board.advance(board.now + 2.0)
    assert np.isnan(setpoints(board)).all()


def setpoints(board: Board) -> tuple[float, float]:
    ask(board, Request(Code.THERMOSTAT), 999)
    report = sent(board, Code.THERMOSTAT)[-1]
    assert isinstance(report, ThermostatReport)
    return report.setpoint


@pytest.mark.parametrize("what", [pytest.param("loose", marks=pytest.mark.slow), "cold"])
def test_power_that_warms_nothing_ends(board: Board, what: str) -> None:
    """A thermistor that has come off its plate, and a heater whose wire is broken: off long before 70 °C."""
    tips, line = driven(board, setpoint=36.0)
    attended(tips, line, 8.0)
    getattr(board.signals, what)[1] = 1
    if what == "cold":
        board.signals.plate[1] = board.signals.thermistor[1] = 30.0
    for _ in range(12):
        attended(tips, line, 1.0)
        assert board.signals.plate[1] < 60.0
    assert board.signals.power[:] == [0.0, 0.0]
    assert tips.condition().heaters_off == HeatersOff.RUNAWAY_RIGHT
    assert tips.take().faults & Flag.LATCHED_OFF or after(tips, line, 0.1).faults & Flag.LATCHED_OFF
    getattr(board.signals, what)[1] = 0
    board.signals.plate[1] = board.signals.thermistor[1] = 30.0
    attended(tips, line, 1.0)
    assert tips.clear_faults().heaters_off == 0
    attended(tips, line, 8.0)
    assert abs(board.signals.plate[1] - 36.0) < 0.5


@pytest.mark.slow
@pytest.mark.parametrize("drawn", [0.0, 3.0])
def test_power_that_warms_slowly_goes_on(board: Board, drawn: float) -> None:
    board.signals.supply = 4.6
    board.signals.heat[0] = drawn
    tips, line = driven(board, setpoint=60.0)
    attended(tips, line, 25.0)
    assert tips.condition().heaters_off == 0
    assert abs(board.signals.plate[1] - 60.0) < 0.5


@pytest.mark.parametrize("cause", [Reset.EXTERNAL, Reset.BROWN_OUT, Reset.BROWN_OUT | Reset.WATCHDOG])
def test_what_made_it_start_is_told(board: Board, cause: Reset) -> None:
    tips, line = driven(board)
    assert tips.condition().reset == Reset.POWER_ON
    board.reset(cause)
    line.advance(0.1)
    tips = again(line, rate=10)
    line.advance(1.2)
    tips.take()
    assert tips.condition().reset == cause
    assert sent(board, Code.CONDITION)


@pytest.mark.parametrize(("fuses", "good"), [(0xFC, True), (0x04, True), (0xFD, False), (0xFF, False)])
def test_a_brown_out_detector_that_is_not_set_fails_the_self_test(
    board: Board, fuses: int, good: bool
) -> None:
    """As boards come it is at 2.7 V (0xFD), which is less than 16 MHz need."""
    board.signals.fuses = fuses
    tips, _ = driven(board)
    result = tips.self_test()
    assert result.checks & Check.BROWN_OUT
    assert result.failed == (0 if good else Check.BROWN_OUT)


def test_one_whole_copy_of_the_constants_is_enough_and_mends_the_other(board: Board) -> None:
    tips, line = driven(board)
    tips.set_calibration(OLD)
    copies = [[board.stored(STORED + copy * SIZE + i) for i in range(SIZE)] for copy in range(2)]
    assert copies[0] == copies[1]
    for copy in range(2):
        at = STORED + copy * SIZE + 20
        board.store(at, board.stored(at) ^ 0x10)
        board.reset()
        line.advance(0.6)
        tips = again(line)
        assert tips.calibration == OLD and not tips.self_test().failed
        assert [board.stored(STORED + copy * SIZE + i) for i in range(SIZE)] == copies[0]
    for at in (STORED, STORED + SIZE):
        board.store(at, board.stored(at) ^ 0x10)
    board.reset()
    line.advance(0.1)
    tips = again(line)
    assert tips.calibration == Calibration() and tips.self_test().failed == Check.MEMORY
    tips.set_calibration(NEW)
    assert not tips.self_test().failed


def test_power_that_fails_while_storing_leaves_old_or_new_constants(board: Board) -> None:
    """Cut off anywhere: never none, never a mixture."""
    tips, line = driven(board)
    found = []
    for cut in range(12):
        tips.set_calibration(OLD)
        line.write(stored_frame(NEW, cut))
        line.advance(0.002 + 0.024 * cut)
        board.reset(Reset.BROWN_OUT)
        line.advance(0.6)
        tips = again(line)
        assert tips.calibration in (OLD, NEW) and not tips.self_test().failed
        found.append(tips.calibration == NEW)
    assert found == sorted(found) and {True, False} == set(found)


def again(line: VirtualLine[Board], **keywords: object) -> Fingertips:
    """A driver that connects to what has been driven before."""
    return Fingertips(line.open, clock=line.clock, background=False, **keywords)  # pyright: ignore[reportArgumentType]


def stored_frame(calibration: Calibration, number: int) -> bytes:
    return encode_frame(
        Frame(Code.SET_CALIBRATION, 0, 30_000 + number, 0, encode_message(constants_command(calibration)))
    )
