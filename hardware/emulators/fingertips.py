"""A device of the fingertips' protocol in software: what arrives, what time it is, and what it sends in return.

It follows docs/protocol.md from the device's side and has no input or output of its own: VirtualLine and PtyDevice do.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...thermal import (
    IDEAL,
    SignalChain,
    Thermostat,
    measure,
    saturated,
    settled,
)
from ..lines import LineFaults
from ..protocol import (
    EVERY_CHECK,
    MICROSECONDS,
    MODEL,
    PROTOCOL,
    SEQUENCE,
    Acknowledgement,
    Calibration,
    Check,
    ClearFaults,
    Code,
    Condition,
    Decoder,
    Flag,
    Frame,
    HeatersOff,
    Identify,
    Identity,
    KeepAlive,
    Message,
    Pair,
    Request,
    Reset,
    Result,
    RunSelfTest,
    Sample,
    SelfTest,
    SetCalibration,
    SetRate,
    SetSetpoint,
    Status,
    ThermostatReport,
    Triple,
    code_of,
    decode_message,
    encode_frame,
    encode_message,
)
from .feel import Feel, Source, untouched
from .plates import EmulatedPlates

_TICK = 0.5e-6  # s, half a step of its clock: what is due so soon is due
_REPORT = 1.0  # s between status messages while sampling
_SELF_TEST = 0.3  # s that it takes
_REMEMBERED = 8  # commands
_ROOM = 1 << 16  # bytes that wait to be sent; its thread may sleep for a second where the machine is busy
_SETPOINTS = (0.0, 60.0)  # °C
_MOST_VOLTAGE = (2**31 - 1) / 1e9  # V in the sample's field
_SUPPLY = 5.0  # V
_SILENCE = 10.0  # s without a sign of the host, after which the setpoints end


@dataclass(frozen=True, slots=True)
class DeviceModel:
    """The properties of an emulated device. chain: amplifier and converter. thermostat: of each fingertip; a host sets
    its setpoint. drift: of the clock, relative. max_rate: Hz. most_force: N at which a load cell is at the end of its
    range. checks: the self-tests that it can perform. serial, firmware, protocol, model: how it identifies itself."""

    chain: SignalChain = IDEAL
    thermostat: Thermostat = Thermostat()
    drift: float = 0.0
    max_rate: int = 1000
    most_force: float = 62.4
    checks: Check = EVERY_CHECK
    serial: int = 1
    firmware: tuple[int, int] = (0, 2)
    protocol: tuple[int, int] = PROTOCOL
    model: int = MODEL


class EmulatedFingertips:
    """An emulated device that boots at time 0. source: what it feels. rng: of the converter's noise and the line's
    faults.

    line: faults of its line. broken_thermistors, broken_heaters, broken_converters, saturated: the fingertips (0 left,
    1 right) that have this fault. All may be changed at any time, as may stall_until, the time in s until which the
    device neither receives nor sends anything.
    """

    def __init__(
        self,
        source: Source = untouched,
        model: DeviceModel | None = None,
        *,
        rng: np.random.Generator | None = None,
        calibration: Calibration | None = None,
    ) -> None:
        self.model = model or DeviceModel()
        self.source = source
        self.rng = rng or np.random.default_rng(0)
        self.calibration = calibration or Calibration()
        self.line = LineFaults()
        self._plates = EmulatedPlates(self.model.thermostat)
        self.broken_thermistors = self._plates.broken_thermistors
        self.broken_heaters = self._plates.broken_heaters
        self.broken_converters: set[int] = set()
        self.saturated: set[int] = set()
        self.stall_until = 0.0
        self.executed: list[Message] = []
        self.boots = 0
        self._now = 0.0
        self._out: deque[bytes] = deque()
        self._late: list[tuple[float, Acknowledgement]] = []
        self._planned: list[tuple[float, Callable[[], None]]] = []
        self.reboot(Reset.POWER_ON)

    def reboot(self, cause: Reset = Reset.EXTERNAL) -> None:
        """Starts anew: time, numbers and settings from 0, heaters off, calibration and latched faults kept."""
        self.boots += 1
        self._cause = cause
        self._booted = self._now
        self._decoder = Decoder()
        self._sequence = 0
        self._rate = 0
        self._samples = self._overruns = self._repeats = 0
        self._next_sample = self._next_report = self._test_done = math.inf
        self._tested = Check(0)
        self._plates.setpoint = (math.nan, math.nan)
        self._alive_at, self._silenced = self._now, False
        self._unidentified = True
        self._session: int | None = None
        self._results: dict[int, Result] = {}
        self._rest()
        self._out.clear()
        self._late.clear()
        self._send(self._identity(self.model.protocol))

    def overheat(self, fingertip: int) -> None:
        """Puts a fingertip's plate at 80 °C, from where it cools."""
        self._plates.put(fingertip, 80.0)

    def plan(self, time: float, action: Callable[[], None]) -> None:
        """Has `action` done at that time, s."""
        self._planned.append((time, action))
        self._planned.sort(key=lambda item: item[0])

    @property
    def due(self) -> float:
        """s, when `advance` next has something to do."""
        times = [self._next_sample, self._next_report, self._test_done]
        times += [time for time, _ in self._late] + [time for time, _ in self._planned[:1]]
        return max(min(times), self.stall_until)

    def advance(self, now: float) -> None:
        """Does all that is due up to time `now`, s. Missed samples of a stall are not made up for."""
        while (due := self.due) <= now + _TICK:
            self._now = max(self._now, due)
            self._act()
        self._now = max(self._now, now)

    def receive(self, data: bytes) -> None:
        """Bytes from the host, now."""
        if self._now < self.stall_until:
            return
        for frame in self._decoder.feed(data):
            if frame.code & 0x80:
                self._command(frame)

    def outgoing(self) -> list[bytes]:
        """What to send, a frame each."""
        frames = list(self._out)
        self._out.clear()
        return frames

    def _act(self) -> None:
        while self._planned and self._planned[0][0] <= self._now:
            self._planned.pop(0)[1]()
        ready = [answer for time, answer in self._late if time <= self._now]
        self._late = [item for item in self._late if item[0] > self._now]
        for answer in ready:
            self._send(answer)
        if self._next_sample <= self._now:
            self._sample()
            behind = max(0, math.floor((self._now - self._next_sample) * self._rate))  # in a stall
            self._next_sample += (1 + behind) / self._rate
        if self._next_report <= self._now:
            self._send(self._thermostats())
            self._send(self._status())
            self._send(self._condition())
            self._next_report = self._now + _REPORT
        if self._test_done <= self._now:
            self._test_done = math.inf
            self._send(self._self_test())

    def _command(self, frame: Frame) -> None:
        message = decode_message(frame.code, frame.payload)
        if isinstance(message, KeepAlive):
            if message.session == self._session:
                self._control()
                self._alive_at = self._now
            return
        if isinstance(message, Identify):
            self._identify(message)
            result = Result.DONE
        elif isinstance(message, Request):
            result = self._report(message.wanted)
        elif frame.sequence in self._results:
            self._repeats += 1
            result = self._results[frame.sequence]
        else:
            result = self._execute(message)
            if result != Result.BUSY:
                self.executed.append(message)
                self._results[frame.sequence] = result
                while len(self._results) > _REMEMBERED:
                    del self._results[next(iter(self._results))]
        answer = Acknowledgement(frame.sequence, frame.code, result)
        if self.line.drop_answer and self.rng.random() < self.line.drop_answer:
            return
        if self.line.answer_delay:
            self._late.append((self._now + self.line.answer_delay, answer))
        else:
            self._send(answer)

    def _identify(self, message: Identify) -> None:
        protocol = self.model.protocol
        common = message.oldest <= protocol[0] <= message.newest
        self._unidentified = False
        if message.session != self._session:
            self._session = message.session
            self._results.clear()
        self._send(self._identity(protocol if common else (0, 0)))

    def _report(self, wanted: int) -> Result:
        makers = {
            Code.THERMOSTAT: self._thermostats,
            Code.STATUS: self._status,
            Code.CALIBRATION: lambda: self.calibration,
            Code.CONDITION: self._condition,
        }
        if wanted not in makers:
            return Result.BAD_VALUE
        self._send(makers[Code(wanted)]())
        return Result.DONE

    def _execute(self, message: Message) -> Result:
        if isinstance(message, SetRate):
            if message.rate > self.model.max_rate:
                return Result.BAD_VALUE
            self._rate = message.rate
            self._next_sample = self._now + 1.0 / message.rate if message.rate else math.inf
            self._next_report = self._now + _REPORT if message.rate else math.inf
            self._rest()
        elif isinstance(message, SetSetpoint):
            low, high = _SETPOINTS
            if not all(math.isnan(value) or low <= value <= high for value in message.setpoint):
                return Result.BAD_VALUE
            self._control()
            self._plates.setpoint = message.setpoint
            self._alive_at, self._silenced = self._now, False
        elif isinstance(message, ClearFaults):
            self._control()
            if not self._plates.clear(HeatersOff(message.faults)):
                return Result.FAILED
        elif isinstance(message, SetCalibration):
            self.calibration = Calibration(**{name: getattr(message, name) for name in Calibration.__slots__})
        elif isinstance(message, RunSelfTest):
            if self._test_done < math.inf:
                return Result.BUSY
            self._tested, self._test_done = Check(message.checks) & self.model.checks, self._now + _SELF_TEST
        return Result.DONE

    def _sample(self) -> None:
        self._feel = feel = self.source(self._now)
        self._control()
        volts, flags = self._convert(feel)
        if sum(map(len, self._out)) > _ROOM:
            self._overruns += 1
            return
        self._samples += 1
        left, right = (self._weighed(force) for force in feel.force)
        self._send(Sample(volts, self._plates.temperatures, (left, right)), flags)

    def _weighed(self, force: Triple) -> Triple:
        """N by the load cells; one that is at an end of its range does not know."""
        most = self.model.most_force
        normal, first, second = (math.nan if abs(value) >= most else value for value in force)
        return normal, first, second

    def _convert(self, feel: Feel) -> tuple[Pair, Flag]:
        """What the converter says of the voltages, and which are at an end of its range."""
        chain, volts = self.model.chain, np.array(feel.voltage, float)
        if chain is not IDEAL:
            noise = self.rng.standard_normal((2, 1)) if chain.noise else np.zeros((2, 1))
            self._chain, read = measure(chain, self._chain, volts[:, None], 1.0, 1.0 / self._rate, noise)
            volts = read[:, 0]
        top = min(chain.limits[1], _MOST_VOLTAGE)
        for fingertip in self.saturated:
            volts[fingertip] = top
        full = saturated(chain, volts) | (np.abs(volts) >= top)
        for fingertip in self.broken_converters:
            volts[fingertip], full[fingertip] = np.nan, False
        volts = np.clip(volts, -_MOST_VOLTAGE, _MOST_VOLTAGE)
        flags = Flag.SATURATED_LEFT * int(full[0]) | Flag.SATURATED_RIGHT * int(full[1])
        return (float(volts[0]), float(volts[1])), Flag(flags)

    def _control(self) -> None:
        feel, plates, end = self._feel, self._plates, self._alive_at + _SILENCE
        heating = not all(map(math.isnan, plates.setpoint))
        if heating and self._now >= end:
            plates.advance(end, feel.heat, feel.thermostat)
            plates.setpoint, self._silenced = (math.nan, math.nan), True
        plates.advance(self._now, feel.heat, feel.thermostat)

    def _rest(self) -> None:
        """The amplifier has seen the present voltage for long."""
        self._feel = self.source(self._now)
        self._chain = settled(np.array(self._feel.voltage), 1.0)

    def _identity(self, protocol: tuple[int, int]) -> Identity:
        model, chain = self.model, self.model.chain
        limit = min(chain.span / chain.gain, _MOST_VOLTAGE)
        return Identity(
            model.model,
            protocol,
            model.firmware,
            self.boots,
            model.max_rate,
            model.serial,
            chain.resolution,
            limit,
        )

    def _thermostats(self) -> ThermostatReport:
        self._control()
        plates = self._plates
        return ThermostatReport(plates.setpoint, plates.temperatures, plates.powers)

    def _status(self) -> Status:
        return Status(
            uptime=int(self._now - self._booted),
            samples=self._samples,
            overruns=self._overruns % SEQUENCE,
            bad_frames=self._decoder.counts.rejected % SEQUENCE,
            repeats=self._repeats % SEQUENCE,
            supply=_SUPPLY,
            rate=self._rate,
        )

    def _condition(self) -> Condition:
        self._control()
        silent = HeatersOff.HOST_SILENT if self._silenced else HeatersOff(0)
        return Condition(self._cause, self._plates.latched | silent)

    def _self_test(self) -> SelfTest:
        failed = self._plates.failed
        if self.saturated or self.broken_converters:
            failed |= Check.CONVERTER
        noise = self.model.chain.noise
        left, right = (
            0.0 if i in self.broken_heaters else self.model.thermostat.power_limit / _SUPPLY for i in range(2)
        )
        return SelfTest(self._tested, failed & self._tested, (noise, noise), (left, right))

    def _send(self, message: Message, flags: Flag = Flag(0)) -> None:  # noqa: B008  (an immutable 0)
        elapsed = (self._now - self._booted) * (1 + self.model.drift)
        device_us = round(elapsed * 1e6) % MICROSECONDS
        payload = encode_message(message)
        flags |= self._plates.flags
        if self._unidentified:
            flags |= Flag.UNIDENTIFIED
        frame = Frame(code_of(message), flags, self._sequence, device_us, payload)
        self._sequence = (self._sequence + 1) % SEQUENCE
        wire = self.line.spoil(encode_frame(frame), self.rng)
        if wire:
            self._out.append(wire)
