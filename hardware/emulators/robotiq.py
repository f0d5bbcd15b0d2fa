"""A Robotiq 2F-85 in software: what arrives on its line, what time it is, and what it sends in return.

Like EmulatedFingertips it has no input or output of its own: VirtualLine and PtyDevice do.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..drivers import (
    COMMAND,
    COUNT,
    CURRENT_STEP,
    FIRST_MAJOR,
    SLAVE,
    STATUS,
    TOP,
    Action,
    Activation,
    Contact,
    Fault,
    ObjectSeen,
    RobotiqUnits,
    State,
    action,
)
from ..lines import LineFaults
from . import modbus_slave
from .fingers import Fingers, SpringFingers
from .modbus_slave import LinePacing, SlaveLine

_REGISTERS = 8  # each way; those from COUNT on are reserved, and 0
_SILENCE = 1.0  # s without a request, after which it says so
_NEAR = 1e-7  # m
_SEEN = {
    Contact.NONE: ObjectSeen.MOVING,
    Contact.OPENING: ObjectSeen.WHILE_OPENING,
    Contact.CLOSING: ObjectSeen.WHILE_CLOSING,
}


@dataclass(frozen=True, slots=True)
class GripperModel:
    """The properties of an emulated gripper. units: its counts. slave: its address. pacing: of its line.
    activation_speed, release_speed: m/s of the motions that it makes by itself, estimates. tick: s, period of its
    controller; commands take effect at the next tick."""

    units: RobotiqUnits = RobotiqUnits()
    slave: int = SLAVE
    pacing: LinePacing = LinePacing()
    activation_speed: float = 0.1
    release_speed: float = 0.02
    tick: float = 0.002


class EmulatedGripper:
    """An emulated gripper that starts at time 0 with power, but not activated. fingers: what moves; free fingers by
    default. rng: of the line's faults.

    line: faults of its line on the way to the host. exception: a Modbus exception code with which every request is
    refused, as a real gripper does; 0 for none. lasting: a major fault that a reset does not clear while it is set. All
    may be changed at any time, as may stall_until, the time in s until which it neither receives nor sends anything.
    """

    def __init__(
        self,
        model: GripperModel | None = None,
        fingers: Fingers | None = None,
        *,
        rng: np.random.Generator | None = None,
    ) -> None:
        self.model = model or GripperModel()
        self.fingers: Fingers = fingers or SpringFingers(self.model.units.stroke)
        self.rng = rng or np.random.default_rng(0)
        self.line = LineFaults()
        self.exception = 0
        self.lasting = Fault.NONE
        self.stall_until = 0.0
        self._serial = SlaveLine(self.model.pacing)
        self._now = 0.0
        self._ticks = 0
        self._planned: list[tuple[float, Callable[[], None]]] = []
        self.power_cycle()

    def power_cycle(self) -> None:
        """Takes the power away for a moment: not activated, fingers as they are."""
        self._written = [0] * COUNT
        self._action = Action()
        self._activation = Activation.RESET
        self._object_seen = ObjectSeen.MOVING
        self._fault = Fault.NONE
        self._sequence: deque[float] = deque()
        self._received_at = self._now
        self._forgotten = False

    def plan(self, time: float, action: Callable[[], None]) -> None:
        """Has `action` done at that time, s."""
        self._planned.append((time, action))

    def fail(self, fault: Fault) -> None:
        """A fault that stays until a reset (from 0xA on), or until the next `fail`."""
        self._fault = fault

    @property
    def due(self) -> float:
        """s, when `advance` next has something to do for the line; motion needs no watching."""
        return max(min(self._serial.due, self._serial.frame_at), self.stall_until)

    def advance(self, now: float) -> None:
        """Does all that is due up to time `now`, s."""
        while (at := max(self._serial.frame_at, self.stall_until)) <= now:
            self._run(at)
            self._request(self._serial.frame())
        self._run(now)

    def receive(self, data: bytes) -> None:
        """Bytes from the host, now."""
        if self._now >= self.stall_until:
            self._serial.receive(data, self._now)

    def outgoing(self) -> list[bytes]:
        """What has reached the host by now."""
        data = self._serial.sent(self._now) if self._now >= self.stall_until else b""
        return [data] if data else []

    @property
    def state(self) -> State:
        """What its registers say."""
        units, going = self.model.units, self._activation == Activation.DONE and self._action.go
        span = units.closed_count - units.open_count
        position = units.closed_count - self.fingers.opening / units.stroke * span
        return State(
            activated=self._action.activate,
            going=going,
            activation=self._activation,
            seen=self._object_seen,
            fault=self._visible_fault(),
            requested=self._action.position,
            position=min(max(round(position), 0), TOP),
            current=min(round(self.fingers.current / CURRENT_STEP), TOP),
        )

    def _visible_fault(self) -> Fault:
        if self._fault:
            return self._fault
        if self._action.go and self._activation != Activation.DONE:
            return Fault.ACTION_DELAYED if self._action.activate else Fault.NOT_ACTIVATED
        return Fault.NO_COMMUNICATION if self._forgotten else Fault.NONE

    def _request(self, frame: bytes) -> None:
        if self.exception and len(frame) >= 4:
            reply: bytes | None = modbus_slave.exception(frame, self.exception)
        else:
            reply = modbus_slave.answer(frame, self.model.slave, self._read, self._write)
        if reply is None:
            return
        self._received_at, self._forgotten = self._now, False
        lost = self.line.drop_answer and self.rng.random() < self.line.drop_answer
        if not lost:
            self._serial.send(self.line.spoil(reply, self.rng), self._now + self.line.answer_delay)

    def _read(self, address: int, count: int) -> list[int] | None:
        first = address - STATUS
        if first < 0 or count < 1 or first + count > _REGISTERS:
            return None
        registers = self.state.registers() + [0] * (_REGISTERS - COUNT)
        return registers[first : first + count]

    def _write(self, address: int, values: list[int]) -> bool:
        first = address - COMMAND
        if first < 0 or first + len(values) > _REGISTERS:
            return False
        for place, value in enumerate(values, first):
            if place < COUNT:
                self._written[place] = value
        return True

    def _run(self, now: float) -> None:
        """The controller's ticks up to now."""
        while (self._ticks + 1) * self.model.tick <= now:
            self._ticks += 1
            self._tick(self._ticks * self.model.tick)
        self._now = max(self._now, now)

    def _tick(self, now: float) -> None:
        ready = [happen for time, happen in self._planned if time <= now]
        self._planned = [item for item in self._planned if item[0] > now]
        for happen in ready:
            happen()
        self._forgotten |= now - self._received_at > _SILENCE and self._action.activate
        self._obey(action(self._written))
        if self.lasting:
            self._fault = self.lasting
        units, command = self.model.units, self._action
        if self._fault == Fault.RELEASE_RUNNING:
            end = units.stroke if command.release_opens else 0.0
            if self._towards(end, units.weakest, self.model.release_speed):
                self._fault = Fault.RELEASED
        elif self._fault >= FIRST_MAJOR:
            self._towards(self.fingers.opening, units.weakest, units.slowest)
        elif self._activation == Activation.RUNNING:
            if self._towards(self._sequence[0], units.weakest, self.model.activation_speed):
                self._sequence.popleft()
            if not self._sequence:
                self._activation = Activation.DONE
        elif self._activation == Activation.DONE and command.go:
            goal = float(units.opening(command.position))
            done = self._towards(goal, float(units.force(command.force)), float(units.speed(command.speed)))
            self._object_seen = _SEEN[self.fingers.contact]
            if done and self._object_seen == ObjectSeen.MOVING:
                self._object_seen = ObjectSeen.AT_POSITION
        else:
            self._towards(self.fingers.opening, units.weakest, units.slowest)

    def _obey(self, command: Action) -> None:
        """A command takes effect."""
        before, self._action = self._action, command
        if not command.activate:
            self._activation, self._object_seen, self._fault = Activation.RESET, ObjectSeen.MOVING, Fault.NONE
        elif not before.activate:
            self._activation = Activation.RUNNING
            self._sequence = deque([0.0, self.model.units.stroke])
        if command.release and not before.release and command.activate and self._fault < FIRST_MAJOR:
            self._fault = Fault.RELEASE_RUNNING

    def _towards(self, goal: float, force: float, speed: float) -> bool:
        """One tick's motion; whether the fingers are there, or are kept from it."""
        self.fingers.move(goal, force, speed, self.model.tick)
        return self.fingers.contact != Contact.NONE or math.isclose(self.fingers.opening, goal, abs_tol=_NEAR)
