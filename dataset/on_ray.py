"""Shards rolled out by Ray's workers. They send back bytes, so nodes need no common disk; only the driver writes."""

from __future__ import annotations

import itertools
import os
import socket
from collections.abc import Generator, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from thermograsp.dataset.plan import Plan, Shard
from thermograsp.dataset.shards import shard_bytes
from thermograsp.errors import InvalidValueError, MissingDependencyError, SimulationError, install

_STORE = 256 * 2**20  # bytes for shards on their way: each is a few MB
_PATIENCE = 10.0  # s
_QUIET = {"RAY_USAGE_STATS_ENABLED": "0", "RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO": "0"}


def produce(
    plan: Plan, shards: Sequence[Shard], workers: int, address: str
) -> Generator[tuple[Shard, bytes]]:
    """(shard, file) in the order in which they are done, `workers` at a time.

    A task whose worker or node dies is run again elsewhere. address: of a cluster, "local" for a Ray of our own on this
    machine, which ends with us. Raises MissingDependencyError, InvalidValueError where no cluster answers, and
    SimulationError for a shard whose workers died again and again."""
    ray = ray_package()
    with _connected(ray, workers, address):
        task = ray.remote(num_cpus=1)(shard_bytes)
        waiting = iter(shards)
        running = {task.remote(plan, shard): shard for shard in itertools.islice(waiting, workers)}
        while running:
            (done, *_), _ = ray.wait(list(running), num_returns=1)
            shard = running.pop(done)
            running |= {task.remote(plan, after): after for after in itertools.islice(waiting, 1)}
            try:
                content = ray.get(done)
            except ray.exceptions.RayTaskError as error:
                raise error.cause from None
            except ray.exceptions.RayError as error:
                raise SimulationError(
                    f"the workers of seeds {shard.first} .. {shard.seeds[-1]} died repeatedly; finished files are "
                    f"kept, and the same command resumes: {error}"
                ) from error
            yield shard, content


def ray_package() -> Any:
    """The ray module. Raises MissingDependencyError."""
    try:
        import ray  # pyright: ignore[reportMissingImports]
    except ImportError as error:
        raise MissingDependencyError(
            f"a Ray address needs Ray: {install('ray')}, or leave it out for processes of this machine"
        ) from error
    return ray


@contextmanager
def _connected(ray: Any, workers: int, address: str) -> Iterator[None]:
    """Connects, unless the caller did already; leaves what it found."""
    if ray.is_initialized():
        yield
        return
    quiet: dict[str, Any] = {"log_to_driver": False, "logging_level": "ERROR"}
    try:
        with _environment(_QUIET):
            if address == "local":
                ray.init(
                    num_cpus=workers,
                    include_dashboard=False,
                    object_store_memory=_STORE,
                    address="local",
                    **quiet,
                )
            else:
                _knock(address)
                ray.init(address=address, **quiet)
    except (OSError, ValueError) as error:
        raise InvalidValueError(
            f"no Ray cluster at {address!r}: {error}; start one with `ray start`"
        ) from error
    try:
        yield
    finally:
        ray.shutdown()


def _knock(address: str) -> None:
    """Raises OSError where nobody listens at host:port: Ray itself would try for minutes."""
    host, _, port = address.rpartition(":")
    if host and port.isdecimal() and "/" not in host:
        socket.create_connection((host, int(port)), _PATIENCE).close()


@contextmanager
def _environment(settings: dict[str, str]) -> Iterator[None]:
    """Variables that the processes started meanwhile inherit; those the user has set stay."""
    added = {name: value for name, value in settings.items() if name not in os.environ}
    os.environ.update(added)
    try:
        yield
    finally:
        for name in added:
            os.environ.pop(name, None)
