"""The firmware in simavr under the driver that real devices get, in simulated time; its parts beside the package's."""

import ctypes
import random
import re
import zlib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thermograsp.hardware import (
    Calibration,
    CommandRefusedError,
    Fingertips,
    Flag,
    LinkSettings,
    PtyDevice,
    Samples,
    VirtualLine,
    cobs,
)
from thermograsp.hardware.decoder import Decoder
from thermograsp.hardware.frame import Frame, encode_frame
from thermograsp.hardware.messages import (
    LENGTHS,
    Acknowledgement,
    Check,
    Code,
    Identify,
    Identity,
    Message,
    Request,
    SetRate,
    Status,
    code_of,
    decode_message,
    encode_message,
)
from thermograsp.thermal import Thermostat, ThermostatState, thermostat_step

from .board import Board, Controller, Receiver, build, portable, require_tools
from .test_protocol_page import GOLDEN

CONSTANTS = Calibration(
    date=1_700_000_000,
    voltage_offset=(20e-6, -10e-6),
    voltage_gain=(0.01, -0.02),
    thermostat_offset=(0.5, -0.25),
    force_offset=((0.1, 0.0, 0.0), (0.0, 0.2, 0.0)),
)


@pytest.fixture(scope="session")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    require_tools()
    return build(tmp_path_factory.mktemp("firmware"))


@pytest.fixture
def board(made: tuple[Path, str]) -> Iterator[Board]:
    one = Board(made[0])
    yield one
    one.close()


@pytest.fixture(scope="module")
def parts(made: tuple[Path, str]) -> ctypes.CDLL:
    return portable(made[0])


def driven(board: Board, **keywords: object) -> tuple[Fingertips, VirtualLine[Board]]:
    line = VirtualLine(board)
    return Fingertips(line.open, clock=line.clock, background=False, **keywords), line  # pyright: ignore[reportArgumentType]


def after(tips: Fingertips, line: VirtualLine[Board], seconds: float) -> Samples:
    """The samples of the next `seconds`."""
    tips.take()
    line.advance(seconds)
    return tips.take()


def sent(board: Board, code: Code) -> list[Message]:
    """All messages of a kind that it has ever sent."""
    frames = Decoder().feed(bytes(board.wire))
    return [decode_message(frame.code, frame.payload) for frame in frames if frame.code == code]


def ask(board: Board, message: Message, number: int) -> list[Frame]:
    """What it sends within 50 ms of a command, without a driver."""
    decoder = Decoder()
    board.receive(encode_frame(Frame(code_of(message), 0, number, 0, encode_message(message))))
    board.advance(board.now + 0.05)
    return decoder.feed(b"".join(board.outgoing()))


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
    assert len(device_time) >= 100 * (line.clock() - begun) - 1
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
    line.advance(12.0)
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


@pytest.mark.parametrize(("oldest", "newest", "protocol"), [(1, 1, (1, 0)), (0, 9, (1, 0)), (2, 9, (0, 0))])
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


def test_too_hot_is_off_until_the_next_setpoint(board: Board) -> None:
    tips, line = driven(board, setpoint=50.0)
    line.advance(1.0)
    board.signals.plate[0] = board.signals.thermistor[0] = 75.0
    samples = after(tips, line, 0.2)
    assert samples.faults & Flag.OVER_TEMPERATURE
    assert board.signals.power[:] == [0.0, 0.0]
    board.signals.plate[0] = board.signals.thermistor[0] = 24.0
    samples = after(tips, line, 0.2)
    assert board.signals.power[:] == [0.0, 0.0] and samples.faults & Flag.OVER_TEMPERATURE
    tips.set_setpoint(50.0, 50.0)
    samples = after(tips, line, 0.2)
    assert min(board.signals.power[:]) > 4.9
    samples = after(tips, line, 0.2)
    assert not samples.faults & Flag.OVER_TEMPERATURE
    assert samples.faults & Flag.OFF_SETPOINT_LEFT


def test_converters_that_do_not_answer(board: Board) -> None:
    """Samples go on without what is not known; nothing heats blindly."""
    tips, line = driven(board, setpoint=36.0)
    line.advance(0.5)
    board.signals.deaf[:] = (1, 0)
    samples = after(tips, line, 0.5)
    assert len(samples) >= 50 and np.isnan(samples.voltage[5:]).all()
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
    tips, _ = driven(board)
    result = tips.self_test()
    assert not result.failed and not result.checks & (
        Check.LEFT_HEATER | Check.RIGHT_HEATER
    )  # without sensors
    assert result.voltage_noise == pytest.approx((8.1e-6, 8.1e-6), rel=0.3)
    board.signals.force[4] = 100.0
    assert tips.self_test().failed == Check.LOAD_CELLS


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
