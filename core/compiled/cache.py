"""Where a kernel's compiled code is kept: beside its source, or where numba finds a folder for it."""

from __future__ import annotations

import functools
import hashlib
import inspect
import logging
import os
import sys
import warnings
from collections.abc import Iterator
from typing import Any, cast

import numba
from numba.core.caching import CompileResultCacheImpl, FunctionCache, NullCache
from numba.core.codegen import JITCodeLibrary
from numba.core.serialize import dumps

from thermograsp.notice import notice

from .cache_file import CacheFile
from .hashes import compiled_hash
from .libraries import InnerLibrary, into

_LOG = logging.getLogger(__name__)
_PACKAGE = __name__.partition(".")[0]
_REPORTED: list[str] = []
"""The first function that this process has compiled."""


def cache_of(dispatcher: Any, inner: bool) -> FunctionCache | NullCache:
    """Where the function's code is kept: nowhere where numba knows no place for it, as for text that was executed."""
    try:
        return KernelCache(dispatcher, inner)
    except RuntimeError:
        return NullCache()


@functools.lru_cache(maxsize=8)
def _warn_of_no_folder(reason: str) -> None:
    """Once, not for every function."""
    warnings.warn(
        f"cannot keep compiled code ({reason}): every process compiles it again, which takes some seconds; make room, "
        "or set NUMBA_CACHE_DIR to a writable folder",
        RuntimeWarning,
        stacklevel=2,
    )


_Chosen, _BesideSource = cast(tuple[Any, Any], tuple(CompileResultCacheImpl._locator_classes[:2]))
"""numba's places of code: in NUMBA_CACHE_DIR, and in the source's folder. Their names depend on numba's version."""


class _ByModule(_Chosen):
    """In NUMBA_CACHE_DIR, by the module's name: what one copy of the package has compiled serves all of its version, as
    hashes say whether it is the same. Of copies that differ the last one's is kept."""

    def __init__(self, py_func: Any, py_file: str) -> None:
        super().__init__(py_func, py_file)
        package, *folders = py_func.__module__.split(".")[:-1] or [""]
        if package == _PACKAGE:
            chosen = cast(Any, numba).config.CACHE_DIR
            version = sys.modules[_PACKAGE].__version__  # whose import would run in a circle
            versions = f"{package}-{version}-numba-{numba.__version__}"
            self._cache_path = os.path.join(chosen, versions, *folders)


class _Unwritable(_BesideSource):
    """Where no folder can be written: the source's. What others have kept can still be read."""

    @classmethod
    def from_function(cls, py_func: Any, py_file: str) -> Any:
        return cls(py_func, py_file) if os.path.exists(py_file) else None


class _Implementation(CompileResultCacheImpl):
    """numba's, one of them by another name, with one more place to try."""

    _locator_classes = (_ByModule, *CompileResultCacheImpl._locator_classes[1:], _Unwritable)


class KernelCache(FunctionCache):
    """A kernel's compiled code on disk. The hash is taken when the code is first looked for, as a function may refer
    to what its module defines after it."""

    _impl_class = _Implementation

    def __init__(self, dispatcher: Any, inner: bool) -> None:
        super().__init__(dispatcher.py_func)
        self._dispatcher = dispatcher
        self._inner = inner
        self._hashed = False

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        self._hash()
        with into(InnerLibrary if self._inner else JITCodeLibrary):
            found = super().load_overload(sig, target_context)
        if found is None:
            _tell(self._dispatcher.py_func.__name__)
        return found

    def save_overload(self, sig: Any, data: Any) -> None:
        """Where nothing can be written, this process has its code all the same, and the next one compiles again."""
        self._hash()
        try:
            super().save_overload(sig, data)
        except OSError as error:
            _warn_of_no_folder(error.strerror or str(error))

    def keeps_any(self) -> bool:
        """Whether code of the function as it is now is on disk, for whatever arguments."""
        self._hash()
        return self._cache_file.holds_any()

    def number(self, sig: Any, codegen: Any) -> int:
        """What processes that compile the function for such arguments call it."""
        self._hash()
        name = f"{self._cache_file._index_name}\0{self._cache_file._source_stamp}\0".encode()
        key = dumps(self._index_key(sig, codegen))
        return 1 + int.from_bytes(hashlib.sha256(name + key).digest()[:6])

    def _hash(self) -> None:
        if not self._hashed:
            stamp = compiled_hash(self._dispatcher)
            name = self._impl.filename_base + (".inner" if self._inner else "")
            shared = [CacheFile(folder, name, stamp) for folder in self._shared()]
            self._cache_file = CacheFile(self._cache_path, name, stamp, shared)
            self._hashed = True

    def _shared(self) -> Iterator[str]:
        """Folders that numba would have taken if this user could write them: others may have filled them."""
        function = self._dispatcher.py_func
        for kind in (_ByModule, _BesideSource):
            if type(self._impl.locator) is kind:
                return
            if kind is _BesideSource or cast(Any, numba).config.CACHE_DIR:
                yield kind(function, inspect.getfile(function)).get_cache_path()


def _tell(name: str) -> None:
    """Says once that this process compiles, and logs what."""
    if not _REPORTED:
        _REPORTED.append(name)
        notice("compiling for this processor, once: `thermograsp warmup` does it ahead ...")
    _LOG.info("compiling %s", name)
