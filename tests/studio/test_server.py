"""The studio's server: what it hands out, to whom, what it refuses, and what it says when something ends."""

import asyncio
import json
import multiprocessing
import os
import signal
import time
from collections.abc import Callable, Coroutine
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("websockets", reason="the extra view is not installed")

from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.typing import Origin

from thermograsp.envs.sensing import ahead
from thermograsp.errors import InvalidValueError, SimulationError
from thermograsp.studio.control.choices import Choices, Stock
from thermograsp.studio.web.access import BURST, LARGEST
from thermograsp.studio.web.files import HEADERS, page_files
from thermograsp.studio.web.worker import _LEAVING, Worker, warm_up

from .studio import PATIENCE, Echo, get, heard, serving, socket_of, token_of

PAGE = Path(__file__).parents[2] / "studio" / "web" / "page"


def within(act: Coroutine[Any, Any, None]) -> None:
    asyncio.run(asyncio.wait_for(act, PATIENCE))


def test_it_hands_out_the_page() -> None:
    async def act() -> None:
        async with serving() as url:
            for name in ("", *(path.name for path in PAGE.iterdir())):
                status, headers, body = await get(url, f"/{token_of(url)}/{name}")
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
            status, _, body = await get(url, f"/{token_of(url)}{request_}")
            assert status == 404 and body == b"There is no such page.\n"

    within(act())


@pytest.mark.parametrize("host", ["127.0.0.1", "0.0.0.0"])
def test_nothing_is_to_be_had_without_the_token(host: str) -> None:
    async def act() -> None:
        async with serving(host=host) as url:
            token = token_of(url)
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
            host, first = "/".join(url.split("/")[:3]), f"/{token_of(url)}/"
            for origin in (host, host.replace("http", "https")):  # a proxy may add encryption
                async with connect(socket_of(url), origin=Origin(origin)) as socket:
                    await heard(socket, lambda message: message["kind"] == "frame")
            for origin in ("http://example.org", "null", host + "0"):
                with pytest.raises(InvalidStatus):
                    await connect(socket_of(url), origin=Origin(origin))
            assert (await get(url, "/", "Host: evil.example.org"))[0] == 403
            assert (await get(url, first, "Host: 127.0.0.1", "Host: evil.example.org"))[0] == 403
            assert (await get(url, first, "Accept: text/html"))[0] == 403


def test_a_proxy_that_adds_encryption_says_for_whom_it_asks() -> None:
    async def act() -> None:
        async with serving() as url:
            for name, answer in (("lab.example.org", 200), ("evil.example.org", 403)):
                said = (
                    "Host: 127.0.0.1:8421",
                    "Origin: https://lab.example.org",
                    f"X-Forwarded-Host: {name}",
                )
                assert (await get(url, f"/{token_of(url)}/", *said))[0] == answer

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
                message = await heard(second, lambda message: message["kind"] == "ended")
                assert "1 visitors" in message["text"]
            await heard(first, lambda message: message["kind"] == "frame")
            await first.close()
            async with asyncio.timeout(PATIENCE):
                while True:  # the place is free as soon as the first one's simulation has ended
                    async with connect(socket_of(url)) as third:
                        if json.loads(await third.recv())["kind"] == "frame":
                            break

    within(act())


@pytest.mark.parametrize(
    ("error", "code", "reason"),
    [
        (OSError("no more processes"), 1011, "could not be started (no more processes)"),
        (SimulationError("it broke"), 1011, "it broke"),
        (InvalidValueError("a bad choice"), 1008, "a bad choice"),
        (RuntimeError("nobody thought of this"), 1011, ""),
    ],
)
def test_a_start_that_fails_leaves_its_place(error: Exception, code: int, reason: str) -> None:
    broken = [error, error, None]

    def make(stock: Stock, choices: Choices) -> Echo:
        this = broken.pop(0)
        if this is not None:
            raise this
        return Echo(stock, choices)

    async def act() -> None:
        async with serving(make, most=1) as url:
            for _ in range(2):
                async with connect(socket_of(url)) as socket:
                    with pytest.raises(ConnectionClosed) as closed:
                        await heard(socket, lambda message: False)
                    assert closed.value.rcvd is not None and closed.value.rcvd.code == code
                    assert reason in closed.value.rcvd.reason
            async with connect(socket_of(url)) as socket:
                assert json.loads(await socket.recv())["kind"] == "frame"

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


@pytest.mark.slow
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
            message = await heard(first, lambda message: message["kind"] == "ended")
            assert message["text"] == "the simulation has ended unexpectedly (exit code -9)"
            with pytest.raises(ConnectionClosed) as closed:
                await first.recv()
            assert closed.value.rcvd is not None and closed.value.rcvd.code == 1011
            await heard(second, lambda message: message["kind"] == "frame")
            await second.close()

    within(act())


class Forked:
    """Forks this process, with what is replaced in it; as from the fork server, the new one holds no other's ends."""

    def __init__(self) -> None:
        self._context = multiprocessing.get_context("fork")
        self._ends: list[Connection] = []

    def Pipe(self, duplex: bool = True) -> tuple[Connection, Connection]:
        ends = self._context.Pipe(duplex)
        self._ends += ends
        return ends

    def Process(self, *, target: Callable[..., None], args: tuple[Any, ...], daemon: bool) -> Any:
        def run() -> None:
            for end in self._ends:
                if end not in args:
                    end.close()
            target(*args)

        return self._context.Process(target=run, daemon=daemon)


class Noting:
    """Stands in for a session, and notes when it is closed."""

    paced = preparing = False

    def __init__(self, file: Path) -> None:
        self._file = file

    def handle(self, message: Any) -> None:
        self._file.write_text("busy")
        time.sleep(message["seconds"])

    def advance(self, seconds: float) -> None:
        pass

    def messages(self) -> list[Any]:
        return []

    def close(self) -> None:
        signal.raise_signal(signal.SIGTERM)  # as from a server that has waited long enough
        self._file.write_text("closed")


@pytest.mark.parametrize("seconds", [0.0, 1.5 * _LEAVING])
def test_a_session_is_closed_before_its_process_ends(
    seconds: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its gripper's ports are released so, also where it is busy for longer than it is waited for, and where a signal
    comes while it closes."""
    from thermograsp.studio import session

    file = tmp_path / "closed"
    monkeypatch.setattr(session, "Session", lambda stock, choices: Noting(file), raising=False)
    monkeypatch.setattr("thermograsp.studio.web.worker._context", Forked)
    worker = Worker(Stock(), Choices())
    assert worker.exchange([]) == []
    worker._pipe.send([{"seconds": seconds}])
    until = time.monotonic() + PATIENCE
    while not file.exists() and time.monotonic() < until:
        time.sleep(0.01)
    worker.stop()
    assert worker._process.exitcode in (0, 128 + signal.SIGTERM)
    assert file.read_text() == "closed"


class Prepared:
    """Stands in for a session that takes a while to set up, and tells by how many seconds too much it was advanced."""

    paced = False
    preparing, late = True, 0.0

    def advance(self, seconds: float) -> None:
        if self.preparing:
            time.sleep(0.3)
            self.preparing, self._ready = False, time.monotonic()
        else:
            self.late = seconds - (time.monotonic() - self._ready)

    def messages(self) -> list[float]:
        return [self.late]

    def close(self) -> None:
        pass


def test_time_begins_when_a_grasp_is_set_up(monkeypatch: pytest.MonkeyPatch) -> None:
    from thermograsp.studio import session

    monkeypatch.setattr(session, "Session", lambda stock, choices: Prepared(), raising=False)
    monkeypatch.setattr("thermograsp.studio.web.worker._context", Forked)
    worker = Worker(Stock(), Choices())
    worker.exchange([])
    (late,) = worker.exchange([])
    assert float(late) <= 0.0
    worker.stop()


def test_code_is_compiled_from_the_start(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[str] = []
    monkeypatch.setattr(ahead, "compile_beside", lambda module, *needed, **by: started.append(module))
    monkeypatch.setattr("thermograsp.studio.web.worker._context", lambda: multiprocessing.get_context("fork"))
    warm_up()
    assert started == [ahead.__name__]


def test_a_worker_whose_server_is_gone_ends() -> None:
    worker = Worker(Stock(), Choices())
    assert json.loads(worker.exchange([])[0])["kind"] == "hello"
    worker._pipe.close()
    worker._process.join(PATIENCE)
    assert worker._process.exitcode == 0
