"""The driver of both fingertips: samples, thermostats and calibration of one device on one line."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from thermograsp.errors import InvalidValueError, celsius, whole_number

from ..errors import (
    CommandRefusedError,
    DeviceError,
    NoAnswerError,
    ProtocolVersionError,
    StaleSensorError,
    StoppedError,
    WrongDeviceError,
)
from ..lines import BAUD, Opener, SerialPort, Transport
from ..protocol import (
    EVERY_CHECK,
    LATCHING,
    Calibration,
    ClearFaults,
    Condition,
    HeatersOff,
    Identity,
    Pair,
    RunSelfTest,
    Samples,
    SelfTest,
    SetRate,
    SetSetpoint,
    Status,
    ThermostatReport,
    constants_command,
    samples_of,
)
from .link import Link, LinkSettings, Tap

_POLL = 0.02  # s that a read waits at most
_SELF_TEST_WITHIN = 2.5  # s
_JOIN_WITHIN = 5.0  # s
_FASTEST = 0xFFFF  # Hz that the protocol can ask for
_ALIVE_EVERY = 2.0  # s; the device waits for 10
_HOPELESS = (WrongDeviceError, ProtocolVersionError)  # opening the port again does not help


@dataclass(frozen=True, slots=True)
class LinkStatistics:
    """Counts since the driver was opened. bytes: received. frames: accepted. rejected: chunks that were no frame.
    samples, lost, duplicates, late, echoes, late_answers, overruns: see SessionCounts. repeats: commands sent again.
    reconnects, reboots: of the line and the device. drift: of the device's clock against the host's, relative. age: s
    since the last sample, None before the first."""

    bytes: int
    frames: int
    rejected: int
    samples: int
    lost: int
    duplicates: int
    late: int
    echoes: int
    late_answers: int
    overruns: int
    repeats: int
    reconnects: int
    reboots: int
    drift: float
    age: float | None


@dataclass(frozen=True, slots=True, eq=False)
class _Wish:
    """What the thermostats shall hold, °C as calibrated, NaN for a heater that is off; None to leave them. Two wishes
    are never the same one."""

    setpoint: Pair | None

    @property
    def off(self) -> bool:
        return self.setpoint is not None and all(math.isnan(value) for value in self.setpoint)


class Fingertips:
    """The driver of both fingertips; its line is open until `close` or the end of its `with` block.

    port: a path, best a stable one (/dev/serial/by-id/...), or a function that opens a transport. rate: samples a
    second, 0 for none at first. setpoint: °C of both thermostats, None to leave the heaters as they are: they go off by
    themselves 10 s after the last host that wanted them on. tap: sees all bytes, such as a Recorder. clock: s, of the
    host. background: a thread reads, opens the port again when it is lost, and brings the device back to its rate and
    setpoint; without it, a transport of virtual time is read by whoever waits, `take` keeps the heaters on, and nothing
    is repaired.

    Errors of the line are raised by `take`, `wait` and the commands as long as they last; samples go on when it is
    repaired. Raises PortError, NoAnswerError, WrongDeviceError, ProtocolVersionError when it cannot be opened, and
    InvalidValueError for a rate or a setpoint that cannot be.
    """

    def __init__(
        self,
        port: str | Opener,
        *,
        baud: int = BAUD,
        rate: int = 100,
        setpoint: float | None = None,
        settings: LinkSettings | None = None,
        tap: Tap | None = None,
        clock: Callable[[], float] = time.monotonic,
        background: bool = True,
    ) -> None:
        self._open: Callable[[], Transport] = (
            partial(SerialPort, port, baud) if isinstance(port, str) else port
        )
        self._settings = settings or LinkSettings()
        self._clock = clock
        self._rate = _samples_a_second(rate)
        held = None if setpoint is None else celsius("setpoint (°C)", setpoint)
        self._wish = _Wish(None if held is None else (held, held))
        self._held: _Wish | None = None  # what the device has confirmed
        self._held_since = 0.0
        self._asking = 0  # threads that set a setpoint
        self._wishing = threading.Lock()
        self._alive_at = -math.inf
        self._reconnects = self._reboots = 0
        self._silent_since = 0.0
        self._error: DeviceError | None = None
        self._commanding = threading.Lock()
        self._link = Link(self._settings, clock, tap)
        self._link.stopped = lambda: self._error
        self.identity: Identity
        self.calibration = Calibration()
        try:
            self._link.use(self._open())
            self.identity = self._link.identify()
            self._configure()
        except BaseException:
            self._link.close()
            raise
        if background:
            self._link.reader = threading.Thread(target=self._read, name="fingertips", daemon=True)
            self._link.reader.start()

    def __enter__(self) -> Fingertips:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Ends the thread and releases the port; the device goes on, with its heaters for 10 s. Does nothing the second
        time."""
        self._link.closing.set()
        reader = self._link.reader
        if reader is not None and reader is not threading.current_thread():
            reader.join(_JOIN_WITHIN)
        self._link.close()

    def take(self) -> Samples:
        """All samples since the last call, maybe none. Raises StaleSensorError while the device should send and does
        not, LinkLostError while the port is gone."""
        if self._link.reader is None:
            self._link.drain()
            self._check_silence()
            self._keep_alive()
        return self._taken()

    def wait(self, count: int, seconds: float) -> Samples:
        """Waits for at least `count` samples and returns them, all since the last take. Raises StaleSensorError when
        they have not come within `seconds`, and what take raises."""
        rows = self._link.session.rows
        if self._link.reader is None:
            self._keep_alive()
        if not self._link.wait(lambda: len(rows) >= count, seconds):
            raise StaleSensorError(f"{len(rows)} of {count} samples came in {seconds:g} s at {self._rate} Hz")
        return self._taken()

    def set_rate(self, rate: int) -> None:
        """Samples a second, 0 to stop. Raises InvalidValueError for what is no whole number from 0 on."""
        rate = _samples_a_second(rate)
        with self._commanding:
            self._link.command(SetRate(rate))
        self._silent_since = self._clock()  # first: the reader looks at both
        self._rate = rate

    def set_setpoint(self, left: float | None, right: float | None) -> None:
        """°C of each thermostat; None turns its heater off. Both off goes before what other threads have asked for.
        Where it raises, a heater that was to be off is not turned on again, by a reconnect or otherwise, until it is
        asked for; StoppedError: another thread has set another one meanwhile."""
        a, b = (math.nan if value is None else celsius("setpoint (°C)", value) for value in (left, right))
        wish = _Wish((a, b))
        with self._wishing:
            before, self._wish = self._wish.setpoint, wish
            self._asking += 1
        try:
            self._hold(wish)
        except BaseException:
            with self._wishing:
                if self._wish is wish:
                    self._wish = _Wish(_after_failure(before, (a, b)))
            raise
        finally:
            with self._wishing:
                self._asking -= 1

    def clear_faults(self) -> Condition:
        """Ends what has latched the heaters off, such as over-temperature, so that they follow the setpoint again, and
        returns what is left of it. Raises CommandRefusedError while a thermostat is too hot still."""
        with self._commanding:
            seen = self._link.report(Condition)
            self._link.command(ClearFaults(seen.heaters_off & LATCHING))
            return self._link.report(Condition)

    def set_calibration(self, calibration: Calibration) -> None:
        """Has the device keep these constants, and applies them from the next take on, and to the setpoint."""
        with self._commanding:
            self._link.command(constants_command(calibration))
            self.calibration = self._link.report(Calibration)
            with self._wishing:
                self._wish = _Wish(self._wish.setpoint)
            self._hold_newest()

    def condition(self) -> Condition:
        """What made the device start, and why heaters are off."""
        with self._commanding:
            return self._link.report(Condition)

    def status(self) -> Status:
        """The device's counters."""
        with self._commanding:
            return self._link.report(Status)

    def thermostats(self) -> ThermostatReport:
        """Setpoints and temperatures as the device has them, not calibrated, and the heaters' powers."""
        with self._commanding:
            return self._link.report(ThermostatReport)

    def self_test(self, checks: int = EVERY_CHECK) -> SelfTest:
        """What the device finds about itself, within 2.5 s."""
        reports = self._link.session.reports
        with self._commanding:
            reports.pop(SelfTest, None)
            self._link.command(RunSelfTest(checks))
            if not self._link.wait(lambda: SelfTest in reports, _SELF_TEST_WITHIN):
                raise NoAnswerError(f"self-test: no result within {_SELF_TEST_WITHIN:g} s; run it again")
            return reports[SelfTest][1]  # pyright: ignore[reportReturnType]

    def statistics(self) -> LinkStatistics:
        """What the line has done so far."""
        link, session = self._link, self._link.session
        with link.changed:
            counts, decoder, last = session.counts, session.decoder.counts, session.last_sample
            return LinkStatistics(
                bytes=link.bytes_received,
                frames=decoder.accepted,
                rejected=decoder.rejected,
                **{name: getattr(counts, name) for name in counts.__slots__},
                repeats=link.repeats,
                reconnects=self._reconnects,
                reboots=self._reboots,
                drift=session.clock.drift,
                age=None if last is None else self._clock() - last,
            )

    def _hold(self, wish: _Wish) -> None:
        """Has the device do what is wished; raises StoppedError, and sends nothing more, once another wish is newer."""
        if wish.setpoint is None:
            return

        def permitted() -> None:
            if self._wish is not wish:
                raise StoppedError("another setpoint was requested meanwhile")

        self._link.command(self._setpoint_command(wish.setpoint), first=wish.off, permitted=permitted)
        self._held_since = self._clock()
        self._held = wish

    def _hold_newest(self) -> None:
        """Has the device do what is wished now, whatever that becomes meanwhile."""
        while True:
            wish = self._wish
            try:
                return self._hold(wish)
            except StoppedError:
                continue
            except CommandRefusedError:  # a calibration may have put it out of range
                with self._wishing:
                    if self._wish is wish:
                        self._wish = _Wish((math.nan, math.nan))
                raise

    def _keep_alive(self) -> None:
        """Tells the device to go on heating, while it does what is wished."""
        wish, now = self._wish, self._clock()
        wanted = wish.setpoint is not None and not wish.off and self._held is wish
        if wanted and now - self._alive_at >= _ALIVE_EVERY:
            self._link.keep_alive()
            self._alive_at = now

    def _reheat(self) -> None:
        """Where the device does not do what is wished: a setpoint that failed, or heaters off since this host was
        silent for long."""
        if self._asking or self._wish.setpoint is None:
            return
        when, seen = self._link.session.reports.get(Condition, (0.0, None))
        silent = isinstance(seen, Condition) and bool(seen.heaters_off & HeatersOff.HOST_SILENT)
        if self._held is not self._wish or (silent and when > self._held_since):
            self._link.note("setpoint sent again")
            self._hold_newest()

    def _setpoint_command(self, wanted: Sequence[float]) -> SetSetpoint:
        left, right = (
            value + offset for value, offset in zip(wanted, self.calibration.thermostat_offset, strict=True)
        )
        return SetSetpoint((left, right))

    def _taken(self) -> Samples:
        if (error := self._error) is not None:
            raise type(error)(str(error)) from error
        session = self._link.session
        with self._link.changed:
            rows = list(session.rows)
            session.rows.clear()
        return samples_of(rows, self.calibration)

    def _configure(self) -> None:
        """Brings a device that has identified itself to where it shall be."""
        self.calibration = self._link.report(Calibration)
        self._hold_newest()
        self._link.command(SetRate(self._rate))
        self._silent_since = self._clock()

    def _check_silence(self) -> None:
        silent = self._clock() - max(self._silent_since, self._link.session.last_sample or 0.0)
        if self._rate and silent > self._settings.stale_after + 1.0 / self._rate:
            raise StaleSensorError(
                f"no sample for {silent:.2f} s at {self._rate} Hz; the device hangs, or its cable is loose"
            )

    def _read(self) -> None:
        """The thread: reads, and repairs what breaks, until it is closed or cannot go on."""
        try:
            while not self._link.closing.is_set():
                try:
                    self._link.pump(_POLL)
                    self._check_silence()
                    if self._link.session.unidentified:
                        self._resume(restarted=True)
                    self._reheat()
                    self._keep_alive()
                except _HOPELESS:
                    raise
                except (DeviceError, OSError) as error:
                    self._repair(error)
        except BaseException as error:  # noqa: BLE001  (raised to whoever takes)
            self._fail(error)

    def _repair(self, error: Exception) -> None:
        self._set_error(error if isinstance(error, DeviceError) else DeviceError(str(error)))
        self._link.note(f"lost: {error}")
        while not self._link.closing.is_set():
            self._link.close()
            try:
                self._link.use(self._open())
                self._resume()
            except _HOPELESS:
                raise
            except (DeviceError, OSError):
                self._link.closing.wait(self._settings.reopen_every)
                continue
            self._reconnects += 1
            self._link.note("reconnected")
            self._set_error(None)
            return

    def _resume(self, restarted: bool = False) -> None:
        """Brings the device back. restarted: it has started anew; else its number of starts tells."""
        self._held = None
        identity = self._link.identify()
        if identity.serial != self.identity.serial:
            raise WrongDeviceError(
                f"another device answers: number {identity.serial:#x} instead of {self.identity.serial:#x}"
            )
        if restarted or identity.boots != self.identity.boots:
            self._reboots += 1
            self._link.note("rebooted")
        self.identity = identity
        self._configure()

    def _set_error(self, error: DeviceError | None) -> None:
        with self._link.changed:
            self._error = error
            self._link.changed.notify_all()

    def _fail(self, error: BaseException) -> None:
        self._set_error(
            error if isinstance(error, DeviceError) else DeviceError(f"the reader broke: {error!r}")
        )
        self._link.close()


def _samples_a_second(rate: object) -> int:
    count = whole_number("rate (samples a second)", rate)
    if count > _FASTEST:
        raise InvalidValueError(f"rate must be {_FASTEST} samples a second at most, got {rate}")
    return count


def _after_failure(before: Pair | None, requested: Pair) -> Pair | None:
    """The setpoints to hold where `requested` has failed: those before it, without the heaters to be turned off."""
    off = [math.isnan(value) for value in requested]
    if before is None:
        return (math.nan, math.nan) if any(off) else None
    left, right = (math.nan if is_off else value for is_off, value in zip(off, before, strict=True))
    return left, right
