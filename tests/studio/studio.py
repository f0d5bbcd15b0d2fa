"""A studio on a free port for tests, and messages from it."""

import asyncio
import json
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from typing import Any

from thermograsp.errors import SimulationError
from thermograsp.studio.control.choices import Choices, Stock
from thermograsp.studio.web.access import Access
from thermograsp.studio.web.server import SOCKET, Studio, port_of

PATIENCE = 180.0  # s, on a machine that is busy with other things


class Echo:
    """Stands in for a worker: tells what it was told."""

    def __init__(self, stock: Stock, choices: Choices) -> None:
        self.heard: list[dict[str, Any]] = []
        self.stopped = False

    def exchange(self, messages: Sequence[dict[str, Any]]) -> list[str]:
        if self.stopped:
            raise SimulationError("the simulation has ended unexpectedly (exit code -9)")
        self.heard += messages
        return [json.dumps({"kind": "frame", "heard": self.heard})]

    def stop(self) -> None:
        self.stopped = True


@asynccontextmanager
async def serving(
    make: Callable[..., Any] = Echo, host: str = "127.0.0.1", **keywords: Any
) -> AsyncIterator[str]:
    """The studio's address."""
    studio = Studio(Access.to(host), make=make, **keywords)
    async with await studio.listen(0) as server:
        yield studio.access.url(port_of(server)).replace("0.0.0.0", "127.0.0.1")


def socket_of(url: str) -> str:
    return url.replace("http://", "ws://") + SOCKET


def token_of(url: str) -> str:
    return url.split("/")[3]


async def heard(socket: Any, wanted: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
    """The next message that is wanted."""
    async with asyncio.timeout(PATIENCE):
        while True:
            message = json.loads(await socket.recv())
            if wanted(message):
                return message


async def get(url: str, request: str, *headers: str) -> tuple[int, dict[str, str], bytes]:
    """Status, headers and body of a raw GET of that path."""
    place = url.split("/")[2]
    name, port = place.rsplit(":", 1)
    reader, writer = await asyncio.open_connection(name, int(port))
    lines = [f"GET {request} HTTP/1.1", *(headers or [f"Host: {place}"]), "Connection: close", "", ""]
    writer.write("\r\n".join(lines).encode())
    answer = await reader.read()
    writer.close()
    head, _, body = answer.partition(b"\r\n\r\n")
    status, *fields = head.decode().split("\r\n")
    return int(status.split()[1]), dict(field.lower().split(": ", 1) for field in fields), body
