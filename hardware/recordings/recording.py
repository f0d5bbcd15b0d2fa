"""Recordings of a line: every byte of both directions with its time, in a file that a killed recorder leaves whole.

    "thermograsp recording 1\\n", then entries: length u32, kind u8, host time f64, data, CRC-32 of all this u32

Little-endian. Kinds: m metadata (JSON, the first entry), r received, s sent, e event (text), z end (no data). An entry
is one write to the system: what a killed recorder leaves ends with a part of the last one at worst. Where a full disk
takes a part of one only, that part is cut off. Behind a damaged entry a reader finds the next whole one by its
checksum.
"""

from __future__ import annotations

import json
import logging
import os
import re
import struct
import threading
import time
import zlib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from thermograsp.errors import InvalidValueError

from ..errors import RecordingError

_LOG = logging.getLogger(__name__)
MAGIC = b"thermograsp recording 1\n"
METADATA, RECEIVED, SENT, EVENT, END = b"mrsez"
_HEAD = struct.Struct("<IBd")
_CHECK = struct.Struct("<I")
_LONGEST = 1 << 24  # bytes of one entry
_KINDS = b"mrsez"
_KIND, _KIND_AT = re.compile(b"[mrsez]"), 4  # and its place in an entry


class Entry(NamedTuple):
    """One entry of a recording. kind: one of this module's. time: s, the recording host's clock."""

    kind: int
    time: float
    data: bytes


class Recorder:
    """A tap of a driver that writes a new file. metadata: values that JSON can hold; the Unix time of the start is
    added. Raises InvalidValueError if a file of that name exists or cannot be created.

    A full disk does not disturb the driver: the recording ends there, `failure` says why ("" while it goes on), and
    `close`, or the end of the `with` block, raises RecordingError."""

    def __init__(self, path: str | os.PathLike[str], metadata: Mapping[str, Any] | None = None) -> None:
        try:
            self._file = open(path, "xb", buffering=0)  # noqa: SIM115  (closed by close)
        except FileExistsError:
            raise InvalidValueError(f"{path} exists; give the recording another name, or remove it") from None
        except OSError as error:
            raise InvalidValueError(f"cannot write {path}: {error}") from error
        self._path = path
        self._lock = threading.Lock()
        self._whole = 0  # bytes of whole entries in the file
        self.failure = ""
        self.bytes = 0
        with self._lock:
            self._append(MAGIC)
        now = time.monotonic()
        self._write(METADATA, now, json.dumps({"unix_time_s": time.time(), **(metadata or {})}).encode())
        if self.failure:
            self._file.close()
            os.unlink(path)
            raise InvalidValueError(f"cannot write {self.failure}")

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, kind: object, *_: object) -> None:
        with suppress(*([RecordingError] if kind else [])):  # what has happened already comes first
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
        """Marks the end and closes the file. Does nothing the second time. Raises RecordingError where it failed."""
        with self._lock:  # so that nothing comes after the end
            if self._file.closed:
                return
            self._append_entry(END, time.monotonic(), b"")
            self._file.close()
        if self.failure:
            raise RecordingError(f"{self.failure}; the file has what came before, {self._whole} bytes")

    def _write(self, kind: int, now: float, data: bytes) -> None:
        with self._lock:
            if not self._file.closed:
                self._append_entry(kind, now, data)

    def _append_entry(self, kind: int, now: float, data: bytes) -> None:
        body = _HEAD.pack(len(data), kind, now) + data
        if not self.failure:
            self._append(body + _CHECK.pack(zlib.crc32(body)))

    def _append(self, whole: bytes) -> None:
        """All of it or nothing."""
        left = memoryview(whole)
        try:
            while left:
                left = left[self._file.write(left) or 0 :]
        except OSError as error:
            self.failure = f"{self._path}: {error}"
            with suppress(OSError):
                self._file.truncate(self._whole)
        else:
            self._whole += len(whole)


@dataclass(frozen=True, slots=True)
class Damage:
    """Damaged bytes of a recording, which were left out. at: position of the first one in the file. bytes: how many."""

    at: int
    bytes: int

    def __str__(self) -> str:
        return f"{self.bytes} bytes from byte {self.at} on are damaged and left out"


@dataclass(frozen=True, slots=True)
class Recording:
    """The content of a recording. metadata: as given, with unix_time_s. entries: the others, in order, without the end;
    an event marks where some are missing. complete: True if the recorder closed the file, False if it was killed or
    still records. damage: what was left out."""

    metadata: Mapping[str, Any]
    entries: tuple[Entry, ...]
    complete: bool
    damage: tuple[Damage, ...] = ()


def read_recording(path: str | os.PathLike[str]) -> Recording:
    """Reads a file that a Recorder wrote, without its damaged parts. Raises InvalidValueError for another file."""
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        raise InvalidValueError(f"cannot read {path}: {error}") from error
    if not content.startswith(MAGIC) and _next_entry(content, 0) is None:
        raise InvalidValueError(f"{path} is not a recording of this package's fingertips")
    entries, damage = _entries(content)
    for one in damage:
        _LOG.warning("%s: %s", path, one)
    if (count := sum(entry.kind == METADATA for entry in entries)) > 1:  # of clocks that need not agree
        raise InvalidValueError(
            f"{path} is {count} recordings, one behind the other: give each a file of its own"
        )
    metadata: dict[str, Any] = {}
    for entry in entries:
        if entry.kind == METADATA:
            with suppress(json.JSONDecodeError):
                metadata = json.loads(entry.data)
    complete = bool(entries) and entries[-1].kind == END
    others = tuple(entry for entry in entries if entry.kind not in (METADATA, END))
    return Recording(metadata, others, complete, damage)


def _entries(content: bytes) -> tuple[list[Entry], tuple[Damage, ...]]:
    """All whole entries, an event where some are missing, and what is left out."""
    found, damage = [], []
    here, when = len(MAGIC) if content.startswith(MAGIC) else 0, 0.0
    while here < len(content):
        entry = _entry_at(content, here)
        if entry is None:
            after = _next_entry(content, here + 1)
            if after is None and _unfinished(content, here):
                break
            damage.append(Damage(here, (after or len(content)) - here))
            found.append(Entry(EVENT, when, str(damage[-1]).encode()))
            if after is None:
                break
            here = after
            continue
        found.append(entry)
        when = entry.time
        here += _HEAD.size + len(entry.data) + _CHECK.size
    if found and found[0].kind == EVENT and len(found) > 1:  # nothing came before it
        found[0] = found[0]._replace(time=found[1].time)
    return found, tuple(damage)


def _entry_at(content: bytes, here: int) -> Entry | None:
    """The entry that begins at that byte, None where no whole one does."""
    if len(content) - here < _HEAD.size + _CHECK.size:
        return None
    length, kind, when = _HEAD.unpack_from(content, here)
    end = here + _HEAD.size + length
    if kind not in _KINDS or length > _LONGEST or end + _CHECK.size > len(content):
        return None
    if _CHECK.unpack_from(content, end)[0] != zlib.crc32(content[here:end]):
        return None
    return Entry(kind, when, content[here + _HEAD.size : end])


def _next_entry(content: bytes, here: int) -> int | None:
    """Where the next whole entry begins, from that byte on."""
    for kind in _KIND.finditer(content, here + _KIND_AT):
        if _entry_at(content, kind.start() - _KIND_AT) is not None:
            return kind.start() - _KIND_AT
    return None


def _unfinished(content: bytes, here: int) -> bool:
    """Whether what is left looks like the beginning of an entry, as a killed recorder leaves it."""
    if len(content) - here < _HEAD.size:
        return True
    length, kind, _ = _HEAD.unpack_from(content, here)
    return kind in _KINDS and length <= _LONGEST and here + _HEAD.size + length + _CHECK.size > len(content)
