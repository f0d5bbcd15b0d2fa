"""The host's side of one line without input or output: the same live, in lockstep and in a replay."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from .clock import ClockFit
from .decoder import Decoder
from .frame import MICROSECONDS, SEQUENCE, Frame
from .messages import (
    Acknowledgement,
    Code,
    Flag,
    Identity,
    Message,
    decode_message,
)
from .samples import SampleRow

_TO_DEVICE = 0x80
_HALF = SEQUENCE // 2
_NEWER = 1.0  # s that a frame's time is ahead when a long gap, not lateness, explains its sequence number


@dataclass(slots=True)
class SessionCounts:
    """Counters of a session with a device. lost: frames missing in the device's numbering. duplicates, late: frames
    that came twice, or after newer ones; not used. echoes: the host's own commands. late_answers: acknowledgements that
    nobody waited for. overruns: samples dropped because nobody took them."""

    samples: int = 0
    lost: int = 0
    duplicates: int = 0
    late: int = 0
    echoes: int = 0
    late_answers: int = 0
    overruns: int = 0


class Session:
    """Decodes, numbers, dates and sorts what a device sends. kept: samples that wait to be taken, at most.

    A line keeps its order: what comes after it was opened and before the first answer to this host may be old, kept by
    an adapter, a system or a busy sender. Such samples are dropped, and such times do not count for the clock.
    """

    def __init__(self, kept: int = 100_000) -> None:
        self.decoder = Decoder()
        self.counts = SessionCounts()
        self.clock = ClockFit()
        self.rows: deque[SampleRow] = deque(maxlen=kept)
        self.reports: dict[type, tuple[float, Message]] = {}
        self.awaited: dict[int, Acknowledgement | None] = {}
        self.unidentified = True  # by the newest frame's flag
        self.last_sample: float | None = None
        self.flags = Flag(0)
        self.boots: int | None = None  # of the device, as it said last
        self._answered = True  # since the line was opened
        self._sequence: int | None = None
        self._device: float | None = None
        self._host = 0.0
        self._lost = 0
        self._time = 0.0

    def renumber(self) -> None:
        """The next frame may have any number: the line was opened, or the device may have started anew."""
        self._sequence = None

    def reopened(self, answers: bool = True) -> None:
        """The line was closed and is open again: half a frame may be missing, and any number of them. answers: False
        where what this host asks may be missing too, so that no answer can be waited for."""
        self.decoder.feed(b"\0")
        self._answered = not answers
        self.renumber()

    def receive(self, data: bytes, now: float) -> None:
        """Bytes that have come at host time `now`, s."""
        for frame in self.decoder.feed(data):
            if frame.code & _TO_DEVICE:
                self.counts.echoes += 1
            else:
                self._frame(frame, now)

    def _frame(self, frame: Frame, now: float) -> None:
        unidentified = bool(frame.flags & Flag.UNIDENTIFIED)
        message = None if frame.code == Code.SAMPLE else decode_message(frame.code, frame.payload)
        if (unidentified and not self.unidentified) or self._restarted(message):
            self._reboot()
        device = self._device_time(frame.device_us, now)
        if self._is_old(frame.sequence, device):
            return
        self.unidentified = unidentified
        self.flags = Flag(frame.flags)
        self._sequence, self._device, self._host = frame.sequence, device, now
        if isinstance(message, Acknowledgement) and message.command in self.awaited:
            self._answered = True
        if self._answered:
            self.clock.add(device, now)
        if message is None:
            if self._answered:
                self._sample(frame, device, now)
            return
        self.reports[type(message)] = (now, message)
        if isinstance(message, Acknowledgement):
            if message.command in self.awaited:
                self.awaited[message.command] = message
            else:
                self.counts.late_answers += 1

    def _restarted(self, message: Message | None) -> bool:
        """Whether it is an identity of another start than the one before: also one that nobody has seen, while the line
        was open."""
        if not isinstance(message, Identity):
            return False
        before, self.boots = self.boots, message.boots
        return before not in (None, message.boots)

    def _reboot(self) -> None:
        """The device has started anew: numbers and time begin at 0."""
        self.clock = ClockFit()
        self._sequence = self._device = None

    def _sample(self, frame: Frame, device: float, now: float) -> None:
        self.counts.samples += 1
        self.last_sample = now
        self._time = max(self._time, min(self.clock.host_time(device), now))
        self.counts.overruns += len(self.rows) == self.rows.maxlen
        self.rows.append(SampleRow(self._time, device, now, frame.flags, self._lost, frame.payload))
        self._lost = 0

    def _device_time(self, device_us: int, now: float) -> float:
        """s since the device's boot: of the times that its clock of 32 bits may mean, the one that is nearest to what
        the host's clock expects."""
        if self._device is None:
            return device_us / 1e6
        expected = round((self._device + now - self._host) * 1e6)
        ahead = (device_us - expected + MICROSECONDS // 2) % MICROSECONDS - MICROSECONDS // 2
        return (expected + ahead) / 1e6

    def _is_old(self, sequence: int, device: float) -> bool:
        """Whether a frame was seen, or is older than one that was; counts what is missing before it."""
        if self._sequence is None or self._device is None:
            return False
        step = (sequence - self._sequence) % SEQUENCE
        if step == 0:
            self.counts.duplicates += 1
            return True
        if step >= _HALF and device < self._device + _NEWER:
            self.counts.late += 1
            return True
        self.counts.lost += step - 1
        self._lost += step - 1
        return False
