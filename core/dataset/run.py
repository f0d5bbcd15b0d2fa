"""Makes a dataset, or the rest of one."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import AbstractContextManager, closing, contextmanager
from dataclasses import dataclass
from pathlib import Path

from thermograsp.dataset import on_ray
from thermograsp.dataset.plan import Plan, Shard
from thermograsp.dataset.schema import arrow
from thermograsp.dataset.shards import missing, shard_bytes, start, store
from thermograsp.errors import InvalidValueError

Advance = Callable[[str, float], None]


@contextmanager
def silent(total: float) -> Iterator[Advance]:
    """Shows no progress."""
    del total
    yield lambda doing, by: None


@dataclass(frozen=True, slots=True)
class Made:
    """Shards in all, and those of them that this run found done."""

    shards: int
    found: int


def make(
    plan: Plan,
    folder: str | os.PathLike[str],
    workers: int = 0,
    address: str | None = None,
    progress: Callable[[float], AbstractContextManager[Advance]] = silent,
) -> Made:
    """Writes the shards that the folder lacks. The files are the same, byte for byte, however many workers there are
    and however often it was stopped, by machines of one kind (processor, package versions).

    workers: Ray tasks at a time; 0 for this process, without Ray. address: of a Ray cluster; None for a Ray of our own
    on this machine. progress: given the episodes to do, a context whose value is told what is being
    done and of each advance in episodes.
    Raises InvalidValueError, MissingDependencyError and what the environment raises."""
    if workers < 0:
        raise InvalidValueError(f"workers must be 0 or above, got {workers}")
    if address is not None and workers == 0:
        raise InvalidValueError("a Ray address needs workers: say how many tasks are to run at a time")
    arrow()  # what is not installed is told before anything is written
    if workers:
        on_ray.ray_package()
    folder = Path(folder)
    start(folder, plan)
    todo = missing(folder, plan)
    if todo:
        with progress(sum(shard.count for shard in todo)) as advance:
            made = on_ray.produce(plan, todo, workers, address) if workers else _here(plan, todo, advance)
            with closing(made):  # Ray ends with it, whatever happens here
                for shard, content in made:
                    store(folder, shard, content)
                    if workers:
                        advance("", shard.count)
    return Made(len(plan.shards), len(plan.shards) - len(todo))


def _here(plan: Plan, shards: Sequence[Shard], advance: Advance) -> Generator[tuple[Shard, bytes]]:
    for shard in shards:
        yield shard, shard_bytes(plan, shard, lambda: advance("", 1))
