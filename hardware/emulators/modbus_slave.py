"""The slave's end of a Modbus RTU line at the line's own pace: silence separates frames, and bytes come one by one.

Written from the Modbus over Serial Line specification V1.02, apart from the library that the master uses.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

READ_HOLDING, READ_INPUT, WRITE_ONE, WRITE_MANY, READ_WRITE = 0x03, 0x04, 0x06, 0x10, 0x17


@dataclass(frozen=True, slots=True)
class LinePacing:
    """How long bytes, gaps and answers take on an emulated line. byte: s on the line. gap: s of silence that ends a
    frame. response: s between a frame's end and the answer's first byte. The defaults are 115200 baud, 8N1, the
    specification's 1.75 ms above 19200 baud, and an estimate."""

    byte: float = 10 / 115_200
    gap: float = 1.75e-3
    response: float = 1.0e-3


INSTANT = LinePacing(0.0, 0.0, 0.0)
"""A line that takes no time."""

Read = Callable[[int, int], list[int] | None]  # address and count -> registers; None where there are none
Write = Callable[[int, list[int]], bool]  # address and registers -> whether they may be written


def crc16(data: bytes) -> bytes:
    """The two bytes that end an RTU frame."""
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc >> 1) ^ (0xA001 if crc & 1 else 0)
    return crc.to_bytes(2, "little")


class SlaveLine:
    """What comes and goes between two moments; times in s."""

    def __init__(self, pacing: LinePacing) -> None:
        self._pacing = pacing
        self._received = bytearray()
        self._frame_at = math.inf
        self._sending: deque[tuple[float, bytes]] = deque()
        self._free_at = 0.0

    @property
    def due(self) -> float:
        """When a byte has been sent."""
        return self._sending[0][0] if self._sending else math.inf

    @property
    def frame_at(self) -> float:
        """When a frame from the master is at its end, as far as is known."""
        return self._frame_at

    def receive(self, data: bytes, now: float) -> None:
        """Bytes that the master's adapter puts on the line from now on."""
        last = max(now, self._frame_at - self._pacing.gap) if self._received else now
        self._received += data
        self._frame_at = last + len(data) * self._pacing.byte + self._pacing.gap

    def frame(self) -> bytes:
        """The frame that is at its end."""
        frame = bytes(self._received)
        self._received.clear()
        self._frame_at = math.inf
        return frame

    def send(self, data: bytes, now: float) -> None:
        """An answer to a frame that ended now."""
        time = max(now + self._pacing.response, self._free_at)
        for byte in data:
            time += self._pacing.byte
            self._sending.append((time, bytes([byte])))
        self._free_at = time

    def sent(self, now: float) -> bytes:
        """What has arrived at the master by now."""
        data = bytearray()
        while self._sending and self._sending[0][0] <= now:
            data += self._sending.popleft()[1]
        return bytes(data)


def answer(frame: bytes, slave: int, read: Read, write: Write) -> bytes | None:
    """What a slave without exception responses answers to a frame, None for silence: another slave's frame, a wrong
    checksum or length, a function or register that it has not."""
    if len(frame) < 4 or frame[0] != slave or crc16(frame[:-2]) != frame[-2:]:
        return None
    body = _body(frame[1], frame[2:-2], read, write)
    return None if body is None else _closed(frame[:2] + body)


def exception(frame: bytes, code: int) -> bytes:
    """An exception response to a frame."""
    return _closed(bytes([frame[0], frame[1] | 0x80, code]))


def _closed(data: bytes) -> bytes:
    return data + crc16(data)


def _body(function: int, data: bytes, read: Read, write: Write) -> bytes | None:
    words = [int.from_bytes(data[i : i + 2], "big") for i in range(0, 8, 2)]
    if function in (READ_HOLDING, READ_INPUT) and len(data) == 4:
        return _registers(read(words[0], words[1]))
    if function == WRITE_ONE and len(data) == 4:
        return data if write(words[0], [words[1]]) else None
    if function == WRITE_MANY and (values := _values(data[2:])) is not None:
        return data[:4] if write(words[0], values) else None
    if function == READ_WRITE and (values := _values(data[6:])) is not None:
        return _registers(read(words[0], words[1])) if write(words[2], values) else None
    return None


def _values(data: bytes) -> list[int] | None:
    """Registers after their count (u16) and their bytes' (u8)."""
    if len(data) < 3 or data[2] != len(data) - 3 or data[2] != 2 * int.from_bytes(data[:2], "big"):
        return None
    return [int.from_bytes(data[i : i + 2], "big") for i in range(3, len(data), 2)]


def _registers(values: list[int] | None) -> bytes | None:
    if values is None:
        return None
    return bytes([2 * len(values)]) + b"".join(value.to_bytes(2, "big") for value in values)
