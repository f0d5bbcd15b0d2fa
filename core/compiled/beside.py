"""A second process that compiles what is not kept on disk yet."""

from __future__ import annotations

from typing import Any

from thermograsp.beside import start_beside

from .cache import KernelCache


def compile_beside(module: str, *needed: Any, by: str = "compile_ahead") -> None:
    """Where the code of one of the needed functions, or of an inner twin (`called`) that is given in its place, is not
    kept on disk yet, a second process calls that function of the module while this one goes on (see start_beside). This
    one waits only where it needs what the other is compiling at that moment. The code is the same whoever compiles it.
    One second process at a time has the same first function."""
    caches = [function._cache for function in needed]
    if all(isinstance(cache, KernelCache) for cache in caches) and not all(
        cache.keeps_any() for cache in caches
    ):
        start_beside(module, caches[0].cache_path, by)
