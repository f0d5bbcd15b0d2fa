"""A disk that is full: whoever writes says so, loses nothing that was there, and leaves no part of a file."""

import errno
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from thermograsp.columns import write_csv
from thermograsp.compiled import njit
from thermograsp.compiled.cache_file import CacheFile
from thermograsp.errors import InvalidValueError, ThermograspError, WriteError
from thermograsp.figures.film import write_pictures
from thermograsp.figures.saving import save_figure
from thermograsp.files import atomic_write, cached_arrays, cached_file, made_folder, write_text
from thermograsp.thermal import sensor
from thermograsp.thermal.matter.sensors import write_sensor

NOISE = np.random.default_rng(0).random(20_000)


@contextmanager
def no_room_at_the_end() -> Iterator[None]:
    """The system takes all bytes and finds, when they are to be on the disk, that there is no room."""

    def full(handle: int) -> None:
        del handle
        raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", full)
        yield


@contextmanager
def no_room_in_the_middle() -> Iterator[None]:
    """The system takes the first 4 kB of a file."""
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def _archive(path: Path) -> None:
    with atomic_write(path) as temporary:
        np.savez_compressed(temporary, noise=NOISE)


def _figure(path: Path) -> None:
    figure = Figure()
    figure.add_subplot().plot(NOISE[:1000])
    save_figure(figure, path.with_suffix(""), 100)


def _film(path: Path) -> None:
    pixels = (255 * NOISE[:19_200]).astype(np.uint8).reshape(80, 80, 3)
    write_pictures(path, [Image.fromarray(pixels)] * 2, [0.0, 1.0])


WRITERS: dict[str, Callable[[Path], None]] = {
    "page.html": lambda path: write_text(path, "x" * 10_000),
    "touch.csv": lambda path: write_csv(path, {"time_s": NOISE}),
    "fitted.toml": lambda path: write_sensor(path, sensor("seed"), ["note" * 2000]),
    "policy.npz": _archive,
    "plot.png": _figure,
    "film.gif": _film,
}


@pytest.mark.parametrize("full", [no_room_at_the_end, no_room_in_the_middle])
@pytest.mark.parametrize("name", WRITERS)
def test_a_file_is_refused_and_the_old_one_stays(
    tmp_path: Path, name: str, full: Callable[[], AbstractContextManager[None]]
) -> None:
    path = tmp_path / name
    path.write_bytes(b"of yesterday")
    with pytest.raises(WriteError, match=f"cannot write .*{name}: ") as raised, full():
        WRITERS[name](path)
    assert raised.value.errno in (errno.ENOSPC, errno.EFBIG, None)
    assert os.listdir(tmp_path) == [name] and path.read_bytes() == b"of yesterday"
    WRITERS[name](path)
    assert path.read_bytes() != b"of yesterday"


def test_what_to_do_is_said(tmp_path: Path) -> None:
    with (
        pytest.raises(WriteError, match=r"a\.txt: No space left on device; make room or name another disk"),
        no_room_at_the_end(),
    ):
        write_text(tmp_path / "a.txt", "x")


def test_an_error_of_ours_is_left_as_it_is(tmp_path: Path) -> None:
    class Broken(ThermograspError, OSError):
        pass

    with pytest.raises(Broken), atomic_write(tmp_path / "a.txt"):
        raise Broken("it is the line that is broken")
    assert not os.listdir(tmp_path)


def test_a_folder_that_cannot_be_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(InvalidValueError, match="it is not a folder"):
        made_folder(tmp_path / "file")
    with pytest.raises(WriteError, match="file/below: Not a directory; name another place"):
        made_folder(tmp_path / "file" / "below")
    assert made_folder(tmp_path / "new" / "below").is_dir()


@pytest.mark.parametrize("full", [no_room_at_the_end, no_room_in_the_middle])
def test_a_cache_that_is_full_costs_a_warning_only(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, full: Callable[[], AbstractContextManager[None]]
) -> None:
    monkeypatch.setenv("THERMOGRASP_CACHE", str(tmp_path / "cache"))
    with pytest.warns(RuntimeWarning, match="cannot keep results in .*set THERMOGRASP_CACHE"), full():
        built = cached_arrays({"key": 1}, lambda: {"noise": NOISE})
    assert np.array_equal(built["noise"], NOISE)
    with pytest.raises(InvalidValueError, match="set THERMOGRASP_CACHE to a writable folder"), full():
        cached_file({"key": 1}, ".bin", WRITERS["page.html"])
    assert os.listdir(tmp_path / "cache") == []
    again = cached_arrays({"key": 1}, lambda: {"noise": NOISE})
    assert np.array_equal(again["noise"], NOISE) and len(os.listdir(tmp_path / "cache")) == 1


def test_compiled_code_that_cannot_be_kept_is_used(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(self: CacheFile, name: str, data: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(CacheFile, "_save_data", full)

    @njit(cache=True)
    def doubled(x: float) -> float:
        return 2.0 * x

    with pytest.warns(RuntimeWarning, match="cannot keep compiled code .*No space left.*NUMBA_CACHE_DIR"):
        assert doubled(1.5) == 3.0
    assert doubled(2.5) == 5.0


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no /dev/full")
@pytest.mark.parametrize("options", [[], ["--json"]])
def test_results_that_cannot_be_printed(options: list[str]) -> None:
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "thermograsp", "materials", *options],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
        )
    assert done.returncode == 2
    assert done.stderr == "thermograsp: [Errno 28] No space left on device\n"
