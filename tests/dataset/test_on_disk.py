"""A dataset on a disk that loses power or fills up."""

import errno
import multiprocessing
import os
from pathlib import Path

import pytest

from thermograsp import dataset
from thermograsp.errors import WriteError
from thermograsp.files import atomic_write

from .plan import PLAN, contents

pytest.importorskip("pyarrow")


def test_a_file_is_on_the_disk_when_its_name_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A loss of power may not leave a name without its content."""
    order: list[str] = []
    sync, put = os.fsync, os.replace
    monkeypatch.setattr(
        os, "fsync", lambda handle: (order.append(os.readlink(f"/proc/self/fd/{handle}")), sync(handle))[1]
    )
    monkeypatch.setattr(os, "replace", lambda a, b: (order.append(f"{a} becomes {b}"), put(a, b))[1])
    with atomic_write(tmp_path / "a.parquet") as temporary:
        temporary.write_bytes(b"rows")
    assert order == [str(temporary), f"{temporary} becomes {tmp_path / 'a.parquet'}", str(tmp_path)]


@pytest.mark.parametrize("workers", [0, pytest.param(2, marks=pytest.mark.slow)])
def test_a_disk_that_fills_up_loses_nothing_that_was_whole(
    folder: Path, tmp_path: Path, workers: int
) -> None:
    """The system finds no room for the second shard. What was there stays, no part of a file is left, no process goes
    on, and the same command makes the rest when there is room again."""
    whole, sync, stored = contents(folder), os.fsync, []

    def full(handle: int) -> None:
        name = os.readlink(f"/proc/self/fd/{handle}")
        if name.endswith(".parquet"):
            stored.append(name)
            if len(stored) > 1:
                raise OSError(errno.ENOSPC, "No space left on device")
        sync(handle)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(WriteError, match=r"cannot write .*seeds-.*No space left on device; make room"):
            dataset.make(PLAN, tmp_path, workers=workers)
    assert not multiprocessing.active_children()
    left = contents(tmp_path)
    assert len(left) == 2 and left.items() <= whole.items()
    assert dataset.make(PLAN, tmp_path, workers=workers) == dataset.ShardCounts(shards=3, found=1)
    assert contents(tmp_path) == whole


def test_a_disk_that_is_full_at_once_begins_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(handle: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(WriteError, match=r"manifest\.json: No space left on device"):
        dataset.make(PLAN, tmp_path / "d")
    assert not list((tmp_path / "d").iterdir())
