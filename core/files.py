"""Files that appear whole or not at all, and a cache of arrays on disk that is safe to lose and to share."""

from __future__ import annotations

import dataclasses
import errno
import functools
import hashlib
import json
import logging
import os
import secrets
import time
import tomllib
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np
from platformdirs import user_cache_path
from threadpoolctl import threadpool_limits

from thermograsp.errors import InvalidValueError, ThermograspError, WriteError
from thermograsp.sources import source_hash

CACHE_VARIABLE = "THERMOGRASP_CACHE"
CACHE_SIZE_VARIABLE = "THERMOGRASP_CACHE_SIZE"

_LOG = logging.getLogger(__name__)
_CACHE_SIZE = 1e9  # bytes, unless the variable says otherwise
_FILE_STAYS = 86400.0  # s after its last use, a file of which the path was handed out


@contextmanager
def atomic_write(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A temporary path beside `path`, of the same suffix; it takes the place of `path` when the block ends well.

    When the block raises, the temporary file goes and the old file, if any, stays. Readers in other processes see the
    old or the new content, never a part; so does whoever comes after a loss of power, for the content is on the disk
    before its name is. Raises InvalidValueError where the folder does not exist or `path` is a folder or a device, and
    WriteError in place of the system's OSError, such as on a full disk.
    """
    target = Path(path).resolve()  # through a link: replace what it points to, keep the link
    if not target.parent.is_dir():
        raise InvalidValueError(f"cannot write {path}: there is no folder {target.parent}; create it first")
    if target.exists() and not target.is_file():
        raise InvalidValueError(f"cannot write {path}: it is a folder or a device; name a regular file")
    temporary = target.with_name(f".{secrets.token_hex(8)}{target.suffix}")
    try:
        yield temporary
        with open(temporary, "r+b") as written:
            os.fsync(written.fileno())
        os.replace(temporary, target)
        _sync_folder(target.parent)
    except BaseException as error:
        with suppress(OSError):  # what has happened already comes first
            temporary.unlink(missing_ok=True)
        if isinstance(error, OSError) and not isinstance(error, ThermograspError):
            raise write_error(path, error) from error
        raise


def write_error(path: str | os.PathLike[str], error: OSError) -> WriteError:
    """What to raise where the system refuses to write there."""
    full = error.errno in (errno.ENOSPC, errno.EDQUOT)
    advice = "make room or name another disk" if full else "name another place"
    raised = WriteError(f"cannot write {path}: {error.strerror or error}; {advice}")
    raised.errno = error.errno
    return raised


def made_folder(path: str | os.PathLike[str]) -> Path:
    """The folder, made with those above it where it is not there yet. Raises InvalidValueError where something else has
    its name, and WriteError where it cannot be made."""
    folder = Path(path)
    if folder.exists() and not folder.is_dir():
        raise InvalidValueError(f"cannot write into {path}: it is not a folder; name another")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise write_error(path, error) from error
    return folder


def _sync_folder(folder: Path) -> None:
    """Puts a folder's names on the disk, where the system has a way to."""
    if not hasattr(os, "O_DIRECTORY"):
        return
    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(handle)
    except OSError:  # some network drives have none for folders
        pass
    finally:
        os.close(handle)


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write `text` as UTF-8, whole or not at all; line ends as given. Raises as atomic_write does."""
    with atomic_write(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="")


def read_toml(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The table of a TOML file. Raises InvalidValueError for one that cannot be read."""
    try:
        return tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise InvalidValueError(f"cannot read {path}: {error.strerror}") from error
    except ValueError as error:  # not UTF-8, not TOML, or a name that stands there twice
        raise InvalidValueError(f"{path} is not valid TOML: {error}") from error


def cache_dir() -> Path:
    """Folder of the cache: $THERMOGRASP_CACHE if set, else the user's cache folder. It need not exist yet."""
    chosen = os.environ.get(CACHE_VARIABLE)
    return Path(chosen).expanduser() if chosen else user_cache_path("thermograsp", appauthor=False)


def cache_size() -> float:
    """Bytes that the cache may hold: $THERMOGRASP_CACHE_SIZE if set, else 1 GB. Raises InvalidValueError for a size
    that is no positive number."""
    chosen = os.environ.get(CACHE_SIZE_VARIABLE)
    try:
        size = float(chosen) if chosen else _CACHE_SIZE
    except ValueError:
        size = -1.0
    if not size > 0:
        raise InvalidValueError(
            f"{CACHE_SIZE_VARIABLE} is {chosen!r}; set it to a number of bytes, such as 1e9"
        )
    return size


def cached_arrays(
    key_fields: Mapping[str, Any], build: Callable[[], Mapping[str, np.ndarray]], enabled: bool = True
) -> dict[str, np.ndarray]:
    """What `build` returns, kept on disk under a hash of `key_fields` and read back the next time.

    key_fields: all that the result depends on beside the code: None, bool, numbers, strings, arrays, dataclasses, and
    dicts, lists and tuples of these. The sources of the module that defines `build`, and of what it imports, are part
    of the hash: no other version of the code reads the file. `build` runs with BLAS in one thread: the number of
    threads does not decide last bits, and many small products take as long beside busy processes as alone.

    A file that cannot be read is built again; a folder that cannot be written costs a RuntimeWarning, not the result.
    Processes that build the same key at once each get the full arrays. Beyond cache_size() the files that nobody has
    used for longest go. Raises InvalidValueError for a key of another type. enabled=False only builds.
    """

    def built() -> Mapping[str, np.ndarray]:
        begun = time.perf_counter()
        with threadpool_limits(1, user_api="blas"):
            arrays = build()
        _LOG.info("%s: built in %.2f s", build.__module__, time.perf_counter() - begun)
        return arrays

    if not enabled:
        return dict(built())
    path = cache_dir() / f"{_digest(key_fields, build)}.npz"
    stored = _read(path)
    if stored is not None:
        _mark_used(path)
        return stored
    arrays = {name: np.asarray(array) for name, array in built().items()}
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with atomic_write(path) as temporary:
            np.savez(temporary, **arrays)  # pyright: ignore[reportArgumentType]
        _evict(path.parent, cache_size())
    except OSError as error:
        reason = error.__cause__ if isinstance(error.__cause__, OSError) else error
        _warn_of_folder(path.parent, reason.strerror or str(reason))
    return arrays


@functools.lru_cache(maxsize=8)
def _warn_of_folder(folder: Path, reason: str) -> None:
    """Once, not for every result."""
    warnings.warn(
        f"cannot keep results in {folder} ({reason}), so every process computes them again; set {CACHE_VARIABLE} to a "
        "writable folder",
        RuntimeWarning,
        stacklevel=3,
    )


def cached_file(key_fields: Mapping[str, Any], suffix: str, write: Callable[[Path], None]) -> Path:
    """A file of the cache, named by a hash of `key_fields` and of the sources of `write` (see cached_arrays), that
    `write` makes at the path it is given where it is not there yet. It stays for a day after this was last called for
    it, whatever the cache's size. Raises InvalidValueError where the cache's folder cannot be written."""
    path = cache_dir() / f"{_digest(key_fields, write)}{suffix}"
    if path.is_file():
        _mark_used(path)
        return path
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with atomic_write(path) as temporary:
            write(temporary)
        _evict(path.parent, cache_size())
    except OSError as error:
        raise InvalidValueError(
            f"cannot write {path} ({error.__cause__ or error}); set {CACHE_VARIABLE} to a writable folder"
        ) from error
    return path


def _mark_used(path: Path) -> None:
    """The time of a file of the cache is when it was last used; a folder that only others may write keeps it."""
    with suppress(OSError):
        os.utime(path)


def _evict(folder: Path, size: float) -> None:
    """Remove what nobody has used for longest until the files hold at most `size` bytes. Processes may do so at once,
    and what one of them reads meanwhile is built again at worst."""
    files = []
    with os.scandir(folder) as entries:
        for entry in entries:
            with suppress(FileNotFoundError):  # another process was faster
                status = entry.stat()
                files.append((status.st_mtime, status.st_size, Path(entry.path)))
    excess = sum(bytes_held for _, bytes_held, _ in files) - size
    now = time.time()
    for used, bytes_held, path in sorted(files):
        if excess <= 0:
            break
        if path.suffix == ".npz" or now - used > _FILE_STAYS:
            with suppress(OSError):
                path.unlink(missing_ok=True)
                excess -= bytes_held
                _LOG.info("the cache is full: %s has gone", path)


def _read(path: Path) -> dict[str, np.ndarray] | None:
    try:
        with np.load(path, allow_pickle=False) as archive:
            return {name: archive[name] for name in archive.files}
    except FileNotFoundError:
        return None
    except Exception:  # noqa: BLE001
        # A damaged archive raises whatever its broken bytes lead to, and the answer is always to build it again.
        return None


def _digest(key_fields: Mapping[str, Any], maker: Callable[..., Any]) -> str:
    """Of a key, and of the sources of the module where its maker is defined."""
    sources = source_hash(maker.__module__)
    text = json.dumps([sources, dict(key_fields)], sort_keys=True, default=_plain)
    return hashlib.sha256(text.encode()).hexdigest()


def _plain(value: object) -> object:
    """JSON stand-in that differs where the value differs; floats are exact, as JSON writes their shortest repr."""
    if isinstance(value, np.ndarray) and value.dtype != object:
        content = hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()
        return ["array", value.dtype.str, value.shape, content]
    if isinstance(value, np.generic):
        return value.item()
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = {field.name: getattr(value, field.name) for field in dataclasses.fields(value)}
        return [type(value).__qualname__, fields]
    raise InvalidValueError(
        f"a cache key cannot hold {value!r} ({type(value).__name__}); use numbers, text or arrays"
    )
