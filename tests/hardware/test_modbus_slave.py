"""The emulated slave's bytes against the examples of Robotiq's manual, its silence, and its pace."""

import math
import random

import pytest

from thermograsp.hardware import (
    EmulatedGripper,
    GripperModel,
    LineFaults,
    LinePacing,
    SpringFingers,
)
from thermograsp.hardware.emulators.modbus_slave import answer, crc16

# Robotiq 2F-85 & 2F-140 Instruction Manual, Modbus RTU: request, registers read, answer.
MANUAL = [
    ("09 10 03 E8 00 03 06 09 00 00 00 FF FF 72 19", [], "09 10 03 E8 00 03 01 30"),
    ("09 03 07 D0 00 01 85 CF", [0x1100], "09 03 02 11 00 55 D5"),
    ("09 03 07 D0 00 01 85 CF", [0x3100], "09 03 02 31 00 4C 15"),
    ("09 04 07 D0 00 03 B1 CE", [0xB900, 0x00FF, 0xBD00], "09 04 06 B9 00 00 FF BD 00 5C 9A"),
    ("09 04 07 D0 00 03 B1 CE", [0xF900, 0x0000, 0x0D00], "09 04 06 F9 00 00 00 0D 00 17 AA"),
    ("09 03 07 D0 00 03", [0xF900, 0x0000, 0x0D00], "09 03 06 F9 00 00 00 0D 00 56 4C"),
]


@pytest.mark.parametrize(("request_", "registers", "expected"), MANUAL)
def test_the_manual_s_examples(request_: str, registers: list[int], expected: str) -> None:
    requests = []

    def read(address: int, count: int) -> list[int]:
        requests.append((address, count))
        return registers

    def write(address: int, values: list[int]) -> bool:
        requests.append((address, values))
        return True

    frame = bytes.fromhex(request_)
    if len(frame) == 6:  # its checksum is not printed
        frame += crc16(frame)
    assert answer(frame, 9, read, write) == bytes.fromhex(expected)
    wanted = (1000, [0x0900, 0, 0xFFFF]) if frame[1] == 16 else (2000, len(registers))
    assert requests == [wanted]


def rtu(*body: int) -> bytes:
    return bytes(body) + crc16(bytes(body))


def said(device: EmulatedGripper, request: bytes) -> bytes:
    """The answer, long enough after."""
    device.receive(request)
    now = device._now
    device.advance(now + 0.05)
    return b"".join(device.outgoing())


def test_every_function_reaches_the_same_registers() -> None:
    device = EmulatedGripper(GripperModel(activation_speed=100.0))
    assert said(device, rtu(9, 6, 0x03, 0xE8, 0x01, 0x00)) == rtu(9, 6, 0x03, 0xE8, 0x01, 0x00)
    device.advance(0.5)
    many = rtu(9, 16, 0x03, 0xE8, 0, 3, 6, 0x09, 0, 0, 100, 200, 50)
    assert said(device, many) == rtu(9, 16, 0x03, 0xE8, 0, 3)
    device.advance(1.4)
    expected = (9, 6, 0xF9, 0, 0, 100, 100, 0)
    assert said(device, rtu(9, 3, 0x07, 0xD0, 0, 3)) == rtu(9, 3, *expected[1:])
    assert said(device, rtu(9, 4, 0x07, 0xD0, 0, 3)) == rtu(9, 4, *expected[1:])
    both = rtu(9, 23, 0x07, 0xD1, 0, 2, 0x03, 0xE9, 0, 1, 2, 0, 40)
    assert said(device, both) == rtu(9, 23, 4, 0, 100, 100, 0)  # the state before the controller's next tick
    device.advance(2.5)
    assert device.state.position == device.state.requested == 40
    assert said(device, rtu(9, 4, 0x07, 0xD0, 0, 8))[2] == 16  # the reserved registers are there


@pytest.mark.parametrize(
    "request_",
    [
        rtu(8, 3, 0x07, 0xD0, 0, 3),
        rtu(9, 3, 0x07, 0xD0, 0, 3)[:-1] + b"\0",
        rtu(9, 3, 0x07, 0xD0, 0, 9),
        rtu(9, 3, 0x07, 0xD0, 0, 0),
        rtu(9, 3, 0x03, 0xE8, 0, 3),
        rtu(9, 6, 0x07, 0xD0, 0, 3),
        rtu(9, 1, 0x07, 0xD0, 0, 3),
        rtu(9, 16, 0x03, 0xE8, 0, 3, 4, 0, 0, 0, 0),
        rtu(9, 16, 0x03, 0xE8, 0, 3),
        rtu(9, 23, 0x07, 0xD0),
        rtu(9),
        b"\x09",
    ],
)
def test_what_it_does_not_know_it_is_silent_about(request_: bytes) -> None:
    device = EmulatedGripper()
    assert said(device, request_) == b""
    assert said(device, rtu(9, 3, 0x07, 0xD0, 0, 1)) == rtu(9, 3, 2, 0, 0)


def test_no_corrupted_request_moves_it() -> None:
    """CRC-16 lets one of 65536 through at random; of bursts up to 16 bits and up to 3 flipped bits none."""
    rng = random.Random(3)
    device = EmulatedGripper()
    good = rtu(9, 16, 0x03, 0xE8, 0, 3, 6, 0x01, 0, 0, 0, 0, 0)
    for _ in range(2000):
        bad = bytearray(good)
        if rng.random() < 0.5:
            for _ in range(rng.randint(1, 3)):
                bad[rng.randrange(len(bad))] ^= 1 << rng.randrange(8)
        else:
            first = rng.randrange(len(bad) - 1)
            bad[first : first + 2] = rng.randbytes(2)
        if bytes(bad) != good:
            said(device, bytes(bad))
    assert not device.state.activated
    said(device, good)
    device.advance(device._now + 0.01)
    assert device.state.activated


def test_bytes_take_their_time() -> None:
    """8 bytes, the silence that ends them, the response time, then 7 bytes, one after the other."""
    pacing = LinePacing()
    device = EmulatedGripper(GripperModel(pacing=pacing))
    device.advance(1.0)
    device.receive(rtu(9, 3, 0x07, 0xD0, 0, 1))
    times, data = [], b""
    while len(data) < 7:
        now = device.due
        device.advance(now)
        for piece in device.outgoing():
            times.append(now)
            data += piece
    first = 1.0 + 8 * pacing.byte + pacing.gap + pacing.response
    assert times == pytest.approx([first + (k + 1) * pacing.byte for k in range(7)], abs=1e-9)
    assert pacing.byte == pytest.approx(86.8e-6, rel=1e-3)
    assert device.due == math.inf


def test_a_request_without_silence_before_it_is_lost() -> None:
    device = EmulatedGripper()
    request = rtu(9, 3, 0x07, 0xD0, 0, 1)
    device.receive(request)
    device.advance(0.002)
    device.receive(request)  # 0.7 ms for the bytes, of 1.75 ms of silence 1.3 ms
    device.advance(0.1)
    assert device.outgoing() == []
    device.receive(request[:4])
    device.advance(device._now + 0.0005)
    device.receive(request[4:])  # in pieces, but in time
    device.advance(0.2)
    assert b"".join(device.outgoing()) == rtu(9, 3, 2, 0, 0)


def test_faults_of_the_line() -> None:
    device = EmulatedGripper()
    request = rtu(9, 3, 0x07, 0xD0, 0, 1)
    right = rtu(9, 3, 2, 0, 0)
    device.line = LineFaults(corrupt=1.0)
    assert crc16(said(device, request)[:-2]) != said(device, request)[-2:] or said(device, request) != right
    device.line = LineFaults(truncate=1.0)
    assert right.startswith(said(device, request)) and said(device, request) != right
    device.line = LineFaults(drop_answer=1.0)
    assert said(device, request) == b""
    device.line = LineFaults()
    device.exception = 4
    assert said(device, request) == rtu(9, 0x83, 4)
    device.exception = 0
    device.stall_until = 10.0
    assert said(device, request) == b""
    device.advance(11.0)
    assert said(device, request) == right


def test_fingers_press_until_the_force_and_stay() -> None:
    fingers = SpringFingers(0.085, width=0.03, stiffness=1e4)
    fingers.move(0.0, 40.0, 0.1, 0.5)
    assert fingers.opening == pytest.approx(0.035)
    fingers.move(0.0, 40.0, 0.1, 0.5)
    assert fingers.opening == pytest.approx(0.03 - 40 / 1e4)
    fingers.move(0.0, 20.0, 0.1, 0.5)  # less force: the drive locks
    assert fingers.opening == pytest.approx(0.026) and fingers.contact.name == "CLOSING"
    fingers.width = None  # it slips away
    fingers.move(0.0, 20.0, 0.1, 0.01)
    assert fingers.opening == pytest.approx(0.025) and fingers.contact.name == "NONE"
