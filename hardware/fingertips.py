"""The driver of both fingertips: samples, thermostats and calibration of one device on one line."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from .errors import DeviceError, NoAnswerError, ProtocolVersionError, StaleSensorError, WrongDeviceError
from .link import Link, LinkSettings, Tap
from .messages import (
    EVERY_CHECK,
    Calibration,
    Identity,
    RunSelfTest,
    SelfTest,
    SetRate,
    SetSetpoint,
    Status,
    ThermostatReport,
    constants_command,
)
from .samples import Samples, samples_of
from .serial_port import BAUD, SerialPort
from .transport import Opener, Transport

_POLL = 0.02  # s that a read waits at most
_SELF_TEST_WITHIN = 2.5  # s
_JOIN_WITHIN = 5.0  # s
_HOPELESS = (WrongDeviceError, ProtocolVersionError)  # opening the port again does not help


@dataclass(frozen=True, slots=True)
class LinkStatistics:
    """Since the driver was opened. bytes: received. frames: accepted. rejected: chunks that were no frame. samples,
    lost, duplicates, late, echoes, late_answers, overruns: see SessionCounts. repeats: commands sent again. reconnects,
    reboots: of the line and the device. drift: of the device's clock against the host's, relative. age: s since the
    last sample, None before the first."""

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


class Fingertips:
    """Open from its making until `close` or the end of its `with` block.

    port: a path, best a stable one (/dev/serial/by-id/...), or a function that opens a transport. rate: samples a
    second, 0 for none at first. setpoint: °C of both thermostats, None to leave the heaters as they are. tap: sees all
    bytes, such as a Recorder. clock: s, of the host. background: a thread reads, opens the port again when it is lost,
    and brings the device back to its rate and setpoint; without it, a transport of virtual time is read by whoever
    waits, and nothing is repaired.

    Errors of the line are raised by `take`, `wait` and the commands as long as they last; samples go on when it is
    repaired. Raises PortError, NoAnswerError, WrongDeviceError, ProtocolVersionError when it cannot be opened.
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
        self._rate = rate
        self._setpoint = None if setpoint is None else (setpoint, setpoint)
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
        """Ends the thread and releases the port; the device goes on as it is. Does nothing the second time."""
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
        return self._taken()

    def wait(self, count: int, seconds: float) -> Samples:
        """At least `count` samples, all since the last take. Raises StaleSensorError when they have not come within
        `seconds`, and what take raises."""
        rows = self._link.session.rows
        if not self._link.wait(lambda: len(rows) >= count, seconds):
            raise StaleSensorError(f"{len(rows)} of {count} samples came in {seconds:g} s at {self._rate} Hz")
        return self._taken()

    def set_rate(self, rate: int) -> None:
        """Samples a second, 0 to stop."""
        self._command(SetRate(rate))
        self._silent_since = self._clock()  # first: the reader looks at both
        self._rate = rate

    def set_setpoint(self, left: float | None, right: float | None) -> None:
        """°C of each thermostat; None turns its heater off."""
        wanted = tuple(float("nan") if value is None else value for value in (left, right))
        self._command(self._setpoint_command(wanted))
        self._setpoint = wanted

    def set_calibration(self, calibration: Calibration) -> None:
        """Has the device keep these constants, and applies them from the next take on, and to the setpoint."""
        with self._commanding:
            self._link.command(constants_command(calibration))
            self.calibration = self._link.report(Calibration)
            if self._setpoint is not None:
                self._link.command(self._setpoint_command(self._setpoint))

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

    def _command(self, message: SetRate | SetSetpoint) -> None:
        with self._commanding:
            self._link.command(message)

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
        if self._setpoint is not None:
            self._link.command(self._setpoint_command(self._setpoint))
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
                        self._restart()
                except _HOPELESS:
                    raise
                except (DeviceError, OSError) as error:
                    self._repair(error)
        except BaseException as error:  # noqa: BLE001  (raised to whoever takes)
            self._fail(error)

    def _restart(self) -> None:
        self._reboots += 1
        self._link.note("rebooted")
        self._resume()

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
            self._set_error(None)
            return

    def _resume(self) -> None:
        identity = self._link.identify()
        if identity.serial != self.identity.serial:
            raise WrongDeviceError(
                f"another device answers: number {identity.serial:#x} instead of {self.identity.serial:#x}"
            )
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
