"""Files appear whole or not at all; the cache may be lost, damaged or shared."""

import os
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from threadpoolctl import threadpool_info

from thermograsp.errors import InvalidValueError
from thermograsp.files import (
    atomic_write,
    cache_dir,
    cached_arrays,
    cached_file,
    write_text,
)


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("THERMOGRASP_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


class Builder:
    """Counts how often it is asked."""

    def __init__(self) -> None:
        self.calls = 0

    def __call__(self) -> dict[str, np.ndarray]:
        self.calls += 1
        return {"a": np.arange(6.0).reshape(2, 3), "b": np.array(7)}


def test_a_file_is_written_whole(tmp_path: Path) -> None:
    write_text(tmp_path / "a.csv", "time_s\r\n0\n°C")
    assert (tmp_path / "a.csv").read_bytes() == "time_s\r\n0\n°C".encode()
    assert os.listdir(tmp_path) == ["a.csv"]


def test_a_writer_that_fails_leaves_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("old")
    with pytest.raises(KeyboardInterrupt), atomic_write(path) as temporary:
        temporary.write_text("half")
        raise KeyboardInterrupt
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["a.txt"]


def test_a_reader_sees_the_old_file_until_the_new_one_is_whole(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("old")
    with atomic_write(path) as temporary:
        temporary.write_text("new")
        assert temporary.suffix == ".txt"
        assert path.read_text() == "old"
    assert path.read_text() == "new"


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "target")
    write_text(tmp_path / "link", "x")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "target").read_text() == "x"


def test_a_new_file_has_the_usual_permissions(tmp_path: Path) -> None:
    (tmp_path / "usual").write_text("x")
    write_text(tmp_path / "ours", "x")
    assert (tmp_path / "ours").stat().st_mode == (tmp_path / "usual").stat().st_mode


def test_places_that_cannot_be_written_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidValueError, match="no folder .*missing; create it first"):
        write_text(tmp_path / "missing" / "a.txt", "x")
    with pytest.raises(InvalidValueError, match="a folder or a device"):
        write_text(tmp_path, "x")
    with pytest.raises(InvalidValueError, match="a folder or a device"):
        write_text("/dev/null", "x")


def test_the_cache_folder_is_the_users_unless_set(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("THERMOGRASP_CACHE", str(tmp_path))
    assert cache_dir() == tmp_path
    monkeypatch.delenv("THERMOGRASP_CACHE")
    assert cache_dir().name == "thermograsp"


def test_what_was_built_once_is_read_back(cache: Path) -> None:
    build = Builder()
    first = cached_arrays({"version": 1, "h": 1e4}, build)
    second = cached_arrays({"h": 1e4, "version": 1}, build)
    assert build.calls == 1
    for arrays in (first, second):
        assert list(arrays) == ["a", "b"]
        np.testing.assert_array_equal(arrays["a"], [[0, 1, 2], [3, 4, 5]])
        assert arrays["b"].shape == ()


def test_disabled_it_neither_reads_nor_writes(cache: Path) -> None:
    build = Builder()
    for _ in range(2):
        cached_arrays({"version": 1}, build, enabled=False)
    assert build.calls == 2
    assert not cache.exists()


@dataclass(frozen=True)
class Plate:
    width: float


def test_keys_that_differ_are_kept_apart(cache: Path) -> None:
    keys = [
        1,
        1.0000000000000002,
        "1",
        None,
        [1],
        np.ones(2),
        np.ones(2, np.float32),
        np.ones((1, 2)),
        Plate(1.0),
    ]
    keys += [Plate(2.0), {"a": Plate(1.0)}, {"b": 1}, np.float64(0.1)]
    build = Builder()
    for _ in range(2):
        for key in keys:
            cached_arrays({"key": key}, build)
    assert build.calls == len(keys)


def test_a_key_that_has_no_value_of_its_own_is_refused(cache: Path) -> None:
    for key in (object(), {1, 2}, np.array([object()]), Plate):
        with pytest.raises(InvalidValueError, match="a cache key cannot hold"):
            cached_arrays({"key": key}, Builder())


def test_a_failed_build_leaves_nothing(cache: Path) -> None:
    def build() -> dict[str, np.ndarray]:
        raise RuntimeError("no convergence")

    with pytest.raises(RuntimeError, match="no convergence"):
        cached_arrays({"version": 1}, build)
    assert not cache.exists()


def test_a_damaged_file_is_built_again(cache: Path) -> None:
    build = Builder()
    cached_arrays({"version": 1}, build)
    (path,) = cache.iterdir()
    whole = path.read_bytes()
    flipped = bytearray(whole)
    flipped[whole.index(np.arange(6.0).tobytes()) + 7] ^= 1
    damaged = [b"", b"not an archive", whole[:100], whole[:-30], bytes(flipped)]
    for count, content in enumerate(damaged, start=2):
        path.write_bytes(content)
        arrays = cached_arrays({"version": 1}, build)
        assert build.calls == count
        np.testing.assert_array_equal(arrays["a"], np.arange(6.0).reshape(2, 3))
        assert path.read_bytes() == whole


def test_a_folder_that_cannot_be_written_costs_one_warning_only(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("THERMOGRASP_CACHE", str(tmp_path / "file" / "cache"))
    with pytest.warns(RuntimeWarning, match="set THERMOGRASP_CACHE to a writable folder") as said:
        arrays = [cached_arrays({"version": version}, Builder()) for version in range(3)]
    assert [one["b"] for one in arrays] == [7, 7, 7]
    assert len(said) == 1


def test_many_processes_build_one_key_at_once(cache: Path) -> None:
    code = """
import sys
import numpy as np
from thermograsp.files import cached_arrays

sys.stdin.read()  # wait until all have started
for version in range(20):
    field = cached_arrays({"version": version}, lambda: {"field": np.full(20_000, float(version))})["field"]
    assert field.shape == (20_000,) and (field == version).all()
"""
    processes = [
        subprocess.Popen([sys.executable, "-W", "error", "-c", code], stdin=subprocess.PIPE) for _ in range(4)
    ]
    for process in processes:
        assert process.stdin is not None
        process.stdin.close()
    assert [process.wait(timeout=60) for process in processes] == [0] * 4
    assert len(list(cache.iterdir())) == 20


def test_code_that_changed_does_not_read_what_the_old_code_built(
    cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    build = Builder()
    cached_arrays({"h": 1.0}, build)
    monkeypatch.setattr("thermograsp.files.source_hash", lambda module: "another version's")
    cached_arrays({"h": 1.0}, build)
    assert build.calls == 2


def _age(path: Path, seconds: float) -> None:
    """As if nobody had used a file for so long."""
    used = time.time() - seconds
    os.utime(path, (used, used))


def _write(path: Path) -> None:
    path.write_text("mesh" * 1000)


def _fill(count: int) -> list[np.ndarray]:
    """Arrays of 10 kB under the keys 0 .. count - 1."""
    return [cached_arrays({"n": n}, lambda n=n: {"a": np.full(1250, float(n))})["a"] for n in range(count)]


def test_the_cache_keeps_to_its_size_and_drops_what_was_used_longest_ago(
    cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("THERMOGRASP_CACHE_SIZE", "60e3")  # five of them and a file
    handed_out = cached_file({"n": 0}, ".ply", _write)
    _fill(5)
    for n, path in enumerate(sorted(cache.glob("*.npz"), key=lambda path: path.stat().st_mtime_ns)):
        _age(path, 1e6 - n)
    _age(handed_out, 3600)
    _fill(1)  # reads the oldest of them, which makes it the newest
    build = Builder()
    cached_arrays({"n": "new"}, build)
    cached_arrays({"n": "big"}, lambda: {"a": np.zeros(2500)})
    assert sum(path.stat().st_size for path in cache.iterdir()) <= 60e3
    cached_arrays({"n": "new"}, build)
    assert build.calls == 1
    assert cached_arrays({"n": 0}, Builder())["a"].shape == (1250,)  # kept: it was used last
    assert cached_arrays({"n": 1}, Builder())["a"].shape == (2, 3)  # built again: it had gone
    assert handed_out.is_file()  # somebody may be reading it


def test_a_file_handed_out_goes_a_day_after_its_last_use(
    cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("THERMOGRASP_CACHE_SIZE", "11e3")
    path = cached_file({"n": 0}, ".ply", _write)
    _age(path, 90_000)
    cached_file({"n": 0}, ".ply", _write)
    _fill(1)
    assert path.is_file()
    _age(path, 90_000)
    _fill(2)
    assert not path.exists()


def test_a_size_that_is_none_is_refused(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for size in ("much", "0", "-1", "nan"):
        monkeypatch.setenv("THERMOGRASP_CACHE_SIZE", size)
        with pytest.raises(InvalidValueError, match="set it to a number of bytes"):
            cached_arrays({"size": size}, Builder())


def test_a_build_has_one_blas_thread(cache: Path) -> None:
    def build() -> dict[str, np.ndarray]:
        pools = [one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"]
        return {"threads": np.array(pools)}

    for enabled in (True, False):
        threads = cached_arrays({"n": 0}, build, enabled=enabled)["threads"]
        assert len(threads) and (threads == 1).all()
