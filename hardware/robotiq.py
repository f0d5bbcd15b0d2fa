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

from .errors import GripperFaultError, GripperTimeoutError
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
from .serial_port import SerialPort
from .transport import Opener

_ACTIVATION_WITHIN = 10.0  # s; the manual's sequence takes about 3
_TRAVEL_WITHIN = 6.0  # s; the stroke takes 4.25 s at the slowest speed
_RESET_WITHIN = 0.5  # s
_CONTACTS = {ObjectSeen.WHILE_OPENING: Contact.OPENING, ObjectSeen.WHILE_CLOSING: Contact.CLOSING}


class RobotiqGripper:
    """Open from its making until `close` or the end of its `with` block. See Gripper for what its methods have in
    common.

    port: a path, best a stable one (/dev/serial/by-id/...), or a function that opens a transport. units: of this
    gripper. clock, sleep: s, of the host, or of a virtual line (line.clock, line.advance).

    A port that was lost is opened again by the next call; a gripper that was without power meanwhile says so and needs
    `activate`: no other method makes the fingers travel on their own. Raises PortError, NoAnswerError where it cannot
    be reached.
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
        self._lock = threading.RLock()
        name = f"gripper on {port}" if isinstance(port, str) else "gripper"
        self._line = ModbusLine(opener, slave, settings or ModbusSettings(), clock, sleep, name)
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
        with self._lock:
            self._line.close()

    def activate(self) -> None:
        """Resets it and has it find its travel, where it is not ready already: the fingers close and open wholly, and
        what they hold falls. Waits up to 10 s. Raises GripperFaultError, GripperTimeoutError."""
        now = self.state()
        if now.activation != Activation.DONE or now.fault >= FIRST_MAJOR:
            self.clear_faults()

    def clear_faults(self) -> None:
        """Resets it, faults included, and activates it anew; see activate."""
        self._tell(COMMAND, Action().registers())
        self._await(
            lambda now: now.activation == Activation.RESET and not now.fault, _RESET_WITHIN, "its reset"
        )
        self._tell(COMMAND, Action(activate=True).registers())
        self._await(lambda now: now.activation == Activation.DONE, _ACTIVATION_WITHIN, "its activation", True)

    def move(self, opening: float, force: float, speed: float) -> GripperStatus:
        """Sends the fingers to an opening, 0 .. stroke m, and returns at once. force: N; below the weakest, 20 N, it is
        that. speed: m/s likewise. Raises GripperFaultError for a gripper that does not move, InvalidValueError."""
        counts = (
            self.units.position_counts(opening),
            self.units.speed_counts(speed),
            self.units.force_counts(force),
        )
        position, rate, limit = (int(count) for count in counts)
        values = Action(activate=True, go=True, position=position, speed=rate, force=limit).registers()
        with self._lock:
            # While it follows positions the action register is left alone: after a loss of power, to write it would
            # begin an activation.
            now = self._tell(COMMAND + 1, values[1:]) if self._going else self.state()
            _require_active(now)
            if not (self._going and now.going):
                now = self._tell(COMMAND, values)
                _require_active(now)
            self._going, self._wanted = True, position
            return self._status(now)

    def stop(self) -> GripperStatus:
        """The fingers stay where they are and hold what they hold."""
        with self._lock:
            now = self.state()
            if now.activated:
                now = self._tell(COMMAND, Action(activate=True).registers()[:1])
            return self._status(now)

    def status(self) -> GripperStatus:
        """How it is; a fault is told, not raised."""
        return self._status(self.state())

    def wait(self, seconds: float = _TRAVEL_WITHIN) -> GripperStatus:
        """Waits until the fingers have arrived or are stopped by something. Raises GripperFaultError,
        GripperTimeoutError."""
        return self._status(
            self._await(lambda now: not self._moving(now), seconds, "the end of its motion", True)
        )

    def measure_counts(self) -> RobotiqUnits:
        """Closes and opens it wholly, with nothing between the fingers, and takes where they end for its counts. The
        new units are also kept as `units`. Raises what move and wait raise."""
        slow, weak = self.units.slowest, self.units.weakest
        ends = []
        for opening in (0.0, self.units.stroke):
            self.move(opening, weak, 2 * slow)
            self.wait()
            ends.append(self.state().position)
        self.units = replace(self.units, closed_count=ends[0], open_count=ends[1])
        return self.units

    def quantised(self, opening: Any, force: Any, speed: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(opening m, force N, speed m/s) that it makes of a command, elementwise."""
        return self.units.quantised(opening, force, speed)

    def state(self) -> State:
        """Its registers as they are."""
        with self._lock:
            return state(self._line.read(STATUS, COUNT))

    def _tell(self, address: int, values: list[int]) -> State:
        """Writes registers and reads the state in the same transaction. It is how the gripper was just before."""
        with self._lock:
            going, self._going, self._wanted = self._going, False, None  # unknown, where it raises
            now = state(self._line.exchange(address, values, STATUS, COUNT))
            self._going = going and address != COMMAND
            return now

    def _await(
        self, ready: Callable[[State], bool], seconds: float, what: str, healthy: bool = False
    ) -> State:
        """The first state that is ready. healthy: a major fault ends it."""
        deadline = self._clock() + seconds
        while True:
            now = self.state()
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
            "gripper: not active, as after it was without power; call activate(), which moves the fingers"
        )
