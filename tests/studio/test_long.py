"""An hour of the studio, faster than the clock: nothing is left behind. `make test-view-long` runs it."""

import asyncio
import ctypes
import gc
import json
import os
import sys
import threading
from dataclasses import dataclass
from pathlib import Path

import pytest

from thermograsp.studio.session.session import Session
from thermograsp.thermal import SEED_MATERIALS

if not os.environ.get("THERMOGRASP_LONG"):
    pytest.skip("takes minutes: make test-view-long", allow_module_level=True)
if not hasattr(ctypes.CDLL(None), "mallinfo2"):
    pytest.skip("asks the allocator of glibc 2.33 or later", allow_module_level=True)
pytest.importorskip("websockets", reason="the extra view is not installed")

from websockets.asyncio.client import connect

from thermograsp.studio.web.access import Access
from thermograsp.studio.web.server import Studio
from thermograsp.studio.web.worker import Worker

from .studio import heard, serving, socket_of

HOUR, TURN = 3600.0, 0.5  # s of the grasp
EPISODE = 20.0  # s until something else is grasped
CYCLE = 20  # episodes until the same ones come again
MEBIBYTE = 2**20
M_MMAP_THRESHOLD = -3  # of mallopt(3)
VISITS = 40


class Mallinfo(ctypes.Structure):
    """struct mallinfo2 of mallinfo(3)."""

    _fields_ = [
        (name, ctypes.c_size_t)
        for name in "arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost".split()
    ]


@dataclass(frozen=True, slots=True)
class Held:
    """By this process. used: MiB that were allocated and not freed. resident: MiB of memory. objects: of Python."""

    used: float
    resident: float
    objects: int
    threads: int
    files: int


def held(libc: ctypes.CDLL) -> Held:
    gc.collect()
    libc.mallinfo2.restype = Mallinfo
    info = libc.mallinfo2()
    libc.malloc_trim(0)
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return Held(
        (info.uordblks + info.hblkhd) / MEBIBYTE,
        pages * os.sysconf("SC_PAGE_SIZE") / MEBIBYTE,
        sys.getallocatedblocks(),
        threading.active_count(),
        len(os.listdir("/proc/self/fd")),
    )


@pytest.fixture(scope="module")
def libc() -> ctypes.CDLL:
    """The C library, told to give each block of 128 kB or more pages of its own. Else it takes them from its heap after
    a while, and a grasp's 14 MiB for MuJoCo's contacts, hardly touched, are resident or not by where they come to lie
    there: the hour ended 28 MiB above or 43 MiB below its sixth part so."""
    library = ctypes.CDLL(None)
    assert library.mallopt(M_MMAP_THRESHOLD, 128 * 1024) == 1
    return library


def test_an_hour_of_grasps(libc: ctypes.CDLL) -> None:
    """Compared at the same episode of a cycle, after two, in which every cache was filled."""
    session = Session()
    after: list[Held] = []
    for turn in range(round(HOUR / TURN)):
        number, place = divmod(turn, round(EPISODE / TURN))
        if place == 0:
            if number % CYCLE == 0:
                after.append(held(libc))
            names = [SEED_MATERIALS[(number + k) % len(SEED_MATERIALS)] for k in range(1 + number % 2)]
            session.handle({"do": "choose", "materials": names, "mode": "TO"[number // 2 % 2]})
        if place % 10 == 5:
            session.handle({"do": "csv"})
        session.advance(TURN)
        for feeling in session._feelings:
            feeling._making.result()  # so that every library of curves was made, however slow the machine is
        session.messages()
    after.append(held(libc))
    for number, one in enumerate(after):
        print(f"after {number * CYCLE * EPISODE / 60:.0f} minutes: {one}")
    warm, end = after[2], after[-1]
    assert (end.threads, end.files) == (warm.threads, warm.files)
    assert end.used - warm.used < 1 and end.resident - warm.resident < 5 and end.objects - warm.objects < 1000
    session.close()


def test_many_visits(libc: ctypes.CDLL) -> None:
    async def visit(url: str) -> None:
        async with connect(socket_of(url)) as socket:
            await socket.send(json.dumps({"do": "control", "speed": 4.0}))
            await heard(socket, lambda message: message.get("time", 0.0) > 0.2)

    async def act() -> None:
        async with serving(Worker) as url:
            for _ in range(8):
                await visit(url)
            early = held(libc)
            for _ in range(VISITS):
                await visit(url)
            late = held(libc)
            print(f"after eight visits: {early}\nafter {VISITS} more: {late}")
            assert (
                late.threads <= 1 + Studio(Access.to("127.0.0.1")).most + 2
            )  # the pool's, which begin as needed
            assert late.files == early.files
            assert late.used - early.used < 1 and late.resident - early.resident < 5

    asyncio.run(act())
