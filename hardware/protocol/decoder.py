"""From bytes as they come to frames whose checksum holds."""

from __future__ import annotations

import zlib
from dataclasses import dataclass

from . import cobs
from .frame import (
    CHECKSUM,
    HEADER,
    LONGEST,
    SHORTEST,
    Frame,
)
from .messages import LENGTHS

_LONGEST_STUFFED = LONGEST + 1


@dataclass(slots=True)
class DecoderCounts:
    """Frames accepted, and chunks between zeros that were not frames: too short or too long for one, badly stuffed,
    with a wrong checksum, of a code this version does not know, of a length that does not fit their code."""

    accepted: int = 0
    misfits: int = 0
    stuffing: int = 0
    checksum: int = 0
    unknown: int = 0
    length: int = 0

    @property
    def rejected(self) -> int:
        """Chunks that were not accepted, whatever was wrong with them."""
        return self.misfits + self.stuffing + self.checksum + self.unknown + self.length


class Decoder:
    """Takes bytes in pieces of any size; after an error it is in step again at the next zero."""

    def __init__(self) -> None:
        self.counts = DecoderCounts()
        self._pending = b""
        self._overlong = False

    def feed(self, data: bytes) -> list[Frame]:
        """The frames that these bytes complete, in order."""
        chunks = (self._pending + data).split(b"\0")
        self._pending = chunks.pop()
        if self._overlong and chunks:
            chunks[0] = b""
            self._overlong = False
        frames = [frame for chunk in chunks if chunk and (frame := self._frame(chunk)) is not None]
        if len(self._pending) > _LONGEST_STUFFED:  # no frame is so long: forget it up to the next zero
            self._pending = b""
            if not self._overlong:
                self._overlong = True
                self.counts.misfits += 1
        return frames

    def _frame(self, chunk: bytes) -> Frame | None:
        counts = self.counts
        if not SHORTEST < len(chunk) <= _LONGEST_STUFFED:
            counts.misfits += 1
            return None
        body = cobs.decode(chunk)
        if body is None:
            counts.stuffing += 1
            return None
        if zlib.crc32(body[:-4]) != CHECKSUM.unpack_from(body, len(body) - 4)[0]:
            counts.checksum += 1
            return None
        code, flags, sequence, device_us = HEADER.unpack_from(body)
        length = LENGTHS.get(code)
        if length is None:
            counts.unknown += 1
            return None
        if length != len(body) - SHORTEST:
            counts.length += 1
            return None
        counts.accepted += 1
        return Frame(code, flags, sequence, device_us, body[HEADER.size : -CHECKSUM.size])
