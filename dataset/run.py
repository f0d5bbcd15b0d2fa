"""Makes a dataset, or the rest of one."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import AbstractContextManager, closing, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from thermograsp.dataset import in_processes, on_ray
from thermograsp.dataset.plan import Plan, Shard
from thermograsp.dataset.schema import arrow
from thermograsp.dataset.shards import (
    MANIFEST,
    missing,
    shard_bytes,
    start,
    store,
    tidy,
)
from thermograsp.errors import InvalidValueError, UnknownNameError, whole_number

Advance = Callable[[str, float], None]


@contextmanager
def silent(total: float) -> Iterator[Advance]:
    """Shows no progress."""
    del total
    yield lambda doing, by: None


@dataclass(frozen=True, slots=True)
class ShardCounts:
    """The number of all shards, and of those that were complete before this run."""

    shards: int
    found: int


def make(
    plan: Plan,
    folder: str | os.PathLike[str],
    workers: int = 0,
    address: str | None = None,
    progress: Callable[[float], AbstractContextManager[Advance]] = silent,
) -> ShardCounts:
    """Writes the shards that the folder lacks. The files are the same, byte for byte, however many workers there are
    and however often it was stopped, by machines of one kind (processor, package versions).

    A folder with fewer episodes of the same plan grows. workers: processes on this machine, or with an address Ray's
    tasks at a time; 0 for this process. address: of a Ray cluster, "auto", or "local" for a Ray of our own on this
    machine; None for no Ray. progress: given the episodes to do, a context whose value is told what is being
    done and of each advance in episodes.
    Raises InvalidValueError, MissingDependencyError and what the environment raises."""
    whole_number("workers", workers)
    if address is not None and workers == 0:
        raise InvalidValueError("a Ray address needs workers: say how many tasks are to run at a time")
    arrow()  # what is not installed is told before anything is written
    if address is not None:
        on_ray.ray_package()
    folder = Path(folder)
    with _empty_handed(folder):
        plan = start(folder, plan)
        todo = missing(folder, plan)
        if todo:
            with progress(sum(shard.count for shard in todo)) as advance:
                with closing(_produced(plan, todo, workers, address, advance)) as made:
                    for shard, content in made:  # workers end with it, whatever happens here
                        store(folder, shard, content)
    tidy(folder, plan)
    return ShardCounts(len(plan.shards), len(plan.shards) - len(todo))


@contextmanager
def _empty_handed(folder: Path) -> Iterator[None]:
    """Leaves no dataset behind that was begun here with a value that no environment takes: the same folder serves the
    next try."""
    known, begun = folder.exists(), (folder / MANIFEST).exists()
    try:
        yield
    except (InvalidValueError, UnknownNameError):
        if folder.is_dir() and not begun and not any(folder.glob("*.parquet")):
            (folder / MANIFEST).unlink(missing_ok=True)
            if not known:
                with suppress(OSError):
                    folder.rmdir()
        raise


def _produced(
    plan: Plan, shards: Sequence[Shard], workers: int, address: str | None, advance: Advance
) -> Generator[tuple[Shard, bytes]]:
    """(shard, file) as they are done, by whom `make` says."""

    def one() -> None:
        advance("", 1)

    if address is not None:
        for shard, content in on_ray.produce(plan, shards, workers, address):
            yield shard, content
            advance("", shard.count)
    elif workers:
        yield from in_processes.produce(plan, shards, workers, one)
    else:
        for shard in shards:
            yield shard, shard_bytes(plan, shard, one)
