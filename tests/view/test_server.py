"""The studio's server: what it hands out, to whom, what it refuses, and what it says when something ends."""

import asyncio
import json
import os
import signal
from collections.abc import Coroutine
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("websockets", reason="the extra view is not installed")

from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.typing import Origin

from thermograsp.view.access import BURST, LARGEST
from thermograsp.view.choices import Choices, Stock
from thermograsp.view.files import HEADERS, page_files
from thermograsp.view.worker import Worker

from .studio import PATIENCE, Echo, get, heard, serving, socket_of

PAGE = Path(__file__).parents[2] / "core" / "view" / "page"


def within(act: Coroutine[Any, Any, None]) -> None:
    asyncio.run(asyncio.wait_for(act, PATIENCE))


def test_it_hands_out_the_page() -> None:
    async def act() -> None:
        async with serving() as url:
            for name in ("", *(path.name for path in PAGE.iterdir())):
                status, headers, body = await get(url, f"/{name}")
                assert status == 200
                assert body == (PAGE / (name or "index.html")).read_bytes()
                for header, value in HEADERS.items():
                    assert headers[header.lower()] == value.lower()

    within(act())


def test_the_page_loads_its_own_files_only() -> None:
    files = page_files()
    for _, content in files.values():
        text = content.decode()
        assert "http://" not in text.replace("http://www.w3.org/2000/svg", "") and "https://" not in text
        assert "eval(" not in text and "innerHTML" not in text
    named = {word for word in files[""][1].decode().split('"') if word.endswith((".js", ".css", ".svg"))}
    assert named <= set(files)


@pytest.mark.parametrize(
    "request_",
    [
        "/../../setup.cfg",
        "/..%2f..%2fsetup.cfg",
        "/%2e%2e/server.py",
        "/page/main.js",
        "//etc/passwd",
        "/etc/passwd",
        "/index.html/..",
        "/C:\\Windows\\win.ini",
        "/.",
        "/main.js%00.css",
    ],
)
def test_no_other_file_can_be_asked_for(request_: str) -> None:
    async def act() -> None:
        async with serving() as url:
            status, _, body = await get(url, request_)
            assert status == 404 and body == b"There is no such page.\n"

    within(act())


def test_with_a_token_nothing_is_to_be_had_without_it() -> None:
    async def act() -> None:
        async with serving(host="0.0.0.0") as url:
            token = url.split("/")[3]
            assert len(token) >= 32
            assert (await get(url, f"/{token}/"))[0] == (await get(url, f"/{token}/main.js"))[0] == 200
            for path in ("/", "/main.js", f"/{token[:-1]}/", f"/{token}x/main.js"):
                assert (await get(url, path))[0] == 403
            async with connect(socket_of(url)) as socket:
                await heard(socket, lambda message: message["kind"] == "frame")
            with pytest.raises(InvalidStatus):
                await connect(socket_of(url).replace(token, "guess"))

    within(act())


def test_scripts_of_other_pages_get_nothing() -> None:
    async def act() -> None:
        async with serving() as url:
            own = url.rstrip("/")
            async with connect(socket_of(url), origin=Origin(own)) as socket:
                await heard(socket, lambda message: message["kind"] == "frame")
            for origin in ("http://example.org", "null", own.replace("http", "https")):
                with pytest.raises(InvalidStatus):
                    await connect(socket_of(url), origin=Origin(origin))
            assert (await get(url, "/", "Host: evil.example.org"))[0] == 403
            assert (await get(url, "/", "Host: 127.0.0.1", "Host: evil.example.org"))[0] == 403
            assert (await get(url, "/", "Accept: text/html"))[0] == 403

    within(act())


@pytest.mark.parametrize(
    ("text", "code"), [("x" * (LARGEST + 1), 1009), ("not JSON", 1008), ("[1]", 1008), (b"\xff", 1008)]
)
def test_what_is_too_large_or_no_message_ends_the_visit(text: str | bytes, code: int) -> None:
    async def act() -> None:
        async with serving() as url, connect(socket_of(url)) as socket:
            await socket.send(text)
            with pytest.raises(ConnectionClosed) as closed:
                await heard(socket, lambda message: False)
            assert closed.value.rcvd is not None and closed.value.rcvd.code == code

    within(act())


def test_too_many_messages_end_the_visit_and_no_other() -> None:
    async def act() -> None:
        async with serving() as url, connect(socket_of(url)) as calm, connect(socket_of(url)) as wild:
            with pytest.raises(ConnectionClosed) as closed:
                for _ in range(round(2 * BURST)):
                    await wild.send('{"do":"again"}')
                await heard(wild, lambda message: False)
            assert closed.value.rcvd is not None and closed.value.rcvd.code == 1008
            assert "too many messages" in closed.value.rcvd.reason
            await calm.send('{"do":"step","id":1}')
            await heard(calm, lambda message: message["heard"] == [{"do": "step", "id": 1}])

    within(act())


def test_visitors_beyond_the_number_are_told_so() -> None:
    async def act() -> None:
        async with serving(most=1) as url, connect(socket_of(url)) as first:
            async with connect(socket_of(url)) as second:
                told = await heard(second, lambda message: message["kind"] == "ended")
                assert "1 visitors" in told["text"]
            await heard(first, lambda message: message["kind"] == "frame")
            await first.close()
            async with asyncio.timeout(PATIENCE):
                while True:  # the place is free as soon as the first one's simulation has ended
                    async with connect(socket_of(url)) as third:
                        if json.loads(await third.recv())["kind"] == "frame":
                            break

    within(act())


def test_a_studio_that_stops_says_so() -> None:
    made: list[Echo] = []

    def make(stock: Stock, choices: Choices) -> Echo:
        made.append(Echo(stock, choices))
        return made[-1]

    async def act() -> None:
        async with serving(make) as url:
            socket = await connect(socket_of(url))
            await heard(socket, lambda message: message["kind"] == "frame")
        with pytest.raises(ConnectionClosed) as closed:
            await heard(socket, lambda message: False)
        assert closed.value.rcvd is not None and closed.value.rcvd.code == 1001

    within(act())
    assert made[0].stopped


def test_two_visitors_have_a_simulation_each_and_one_that_is_killed_says_so() -> None:
    made: list[Worker] = []

    def make(stock: Stock, choices: Choices) -> Worker:
        made.append(Worker(stock, choices))
        return made[-1]

    async def act() -> None:
        async with serving(make) as url, connect(socket_of(url)) as first:
            await heard(first, lambda message: message["kind"] == "frame")  # so that its worker is made[0]
            second = await connect(socket_of(url))
            for socket, name in ((first, "aluminium"), (second, "cotton")):
                await socket.send(json.dumps({"do": "choose", "materials": [name]}))
                await heard(socket, lambda message, name=name: message.get("rows") == [name])
            await second.send(json.dumps({"do": "control", "playing": False}))
            await heard(
                second, lambda message: message["kind"] == "frame" and not message["controls"]["playing"]
            )
            running = await heard(first, lambda message: message.get("time", 0.0) > 0.3)
            assert running["controls"]["playing"]
            assert made[0].pid is not None and made[0].pid != made[1].pid
            os.kill(made[0].pid, signal.SIGKILL)
            told = await heard(first, lambda message: message["kind"] == "ended")
            assert told["text"] == "the simulation has ended unexpectedly (exit code -9)"
            with pytest.raises(ConnectionClosed) as closed:
                await first.recv()
            assert closed.value.rcvd is not None and closed.value.rcvd.code == 1011
            await heard(second, lambda message: message["kind"] == "frame")
            await second.close()

    within(act())


def test_a_worker_whose_server_is_gone_ends() -> None:
    worker = Worker(Stock(), Choices())
    assert json.loads(worker.exchange([])[0])["kind"] == "hello"
    worker._pipe.close()
    worker._process.join(PATIENCE)
    assert worker._process.exitcode == 0
