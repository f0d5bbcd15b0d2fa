"""A Robotiq 2F-85 over Modbus RTU."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from types import TracebackType
from typing import Any
from urllib.parse import parse_qsl, urlsplit

import numpy as np

from thermograsp.errors import InvalidValueError

from ..errors import GripperFaultError, GripperTimeoutError, StoppedError
from ..lines import Opener, SerialPort
from .gripper import Contact, GripperStatus
from .modbus_line import ModbusLine, ModbusSettings
from .robotiq_registers import (
    BAUD,
    COMMAND,
    COUNT,
    FIRST_MAJOR,
    SLAVE,
    STATUS,
    Action,
    Activation,
    Fault,
    ObjectSeen,
    State,
    fault_text,
    state,
)
from .robotiq_units import CURRENT_STEP, RobotiqUnits

_ACTIVATION_WITHIN = 10.0  # s; the manual's sequence takes about 3
_TRAVEL_WITHIN = 6.0  # s; the stroke takes 4.25 s at the slowest speed
_RESET_WITHIN = 0.5  # s
_CONTACTS = {ObjectSeen.WHILE_OPENING: Contact.OPENING, ObjectSeen.WHILE_CLOSING: Contact.CLOSING}


class RobotiqGripper:
    """A Robotiq 2F gripper on Modbus RTU; its line is open until `close` or the end of its `with` block. See Gripper
    for what its methods have in common.

    port: a path, best a stable one (/dev/serial/by-id/...), or a function that opens a transport. units: of this
    gripper. clock, sleep: s, of the host, or of a virtual line (line.clock, line.advance).

    The next call opens a port again that was lost. A gripper that was without power meanwhile reports it and needs
    `activate`; no other method makes the fingers travel on their own. Raises PortError, NoAnswerError if it cannot be
    reached.
    """

    def __init__(
        self,
        port: str | Opener,
        *,
        slave: int = SLAVE,
        units: RobotiqUnits | None = None,
        settings: ModbusSettings | None = None,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        opener = partial(SerialPort, port, BAUD) if isinstance(port, str) else port
        self.units = units or RobotiqUnits()
        self._clock = clock
        name = f"gripper on {port}" if isinstance(port, str) else "gripper"
        self._line = ModbusLine(opener, slave, settings or ModbusSettings(), clock, sleep, name)
        self._one_move = threading.Lock()
        self._telling = threading.Lock()  # guards what follows
        self._stops = 0  # so far
        self._activating = False  # it has been told to activate and has not said yet that it is
        self._going = False  # it has been told to follow positions
        self._wanted: int | None = None  # the position it was told last
        try:
            self.state()
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> RobotiqGripper:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Releases the port; the fingers stay as they are. Does nothing the second time."""
        self._line.close()

    @property
    def stroke(self) -> float:
        """m between the pads of the open gripper."""
        return self.units.stroke

    def activate(self) -> None:
        """Resets it and has it find its travel, where it is not ready already: the fingers close and open wholly, and
        what they hold falls. Waits up to 10 s. Raises GripperFaultError, GripperTimeoutError, StoppedError."""
        stops = self._stops
        now = self.state()
        if now.activation != Activation.DONE or now.fault >= FIRST_MAJOR:
            self._activate_anew(stops)

    def clear_faults(self) -> None:
        """Resets it, faults included, and activates it anew; see activate."""
        self._activate_anew(self._stops)

    def move(self, opening: float, force: float, speed: float) -> GripperStatus:
        """Sends the fingers to an opening, 0 .. stroke m, and returns at once. force: N; below the weakest, 20 N, it is
        that. speed: m/s likewise. Raises GripperFaultError for a gripper that does not move, InvalidValueError, and
        StoppedError where `stop` was called meanwhile."""
        return self._move(opening, force, speed, self._stops)

    def stop(self) -> GripperStatus:
        """The fingers stay where they are and hold what they hold. Goes before whatever other threads ask for, after
        one try of a request at most, and nothing that they were told before is carried out any more: `move`, `activate`
        and `clear_faults` raise StoppedError there, `wait` returns. An activation that is broken off is to be begun
        anew."""
        with self._telling:
            self._stops += 1
            activating = self._activating
            self._going, self._wanted = False, None
        now = self.state(first=True)
        if now.activation == Activation.DONE:
            now = self._write(COMMAND, Action(activate=True).registers()[:1], None)
        elif now.activated or activating:  # what it was told last may not show yet
            now = self._write(COMMAND, Action().registers()[:1], None)
        return self._status(now)

    def status(self) -> GripperStatus:
        """The gripper's status; a fault is in it, not raised."""
        return self._status(self.state())

    def wait(self, seconds: float = _TRAVEL_WITHIN) -> GripperStatus:
        """Waits until the fingers have arrived or are stopped by something. Raises GripperFaultError,
        GripperTimeoutError."""
        return self._status(
            self._await(lambda now: not self._moving(now), seconds, "the end of its motion", healthy=True)
        )

    def measure_counts(self) -> RobotiqUnits:
        """Closes and opens it wholly, with nothing between the fingers, and takes where they end for its counts. The
        new units are also kept as `units`. Raises what move and wait raise."""
        stops = self._stops
        slow, weak = self.units.slowest, self.units.weakest
        ends = []
        for opening in (0.0, self.units.stroke):
            self._move(opening, weak, 2 * slow, stops)
            self.wait()
            self._require_unstopped(stops)
            ends.append(self.state().position)
        self.units = replace(self.units, closed_count=ends[0], open_count=ends[1])
        return self.units

    def quantised(self, opening: Any, force: Any, speed: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(opening m, force N, speed m/s) that it makes of a command, elementwise."""
        return self.units.quantised(opening, force, speed)

    def state(self, *, first: bool = False) -> State:
        """The gripper's registers as they are. first: asked for before whatever other threads wait for."""
        return state(self._line.read(STATUS, COUNT, first=first))

    def _move(self, opening: float, force: float, speed: float, stops: int) -> GripperStatus:
        """stops: how often it had been stopped when this was asked for."""
        counts = (
            self.units.position_counts(opening),
            self.units.speed_counts(speed),
            self.units.force_counts(force),
        )
        position, rate, limit = (int(count) for count in counts)
        values = Action(activate=True, go=True, position=position, speed=rate, force=limit).registers()
        with self._one_move:
            # While it follows positions the action register is left alone: after a loss of power, to write it would
            # begin an activation.
            now = self._write(COMMAND + 1, values[1:], stops) if self._going else self.state()
            _require_active(now)
            if not (self._going and now.going):
                now = self._write(COMMAND, values, stops)
                _require_active(now)
            self._know(stops, going=True, wanted=position)
            return self._status(now)

    def _activate_anew(self, stops: int) -> None:
        self._write(COMMAND, Action().registers(), stops)
        self._await(
            lambda now: now.activation == Activation.RESET and not now.fault,
            _RESET_WITHIN,
            "its reset",
            stops=stops,
        )
        try:
            self._know(stops, activating=True)
            self._write(COMMAND, Action(activate=True).registers(), stops)
            self._await(
                lambda now: now.activation == Activation.DONE,
                _ACTIVATION_WITHIN,
                "its activation",
                healthy=True,
                stops=stops,
            )
        finally:
            with self._telling:
                self._activating = False

    def _write(self, address: int, values: list[int], stops: int | None) -> State:
        """Writes registers and reads the state in the same transaction. It is how the gripper was just before. stops:
        how often it had been stopped when this was asked for; None for a stop itself."""
        going = self._going
        if stops is not None:
            self._know(stops)  # unknown, where it raises
        written = self._line.exchange(
            address,
            values,
            STATUS,
            COUNT,
            first=stops is None,
            permitted=partial(self._require_unstopped, stops),
        )
        if stops is not None:
            self._know(stops, going=going and address != COMMAND)
        return state(written)

    def _know(
        self, stops: int, *, going: bool = False, wanted: int | None = None, activating: bool = False
    ) -> None:
        """Keeps what it has been told. Raises StoppedError."""
        with self._telling:
            self._require_unstopped(stops)
            self._going, self._wanted, self._activating = going, wanted, activating or self._activating

    def _require_unstopped(self, stops: int | None) -> None:
        if stops not in (None, self._stops):
            raise StoppedError("gripper: it was stopped meanwhile; send the command again")

    def _await(
        self,
        ready: Callable[[State], bool],
        seconds: float,
        what: str,
        healthy: bool = False,
        stops: int | None = None,
    ) -> State:
        """The first state that is ready. healthy: a major fault ends it. stops: a stop since then ends it."""
        deadline = self._clock() + seconds
        while True:
            now = self.state()
            if stops is not None:
                self._require_unstopped(stops)
            if now.fault >= FIRST_MAJOR and (healthy or self._clock() > deadline):
                raise GripperFaultError(f"gripper: {fault_text(now.fault)}")
            if ready(now):
                return now
            if self._clock() > deadline:
                raise GripperTimeoutError(
                    f"gripper: {what} did not come within {seconds:g} s; are the fingers free to move?"
                )

    def _status(self, now: State) -> GripperStatus:
        moving = self._moving(now)
        stopped = now.going and not moving
        return GripperStatus(
            opening=float(self.units.opening(now.position)),
            target=float(self.units.opening(now.requested)),
            moving=moving,
            contact=_CONTACTS.get(now.seen, Contact.NONE) if stopped else Contact.NONE,
            current=now.current * CURRENT_STEP,
            active=now.activation == Activation.DONE and now.fault < FIRST_MAJOR,
            fault=fault_text(now.fault),
        )

    def _moving(self, now: State) -> bool:
        """Right after a command its state is the one before: the echo tells (manual, register gPR)."""
        travels = now.going and now.seen == ObjectSeen.MOVING
        unheard = self._wanted is not None and now.requested != self._wanted
        return (
            travels or unheard or now.activation == Activation.RUNNING or now.fault == Fault.RELEASE_RUNNING
        )


def robotiq_from_url(url: str, **keywords: Any) -> RobotiqGripper:
    """A gripper of "robotiq:///dev/ttyUSB0" or "robotiq:///dev/ttyUSB0?slave=10", opened. keywords:
    RobotiqGripper's. Raises InvalidValueError for another form."""
    parts = urlsplit(url)
    options = dict(parse_qsl(parts.query))
    slave = options.pop("slave", str(SLAVE))
    if parts.netloc or not parts.path or options or not slave.isdigit() or not 1 <= int(slave) <= 247:
        raise InvalidValueError(
            f"gripper {url!r}: give robotiq://PORT or robotiq://PORT?slave=N, PORT a path such as /dev/ttyUSB0, N 1 "
            "to 247"
        )
    return RobotiqGripper(parts.path, **{"slave": int(slave), **keywords})


def _require_active(now: State) -> None:
    """Raises GripperFaultError unless it follows positions. That it heard nothing for a second has passed by now."""
    if now.fault and now.fault != Fault.NO_COMMUNICATION:
        raise GripperFaultError(f"gripper: {fault_text(now.fault)}")
    if now.activation != Activation.DONE:
        raise GripperFaultError(
            "gripper: it is not active, as after a loss of power; call activate(), which moves the fingers"
        )
