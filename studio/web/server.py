"""The studio's server: the page's files over HTTP, a session a visitor over WebSocket, on one port."""

from __future__ import annotations

import asyncio
import contextlib
import json
import logging
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from http import HTTPStatus
from typing import Any

from thermograsp.errors import InvalidValueError, MissingDependencyError, SimulationError, install
from thermograsp.studio.control import Choices, Stock
from thermograsp.studio.web.access import (
    LARGEST,
    Access,
    Allowance,
    parsed,
)
from thermograsp.studio.web.files import HEADERS, page_files
from thermograsp.studio.web.worker import Worker, warm_up

try:
    from websockets.asyncio.server import Server, ServerConnection, serve
    from websockets.datastructures import Headers
    from websockets.exceptions import ConnectionClosed
    from websockets.http11 import Request, Response
except ImportError as error:
    raise MissingDependencyError(f"the studio needs websockets: {install('view')}") from error

FRAMES = 30.0  # a second
SOCKET = "socket"  # its path
_PENDING = 64  # messages of a visitor that wait for the simulation
_OPENING, _ENDING = 5.0, 1.0  # s for a connection's handshake, and for its last message
_POLICY, _BUSY, _BROKEN = 1008, 1013, 1011  # close codes of RFC 6455 and its registry


@dataclass(slots=True)
class Studio:
    """The studio's server and its visitors. access: who may come. stock, choices: what a visitor finds. most: visitors
    at once. make: a visitor's worker."""

    access: Access
    stock: Stock = field(default_factory=Stock)
    choices: Choices = field(default_factory=Choices)
    most: int = 4
    make: Callable[[Stock, Choices], Worker] = Worker
    _visitors: set[ServerConnection] = field(default_factory=set)
    _files: dict[str, tuple[str, bytes]] = field(default_factory=page_files)

    async def run(self, port: int, started: Callable[[str], None]) -> None:
        """Serves until cancelled. started: told the address that visitors open. Raises OSError where the port is
        taken."""
        await asyncio.to_thread(warm_up)
        async with await self.listen(port) as server:
            started(self.access.url(port_of(server)))
            await server.serve_forever()

    async def listen(self, port: int) -> Server:
        """A server on that port, 0 for any that is free."""
        # a thread for each visitor's simulation, and for one that comes or goes
        asyncio.get_running_loop().set_default_executor(ThreadPoolExecutor(self.most + 2, "studio"))
        quiet = logging.getLogger("thermograsp.view")
        quiet.setLevel(logging.CRITICAL)  # who leaves in the middle of a handshake is no news
        return await serve(
            self._visit,
            self.access.host,
            port,
            process_request=self._answer,
            max_size=LARGEST,
            max_queue=_PENDING,
            open_timeout=_OPENING,
            close_timeout=_ENDING,
            compression=None,
            server_header=None,
            logger=quiet,
        )

    def _answer(self, connection: ServerConnection, request: Request) -> Response | None:
        """A file of the page, or None to go on with a WebSocket."""
        hosts, origins, forwarded = (
            request.headers.get_all(name) for name in ("Host", "Origin", "X-Forwarded-Host")
        )
        first_of_each = [(one or [None])[0] for one in (hosts, origins, forwarded)]
        if max(map(len, (hosts, origins, forwarded))) > 1 or not self.access.trusts(*first_of_each):
            return connection.respond(
                HTTPStatus.FORBIDDEN, "This address or page may not talk to the studio.\n"
            )
        resource = self.access.resource(request.path)
        if resource is None:
            return connection.respond(
                HTTPStatus.FORBIDDEN, "The address lacks its token: open the one printed.\n"
            )
        if resource == SOCKET:
            return None
        if resource not in self._files:
            return connection.respond(HTTPStatus.NOT_FOUND, "There is no such page.\n")
        kind, content = self._files[resource]
        headers = Headers(
            {**HEADERS, "Content-Type": kind, "Content-Length": str(len(content)), "Connection": "close"}
        )
        return Response(HTTPStatus.OK, "OK", headers, content)

    async def _visit(self, socket: ServerConnection) -> None:
        if len(self._visitors) >= self.most:
            await _end(
                socket,
                _BUSY,
                f"{self.most} visitors are here already: close a tab, or allow more (--visitors)",
            )
            return
        self._visitors.add(socket)
        try:
            worker = await asyncio.to_thread(self.make, self.stock, self.choices)
            try:
                await _attend(socket, worker)
            finally:
                await asyncio.to_thread(worker.stop)
        except ConnectionClosed:
            pass
        except InvalidValueError as error:
            await _end(socket, _POLICY, str(error))
        except SimulationError as error:
            await _end(socket, _BROKEN, str(error))
        except OSError as error:
            await _end(socket, _BROKEN, f"the simulation could not be started ({error})")
        finally:
            self._visitors.discard(socket)


def port_of(server: Server) -> int:
    """The port that a server listens on."""
    return next(iter(server.sockets)).getsockname()[1]


async def _attend(socket: ServerConnection, worker: Worker) -> None:
    """Hands messages to and fro until the visitor leaves. Raises what ends the visit before."""
    inbox: list[dict[str, Any]] = []
    came = asyncio.Event()
    tasks = [
        asyncio.create_task(_read(socket, inbox, came)),
        asyncio.create_task(_play(socket, worker, inbox, came)),
    ]
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        for task in done:
            task.result()
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def _read(socket: ServerConnection, inbox: list[dict[str, Any]], came: asyncio.Event) -> None:
    """Puts a client's messages into the inbox until it leaves, and sets `came`. Raises InvalidValueError for one too
    many, or a bad one."""
    allowance = Allowance(asyncio.get_running_loop().time)
    async for text in socket:
        if not allowance.take() or len(inbox) >= _PENDING:
            raise InvalidValueError("too many messages")
        inbox.append(parsed(text))
        came.set()


async def _play(
    socket: ServerConnection, worker: Worker, inbox: list[dict[str, Any]], came: asyncio.Event
) -> None:
    """Sends frames, as many as the client takes: FRAMES a second at most, and one when a message came."""
    loop, period = asyncio.get_running_loop(), 1 / FRAMES
    due = loop.time()
    while True:
        came.clear()
        messages, inbox[:] = list(inbox), []
        for text in await asyncio.to_thread(worker.exchange, messages):
            await socket.send(text)
        now = loop.time()
        due = min(max(due + period, now - period), now + period)
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout_at(due):
                await came.wait()


async def _end(socket: ServerConnection, code: int, why: str) -> None:
    """Tells the page why it ends, where it still reads, and closes."""
    with contextlib.suppress(ConnectionClosed, TimeoutError):
        async with asyncio.timeout(_ENDING):
            await socket.send(json.dumps({"kind": "ended", "text": why}))
    await socket.close(code, why[:120])
