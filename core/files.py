"""Files that appear whole or not at all, and a cache of arrays on disk that is safe to lose and to share."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import os
import secrets
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from platformdirs import user_cache_path

from thermograsp.errors import InvalidValueError

CACHE_VARIABLE = "THERMOGRASP_CACHE"


@contextmanager
def atomic_write(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A temporary path beside `path`, of the same suffix; it takes the place of `path` when the block ends well.

    When the block raises, the temporary file goes and the old file, if any, stays. Readers in other processes see the
    old or the new content, never a part. Raises InvalidValueError where the folder does not exist or `path` is a
    folder or a device.
    """
    target = Path(path).resolve()  # through a link: replace what it points to, keep the link
    if not target.parent.is_dir():
        raise InvalidValueError(f"cannot write {path}: there is no folder {target.parent}; create it first")
    if target.exists() and not target.is_file():
        raise InvalidValueError(f"cannot write {path}: it is a folder or a device; name a regular file")
    temporary = target.with_name(f".{secrets.token_hex(8)}{target.suffix}")
    try:
        yield temporary
        os.replace(temporary, target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write `text` as UTF-8, whole or not at all; line ends as given. Raises as atomic_write does."""
    with atomic_write(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="")


def cache_dir() -> Path:
    """Folder of the cache: $THERMOGRASP_CACHE if set, else the user's cache folder. It need not exist yet."""
    chosen = os.environ.get(CACHE_VARIABLE)
    return Path(chosen).expanduser() if chosen else user_cache_path("thermograsp", appauthor=False)


def cached_arrays(
    key_fields: Mapping[str, Any], build: Callable[[], Mapping[str, np.ndarray]], enabled: bool = True
) -> dict[str, np.ndarray]:
    """What `build` returns, kept on disk under a hash of `key_fields` and read back the next time.

    key_fields: all that the result depends on, a version of the algorithm included: None, bool, numbers, strings,
    arrays, dataclasses, and dicts, lists and tuples of these. A file that cannot be read is built again; a folder that
    cannot be written costs a RuntimeWarning, not the result. Processes that build the same key at once each get the
    full arrays. Raises InvalidValueError for a key of another type. enabled=False only builds.
    """
    if not enabled:
        return dict(build())
    path = cache_dir() / f"{_digest(key_fields)}.npz"
    stored = _read(path)
    if stored is not None:
        return stored
    arrays = {name: np.asarray(array) for name, array in build().items()}
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with atomic_write(path) as temporary:
            np.savez(temporary, **arrays)  # pyright: ignore[reportArgumentType]
    except OSError as error:
        warnings.warn(
            f"cannot keep a result in {path.parent} ({error}); set {CACHE_VARIABLE} to a writable folder",
            RuntimeWarning,
            stacklevel=2,
        )
    return arrays


def cached_file(key_fields: Mapping[str, Any], suffix: str, write: Callable[[Path], None]) -> Path:
    """A file of the cache, named by a hash of `key_fields` (see cached_arrays), that `write` makes at the path it is
    given where it is not there yet. Raises InvalidValueError where the cache's folder cannot be written."""
    path = cache_dir() / f"{_digest(key_fields)}{suffix}"
    if path.is_file():
        return path
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with atomic_write(path) as temporary:
            write(temporary)
    except OSError as error:
        raise InvalidValueError(
            f"cannot write {path} ({error}); set {CACHE_VARIABLE} to a writable folder"
        ) from error
    return path


def _read(path: Path) -> dict[str, np.ndarray] | None:
    try:
        with np.load(path, allow_pickle=False) as archive:
            return {name: archive[name] for name in archive.files}
    except FileNotFoundError:
        return None
    except Exception:  # noqa: BLE001
        # A damaged archive raises whatever its broken bytes lead to, and the answer is always to build it again.
        return None


def _digest(key_fields: Mapping[str, Any]) -> str:
    text = json.dumps(dict(key_fields), sort_keys=True, default=_plain)
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
