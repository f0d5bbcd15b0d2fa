"""Recordings of a line: every byte of both directions with its time, in a file that a killed recorder leaves whole.

    "thermograsp recording 1\\n", then entries: length u32, kind u8, host time f64, data, CRC-32 of all this u32

Little-endian. Kinds: m metadata (JSON, the first entry), r received, s sent, e event (text), z end (no data). An entry
is one write to the system: what a killed recorder leaves ends with a part of the last one at worst.
"""

from __future__ import annotations

import json
import os
import struct
import threading
import time
import zlib
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from thermograsp.errors import InvalidValueError

MAGIC = b"thermograsp recording 1\n"
METADATA, RECEIVED, SENT, EVENT, END = b"mrsez"
_HEAD = struct.Struct("<IBd")
_CHECK = struct.Struct("<I")
_LONGEST = 1 << 24  # bytes of one entry


class Entry(NamedTuple):
    """kind: one of this module's. time: s, the recording host's clock."""

    kind: int
    time: float
    data: bytes


class Recorder:
    """Writes a new file; a tap of a driver. metadata: what JSON holds; the Unix time of the start is added. Raises
    InvalidValueError where a file of that name exists or cannot be made."""

    def __init__(self, path: str | os.PathLike[str], metadata: Mapping[str, Any] | None = None) -> None:
        try:
            self._file = open(path, "xb", buffering=0)  # noqa: SIM115  (closed by close)
        except FileExistsError:
            raise InvalidValueError(f"{path} exists; give the recording another name, or remove it") from None
        except OSError as error:
            raise InvalidValueError(f"cannot write {path}: {error}") from error
        self._lock = threading.Lock()
        self.bytes = 0
        self._file.write(MAGIC)
        now = time.monotonic()
        self._write(METADATA, now, json.dumps({"unix_time_s": time.time(), **(metadata or {})}).encode())

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def received(self, now: float, data: bytes) -> None:
        """See Tap."""
        self.bytes += len(data)
        self._write(RECEIVED, now, data)

    def sent(self, now: float, data: bytes) -> None:
        """See Tap."""
        self._write(SENT, now, data)

    def event(self, now: float, what: str) -> None:
        """See Tap."""
        self._write(EVENT, now, what.encode())

    def close(self) -> None:
        """Marks the end and closes the file. Does nothing the second time."""
        if self._file.closed:
            return
        self._write(END, time.monotonic(), b"")
        self._file.close()

    def _write(self, kind: int, now: float, data: bytes) -> None:
        body = _HEAD.pack(len(data), kind, now) + data
        with self._lock:
            self._file.write(body + _CHECK.pack(zlib.crc32(body)))


@dataclass(frozen=True, slots=True)
class Recording:
    """metadata: as given, with unix_time_s. entries: the others, in order, without the end. complete: the recorder
    closed it; else it was killed, or records still."""

    metadata: Mapping[str, Any]
    entries: tuple[Entry, ...]
    complete: bool


def read_recording(path: str | os.PathLike[str]) -> Recording:
    """A file that a Recorder wrote. Raises InvalidValueError for another file, and for a damaged one with the place."""
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        raise InvalidValueError(f"cannot read {path}: {error}") from error
    if not content.startswith(MAGIC):
        raise InvalidValueError(f"{path} is not a recording of this package's fingertips")
    entries = list(_entries(path, content))
    metadata: dict[str, Any] = {}
    if entries and entries[0].kind == METADATA:
        with suppress(json.JSONDecodeError):
            metadata = json.loads(entries[0].data)
    complete = bool(entries) and entries[-1].kind == END
    return Recording(
        metadata, tuple(entry for entry in entries if entry.kind not in (METADATA, END)), complete
    )


def _entries(path: str | os.PathLike[str], content: bytes) -> Iterator[Entry]:
    here = len(MAGIC)
    while len(content) - here >= _HEAD.size + _CHECK.size:
        length, kind, when = _HEAD.unpack_from(content, here)
        end = here + _HEAD.size + length
        if length <= _LONGEST and end + _CHECK.size > len(content):
            return  # the last entry, not finished
        if length > _LONGEST or _CHECK.unpack_from(content, end)[0] != zlib.crc32(content[here:end]):
            raise InvalidValueError(f"{path} is damaged at byte {here} of {len(content)}; copy it again")
        yield Entry(kind, when, content[here + _HEAD.size : end])
        here = end + _CHECK.size
