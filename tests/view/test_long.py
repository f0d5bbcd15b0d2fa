"""An hour of the studio, faster than the clock: nothing is left behind. THERMOGRASP_LONG=1 runs it, in some minutes."""

import asyncio
import gc
import json
import os
import threading
from pathlib import Path

import pytest

from thermograsp.thermal import SEED_MATERIALS
from thermograsp.view.session import Session

if not os.environ.get("THERMOGRASP_LONG"):
    pytest.skip("takes minutes: THERMOGRASP_LONG=1", allow_module_level=True)
pytest.importorskip("websockets", reason="the extra view is not installed")

from websockets.asyncio.client import connect

from thermograsp.view.worker import Worker

from .studio import heard, serving, socket_of

HOUR, TURN = 3600.0, 0.5  # s of the grasp
EPISODE = 20.0  # s until something else is grasped
MEBIBYTE = 2**20
VISITS = 40


def resident() -> int:
    """Bytes of this process in memory."""
    gc.collect()
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def test_an_hour_of_grasps() -> None:
    session = Session()
    threads, early = 0, 0
    for turn in range(round(HOUR / TURN)):
        number, place = divmod(turn, round(EPISODE / TURN))
        if place == 0:
            names = [SEED_MATERIALS[(number + k) % len(SEED_MATERIALS)] for k in range(1 + number % 2)]
            session.handle({"do": "choose", "materials": names, "mode": "TO"[number // 2 % 2]})
        if place % 10 == 5:
            session.handle({"do": "csv"})
        session.advance(TURN)
        for feeling in session._feelings:
            feeling._making.result()  # so that all libraries of curves are in memory before it is measured
        session.messages()
        if turn * TURN == HOUR / 6:  # every material in both modes has been there
            threads, early = threading.active_count(), resident()
    assert threading.active_count() == threads
    grown = (resident() - early) / MEBIBYTE
    print(f"{early / MEBIBYTE:.0f} MiB after ten minutes, {grown:+.1f} MiB in fifty more")
    assert grown < 10
    session.close()


def test_many_visits() -> None:
    async def visit(url: str) -> None:
        async with connect(socket_of(url)) as socket:
            await socket.send(json.dumps({"do": "control", "speed": 4.0}))
            await heard(socket, lambda message: message.get("time", 0.0) > 0.2)

    def left() -> tuple[int, int, int]:
        return resident(), threading.active_count(), len(os.listdir("/proc/self/fd"))

    async def act() -> None:
        async with serving(Worker) as url:
            for _ in range(8):  # as many as the pool has threads, and more
                await visit(url)
            memory, threads, files = left()
            for _ in range(VISITS):
                await visit(url)
            grown = (left()[0] - memory) / MEBIBYTE
            print(f"{memory / MEBIBYTE:.0f} MiB after eight visits, {grown:+.1f} MiB in {VISITS} more")
            assert left()[1:] == (threads, files) and grown < 5

    asyncio.run(act())
