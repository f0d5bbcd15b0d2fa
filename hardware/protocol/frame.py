"""One frame: header, payload and checksum between two zeros. docs/protocol.md draws it."""

from __future__ import annotations

import struct
import zlib
from typing import NamedTuple

from . import cobs

HEADER = struct.Struct("<BBHI")
CHECKSUM = struct.Struct("<I")
SHORTEST = HEADER.size + CHECKSUM.size
LONGEST = 64  # bytes before stuffing, so that a microcontroller can keep whole frames
SEQUENCE = 1 << 16
MICROSECONDS = 1 << 32


class Frame(NamedTuple):
    """One frame of the protocol, taken apart. code: of the message. flags: condition of the device. sequence: number
    modulo 2^16. device_us: device time of the event, us modulo 2^32. payload: as its message lays it out."""

    code: int
    flags: int
    sequence: int
    device_us: int
    payload: bytes


def encode_frame(frame: Frame) -> bytes:
    """The frame's bytes on the wire, both delimiters included."""
    head = HEADER.pack(frame.code, frame.flags, frame.sequence, frame.device_us)
    body = head + frame.payload
    return b"\0" + cobs.encode(body + CHECKSUM.pack(zlib.crc32(body))) + b"\0"
