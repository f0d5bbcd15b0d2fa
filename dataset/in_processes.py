"""Shards rolled out by processes of this machine, without Ray. They send back bytes; only the caller writes."""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Callable, Generator, Sequence
from multiprocessing.connection import Connection, wait

from threadpoolctl import threadpool_limits

from thermograsp.dataset.plan import Plan, Shard
from thermograsp.dataset.shards import shard_bytes
from thermograsp.errors import SimulationError

_ATTEMPTS = 3
"""Processes that may die over a shard before that is an error."""


def produce(
    plan: Plan, shards: Sequence[Shard], workers: int, advance: Callable[[], None]
) -> Generator[tuple[Shard, bytes]]:
    """(shard, file) in the order in which they are done, in `workers` processes. A shard whose process dies is begun
    again in another. advance: called after each episode. Raises what a shard raises, and SimulationError for one whose
    processes died again and again."""
    waiting = [(shard, 1) for shard in reversed(shards)]
    processes = [_Process(plan) for _ in range(min(workers, len(shards)))]
    try:
        for one in processes:
            one.begin(*waiting.pop())
        while busy := {one.pipe: one for one in processes if one.shard is not None}:
            for pipe in wait(list(busy)):
                assert isinstance(pipe, Connection)
                one = busy[pipe]
                shard, attempt = one.shard, one.attempt
                assert shard is not None
                try:
                    message = pipe.recv()
                except (EOFError, OSError):
                    one.end()
                    if attempt == _ATTEMPTS:
                        raise SimulationError(
                            f"the processes of seeds {shard.first} .. {shard.seeds[-1]} died repeatedly (exit code "
                            f"{one.process.exitcode}); finished files are kept, and the same command resumes"
                        ) from None
                    processes[processes.index(one)] = another = _Process(plan)
                    another.begin(shard, attempt + 1)
                    continue
                if message is None:
                    advance()
                    continue
                if isinstance(message, BaseException):
                    raise message
                one.shard = None
                if waiting:
                    one.begin(*waiting.pop())
                yield shard, message
    finally:
        for one in processes:
            one.end()


class _Process:
    """A process that takes one shard after another. shard: its present one. attempt: how often that was begun."""

    def __init__(self, plan: Plan) -> None:
        # spawn: a fork would copy the locks of our threads, and nothing that was changed here must count there
        context = multiprocessing.get_context("spawn")
        self.pipe, far_end = context.Pipe()
        self.process = context.Process(target=_roll, args=(far_end, plan), daemon=True)
        self.shard: Shard | None = None
        self.attempt = 0
        try:
            self.process.start()
        finally:
            far_end.close()

    def begin(self, shard: Shard, attempt: int) -> None:
        """Gives it a shard; where it has died, reading from it shows that."""
        self.shard, self.attempt = shard, attempt
        try:
            self.pipe.send(shard)
        except OSError:
            pass

    def end(self) -> None:
        """Ends it, whatever it is at: it holds nothing but the memory."""
        self.process.terminate()
        self.process.join()
        self.pipe.close()


def _roll(pipe: Connection, plan: Plan) -> None:
    """For each shard that comes sends None after each episode, and at its end the file or what was raised."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the caller, which then ends us
    try:
        with threadpool_limits(1):  # the other cores are the other processes'
            while True:
                shard = pipe.recv()
                try:
                    pipe.send(shard_bytes(plan, shard, lambda: pipe.send(None)))
                except Exception as error:  # noqa: BLE001 - whatever it is, it is raised where it was asked for
                    pipe.send(error)
    except (EOFError, OSError):
        pass  # the caller is gone
