"""A Modbus RTU master on any transport: pymodbus for frames and transactions, our line under it."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from thermograsp.errors import MissingDependencyError, install

from ..errors import (
    CommandRefusedError,
    DeviceError,
    LinkLostError,
    NoAnswerError,
)
from ..lines import Opener, Transport, Turns

_LOG = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class ModbusSettings:
    """Time limits of a Modbus line. answer_within: s to wait for an answer, above the adapter's latency (16 ms for an
    FTDI) and the line's time. tries: of a request. spacing: s between the beginnings of two requests (Robotiq's manual:
    5 ms at least). rest: s between an answer and the next request, above the 1.75 ms of silence that end a frame."""

    answer_within: float = 0.06
    tries: int = 5
    spacing: float = 0.005
    rest: float = 0.002


class ModbusLine:
    """Registers of one slave. The transport is opened at the first request, and again after it was lost, for the next
    one.

    Threads take turns, of one try of a request each. first: this request is tried before those of all who wait.
    permitted: called before each try, once it is its turn; what it raises ends the request.

    Requests raise PortError, LinkLostError, NoAnswerError or CommandRefusedError (an exception response).
    """

    def __init__(
        self,
        opener: Opener,
        slave: int,
        settings: ModbusSettings,
        clock: Callable[[], float],
        sleep: Callable[[float], None],
        name: str,
    ) -> None:
        self._opener = opener
        self._slave = slave
        self._name = name
        self._tries = settings.tries
        self._turns = Turns()
        self._closed = False
        self._pipe = _Pipe(settings, clock, sleep)
        self._client = _client(self._pipe)

    def exchange(
        self,
        write_address: int,
        values: Sequence[int],
        read_address: int,
        count: int,
        *,
        first: bool = False,
        permitted: Callable[[], None] = lambda: None,
    ) -> list[int]:
        """Writes registers, then reads others, in one transaction (function code 23)."""
        call = partial(
            self._client.readwrite_registers,
            write_address=write_address,
            values=list(values),
            read_address=read_address,
            read_count=count,
        )
        return self._request(call, count, first, permitted)

    def read(self, address: int, count: int, *, first: bool = False) -> list[int]:
        """Reads registers (function code 4)."""
        call = partial(self._client.read_input_registers, address=address, count=count)
        return self._request(call, count, first, lambda: None)

    def close(self) -> None:
        """Releases the transport for good."""
        with self._turns.take(first=True):
            self._closed = True
            self._pipe.close()

    def _request(
        self, call: Callable[..., Any], count: int, first: bool, permitted: Callable[[], None]
    ) -> list[int]:
        tries_left = self._tries
        while True:
            with self._turns.take(first):
                permitted()
                try:
                    return self._try(call, count)
                except NoAnswerError as error:
                    tries_left -= 1
                    if tries_left <= 0:
                        raise
                    _LOG.info("a request is sent again: %s", error)

    def _try(self, call: Callable[..., Any], count: int) -> list[int]:
        from pymodbus.exceptions import ModbusException

        if self._closed:
            raise LinkLostError(f"{self._name}: it was closed; open another one")
        if self._pipe.transport is None:
            self._pipe.transport = self._opener()
            _LOG.info("%s: opened", self._name)
        try:
            answer = call(device_id=self._slave)
        except ModbusException as error:
            raise NoAnswerError(
                f"{self._name}: {self._pipe.summary()}; is it powered, at {self._slave} as its address, and its "
                "line's baud rate right?"
            ) from error
        except LinkLostError:
            self._pipe.close()
            raise
        if answer.isError():
            raise CommandRefusedError(
                f"{self._name}: refused with Modbus exception {answer.exception_code}; another kind of device?"
            )
        if len(answer.registers) != count:
            raise DeviceError(
                f"{self._name}: answered with {len(answer.registers)} registers; another device?"
            )
        return answer.registers


class _Pipe:
    """What pymodbus sends and receives by."""

    def __init__(
        self, settings: ModbusSettings, clock: Callable[[], float], sleep: Callable[[float], None]
    ) -> None:
        self.transport: Transport | None = None
        self._settings = settings
        self._clock = clock
        self._sleep = sleep
        self._quiet_until = -math.inf
        self._answer_by = 0.0
        self._received = 0

    def send(self, request: bytes) -> int:
        """After the line's rest, in which what comes late is thrown away: it answers an earlier request."""
        transport = self._line()
        if (rest := self._quiet_until - self._clock()) > 0:
            self._sleep(rest)
        while transport.read(0.0):
            pass
        transport.write(request)
        self._received = 0
        self._answer_by = self._clock() + self._settings.answer_within
        self._quiet_until = self._clock() + self._settings.spacing
        return len(request)

    def receive(self) -> bytes:
        """What comes next, b"" where nothing comes in time."""
        transport = self._line()
        while (left := self._answer_by - self._clock()) > 0:
            if data := transport.read(left):
                self._received += len(data)
                self._quiet_until = max(self._quiet_until, self._clock() + self._settings.rest)
                return data
        return b""

    def summary(self) -> str:
        """What arrived in the last try, for people."""
        tries = f"in {self._settings.tries} tries of {self._settings.answer_within:g} s"
        return (
            f"{self._received} bytes and no answer among them {tries}"
            if self._received
            else f"no answer {tries}"
        )

    def close(self) -> None:
        if self.transport is not None:
            self.transport.close()
            self.transport = None

    def _line(self) -> Transport:
        assert self.transport is not None
        return self.transport


def _client(pipe: _Pipe) -> Any:
    """pymodbus's synchronous client on the pipe, which tries once."""
    try:
        from pymodbus import FramerType
        from pymodbus.client.base import ModbusBaseSyncClient
        from pymodbus.transport import CommParams, CommType
    except ImportError:
        raise MissingDependencyError(
            f"a Modbus gripper needs pymodbus, which is not installed: {install('hardware')}"
        ) from None

    logging.getLogger("pymodbus").addHandler(logging.NullHandler())  # our errors tell what its log would

    class Client(ModbusBaseSyncClient):
        def connect(self) -> bool:
            return True

        def send(self, request: bytes, addr: tuple | None = None) -> int:
            del addr
            return pipe.send(request)

        def recv(self, size: int | None) -> bytes:
            del size
            return pipe.receive()

    # The pipe keeps the time, by its own clock.
    params = CommParams(comm_type=CommType.SERIAL, timeout_connect=math.inf)
    return Client(FramerType.RTU, 0, params, None, None, None)
