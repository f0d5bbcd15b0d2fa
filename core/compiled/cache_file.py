"""Files of compiled code that processes may write at once, and that tell when they are damaged."""

from __future__ import annotations

import glob
import hashlib
import logging
import os
import pickle
from collections.abc import Mapping, Sequence
from typing import Any

from numba.core.caching import IndexDataCacheFile
from numba.core.serialize import dumps

_LOG = logging.getLogger(__name__)


class CacheFile(IndexDataCacheFile):
    """Safe where processes write at once. A file of code is named by what it holds and is written before the index
    that names it; of two indices written at once one is lost, and with it no more than the time to compile again.
    Every file begins with a hash of the rest: one that is damaged, as by a loss of power, is as good as none.

    shared: files that are only read, before this one."""

    def __init__(
        self, cache_path: str, filename_base: str, source_stamp: str, shared: Sequence[CacheFile] = ()
    ) -> None:
        super().__init__(cache_path, filename_base, source_stamp)
        self._shared = shared

    def load(self, key: Any) -> Any:
        for file in self._shared:
            if (found := file.load(key)) is not None:
                return found
        return super().load(key)

    def holds_any(self) -> bool:
        """Whether it has code for whatever arguments."""
        return any(file.holds_any() for file in self._shared) or bool(self._load_index())

    def save(self, key: Any, data: Any) -> None:
        content = hashlib.sha256(f"{self._source_stamp}\0".encode() + dumps(key)).hexdigest()
        base = self._index_name.removesuffix(".nbi")
        name = f"{base}.{content[:24]}.nbc"
        self._save_data(name, data)
        known = self._load_index()
        self._save_index({**known, key: name})
        if not known:
            self._remove_others(base, name)

    def _load_index(self) -> dict[Any, str]:
        kept = self._read(self._index_path)
        if (
            kept is None or kept[0] != self._version
        ):  # numba's; another one's keys may mean nothing to this one
            return {}
        stamp, names = pickle.loads(kept[1])
        return names if stamp == self._source_stamp else {}

    def _save_index(self, overloads: Mapping[Any, str]) -> None:
        self._write(self._index_path, (self._version, self._dump((self._source_stamp, overloads))))

    def _load_data(self, name: str) -> Any:
        return self._read(self._data_path(name))

    def _save_data(self, name: str, data: Any) -> None:
        self._write(self._data_path(name), data)

    def _write(self, path: str, data: Any) -> None:
        content = self._dump(data)
        with self._open_for_write(path) as file:
            file.write(hashlib.sha256(content).digest() + content)

    def _read(self, path: str) -> Any:
        """What _write wrote there; None where there is nothing of it."""
        try:
            with open(path, "rb") as file:
                found, content = file.read(hashlib.sha256().digest_size), file.read()
        except OSError:
            return None
        if hashlib.sha256(content).digest() != found:
            _LOG.info("%s is damaged: its code is compiled again", path)
            return None
        return pickle.loads(content)

    def _remove_others(self, base: str, kept: str) -> None:
        """Code of an older version."""
        for path in glob.iglob(os.path.join(glob.escape(self._cache_path), f"{glob.escape(base)}.*.nbc")):
            if os.path.basename(path) != kept:
                try:
                    os.unlink(path)
                except OSError:  # another process was faster, or has it open
                    pass
