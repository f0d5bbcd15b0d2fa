"""Commands over a line: sent, repeated, acknowledged. The line is read by a thread of its own, or by whoever waits."""

from __future__ import annotations

import itertools
import logging
import random
import threading
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from typing import Protocol, TypeVar

from ..errors import (
    CommandRefusedError,
    DeviceError,
    LinkLostError,
    NoAnswerError,
    ProtocolVersionError,
    WrongDeviceError,
)
from ..lines import (
    Transport,
    Turns,
)
from ..protocol import (
    CODES,
    MODEL,
    PROTOCOL,
    SEQUENCE,
    Acknowledgement,
    Frame,
    Identify,
    Identity,
    KeepAlive,
    Message,
    Request,
    Result,
    Session,
    code_of,
    encode_frame,
    encode_message,
)

_LOG = logging.getLogger(__name__)
Report = TypeVar("Report")
OPENED = "opened"  # the event of a transport put to use


class Tap(Protocol):
    """A listener that receives all bytes of a line, such as a recorder. Times are the host's clock, s."""

    def received(self, now: float, data: bytes) -> None:
        """Bytes from the device."""
        ...

    def sent(self, now: float, data: bytes) -> None:
        """Bytes to the device."""
        ...

    def event(self, now: float, what: str) -> None:
        """What happened to the line itself."""
        ...


@dataclass(frozen=True, slots=True)
class LinkSettings:
    """Time limits of a line. answer_within: s to wait for an acknowledgement before a command is sent again. tries: the
    most attempts at a command. open_within: s for a device to identify itself; a board that restarts when its port is
    opened needs 2. stale_after: s without an expected sample after which the sensor is stale and its port is opened
    again. reopen_every: s between attempts to open it. kept: the most samples that wait to be taken; beyond it the
    oldest are dropped."""

    answer_within: float = 0.08
    tries: int = 8
    open_within: float = 3.0
    stale_after: float = 0.5
    reopen_every: float = 0.05
    kept: int = 100_000


class Link:
    """One line to one device. Everybody may send; exactly one thread may read, and wakes those who wait."""

    def __init__(self, settings: LinkSettings, clock: Callable[[], float], tap: Tap | None) -> None:
        self.settings = settings
        self.session = Session(settings.kept)
        self.changed = threading.Condition()  # guards the session; notified when bytes have come
        self.repeats = 0
        self.bytes_received = 0
        self.reader: threading.Thread | None = None  # who reads, None for whoever waits
        self.stopped: Callable[[], DeviceError | None] = lambda: None  # why a waiter must not wait on
        self.closing = threading.Event()  # ends whoever reads
        self._clock = clock
        self._tap = tap
        self._transport: Transport | None = None
        self._sending = threading.Lock()
        self._turns = Turns()
        self._session = 0
        self._numbers = itertools.count(random.SystemRandom().randrange(SEQUENCE))

    def use(self, transport: Transport) -> None:
        """Goes on over this transport."""
        self.close()
        self._transport = transport
        self.note(OPENED)
        with self.changed:
            self.session.reopened()

    def close(self) -> None:
        """Releases the transport."""
        if self._transport is not None:
            self._transport.close()

    def note(self, what: str) -> None:
        """Tells the tap and the log what happened."""
        _LOG.info("fingertips: %s", what)
        self._show(lambda tap: tap.event(self._clock(), what))

    def pump(self, timeout: float) -> bool:
        """Reads once, waiting up to timeout s; whether anything came. Raises LinkLostError."""
        assert self._transport is not None
        if self.closing.is_set():
            raise LinkLostError("the driver was closed; open another one")
        data = self._transport.read(timeout)
        if not data:
            return False
        now = self._clock()
        self.bytes_received += len(data)
        self._show(lambda tap: tap.received(now, data))
        with self.changed:
            self.session.receive(data, now)
            self.changed.notify_all()
        return True

    def drain(self) -> None:
        """Reads all that has come."""
        while self.pump(0.0):
            pass

    def wait(self, ready: Callable[[], bool], seconds: float) -> bool:
        """Whether `ready` came true within that time. Raises what `stopped` tells, or LinkLostError."""
        deadline = self._clock() + seconds
        if self.reader not in (None, threading.current_thread()):
            with self.changed:
                self.changed.wait_for(lambda: ready() or self.stopped() is not None, seconds)
                if not ready() and (error := self.stopped()) is not None:
                    raise error
                return ready()
        while not ready():
            left = deadline - self._clock()
            if left <= 0:
                return False
            self.pump(left)
        return True

    def command(
        self, message: Message, *, first: bool = False, permitted: Callable[[], None] = lambda: None
    ) -> None:
        """Has the device execute a command once. first: before those of other threads that wait, after one try of a
        command at most. permitted: called before it is sent, each time; what it raises ends it. Raises NoAnswerError,
        CommandRefusedError, LinkLostError."""
        number = next(self._numbers) % SEQUENCE
        wire = encode_frame(Frame(code_of(message), 0, number, 0, encode_message(message)))
        awaited = self.session.awaited
        name = code_of(message).name
        answer = awaited[number] = None
        try:
            for attempt in range(self.settings.tries):
                with self._turn(first):
                    if self.reader is None:  # what has come by now is no answer, and must not cost its time
                        self.drain()
                    self._send(wire, permitted)
                    if attempt:
                        self.repeats += 1
                        _LOG.info("fingertips: %s is sent again, try %d", name, attempt + 1)
                    self.wait(lambda: awaited[number] is not None, self.settings.answer_within)
                answer = awaited[number]
                if answer is not None and answer.result != Result.BUSY:
                    return _check(name, answer)
                if answer is not None:
                    awaited[number] = None
                    self.wait(lambda: False, self.settings.answer_within)
        finally:
            del awaited[number]
        if answer is not None:
            return _check(name, answer)
        raise NoAnswerError(
            f"{name}: no answer after {self.settings.tries} tries of {self.settings.answer_within:g} s; "
            "is the device alive, and the line's baud rate right?"
        )

    def keep_alive(self) -> None:
        """Tells the device that its host is there. Not answered. Raises LinkLostError."""
        message = KeepAlive(self._session)
        number = next(self._numbers) % SEQUENCE
        wire = encode_frame(Frame(code_of(message), 0, number, 0, encode_message(message)))
        self._send(wire, lambda: None)

    def report(self, kind: type[Report]) -> Report:
        """The device's present message of that kind. Raises what command raises."""
        for _ in range(self.settings.tries):
            with self.changed:
                self.session.reports.pop(kind, None)
            self.command(Request(CODES[kind]))
            with self.changed:  # it came before the acknowledgement, unless the line has lost it
                found = self.session.reports.get(kind)
            if found is not None:
                return found[1]  # pyright: ignore[reportReturnType]
        raise NoAnswerError(
            f"{kind.__name__}: the device acknowledged the request, but its answer never came; the line loses too much"
        )

    def identify(self) -> Identity:
        """Begins a session. Raises NoAnswerError, WrongDeviceError, ProtocolVersionError, LinkLostError."""
        begun, bytes_before = self._clock(), self.bytes_received
        self._session = random.SystemRandom().randrange(1 << 16)
        message = Identify(PROTOCOL[0], PROTOCOL[0], self._session)
        while True:
            with self.changed:
                self.session.renumber()
                self.session.reports.pop(Identity, None)
            try:
                self.command(message)
            except NoAnswerError:
                pass
            found = self.session.reports.get(Identity)
            if found is not None and isinstance(found[1], Identity) and not self.session.unidentified:
                return _check_identity(found[1])
            if self._clock() - begun > self.settings.open_within:
                break
        if self.bytes_received == bytes_before:
            raise NoAnswerError(
                f"nothing came within {self.settings.open_within:g} s: the device is not a fingertip, has no power, or "
                "hangs"
            )
        raise NoAnswerError(
            f"{self.bytes_received - bytes_before} bytes came within {self.settings.open_within:g} s, but no answer: "
            "the device is not a fingertip, or has another baud rate"
        )

    def _show(self, show: Callable[[Tap], None]) -> None:
        """To the tap; one that raises sees nothing any more, and does not disturb the line."""
        if self._tap is None:
            return
        try:
            show(self._tap)
        except Exception:  # noqa: BLE001  (told; whatever it is, samples go on)
            self._tap = None
            _LOG.exception("a tap of the fingertips' line has failed and sees no more of it")

    def _turn(self, first: bool) -> AbstractContextManager[None]:
        """Of one try; the reader has it always, since whoever waits for an answer waits for the reader."""
        return nullcontext() if self.reader is threading.current_thread() else self._turns.take(first)

    def _send(self, wire: bytes, permitted: Callable[[], None]) -> None:
        assert self._transport is not None
        with self._sending:
            permitted()
            self._show(lambda tap: tap.sent(self._clock(), wire))
            self._transport.write(wire)


def _check(name: str, answer: Acknowledgement) -> None:
    if answer.result == Result.BAD_VALUE:
        raise CommandRefusedError(
            f"{name}: the device refuses this value; see docs/protocol.md for its range"
        )
    if answer.result == Result.BUSY:
        raise CommandRefusedError(f"{name}: the device stays busy; try again when it has finished")
    if answer.result != Result.DONE:
        raise CommandRefusedError(
            f"{name}: the device could not do it (result {answer.result}); docs/protocol.md says when"
        )


def _check_identity(identity: Identity) -> Identity:
    if identity.model != MODEL:
        raise WrongDeviceError(
            f"the device reports model {identity.model:#06x}; a fingertip is model {MODEL:#06x}"
        )
    if identity.protocol[0] != PROTOCOL[0]:
        spoken = identity.protocol[0] or "none that this package knows"
        raise ProtocolVersionError(
            f"the device (firmware {identity.firmware[0]}.{identity.firmware[1]}) speaks protocol {spoken}, "
            f"and this package speaks {PROTOCOL[0]}; update the older of the two"
        )
    return identity
