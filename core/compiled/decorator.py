"""numba's decorator `njit`, whose functions compile sooner and may be kept on disk."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numba
from numba.core.compiler_lock import global_compiler_lock
from numba.core.environment import lookup_environment
from numba.core.sigutils import normalize_signature

from thermograsp.beside import turn

from .cache import KernelCache, cache_of
from .libraries import InnerLibrary, compiler, into
from .quicker import in_less_time, let_age

_FIXED_OPTIONS = {"fastmath": False, "error_model": "python", "forceinline": False, "_nrt": True}
"""Options that a function would otherwise take from the caller for which it is first compiled, and keep for all."""

_ENVIRONMENT = "_ZN08NumbaEnv"
"""How numba names what holds a function's environment."""

_NUMBERS = numba.types.IntegerLiteral, numba.types.BooleanLiteral
"""The type of a number that is written into the code."""


def njit(
    *,
    cache: bool = False,
    inner: bool = False,
    short_loops: bool = False,
    borrows: bool = False,
    **options: Any,
) -> Callable[[Callable[..., Any]], Any]:
    """A decorator as numba.njit is, whose functions compile sooner.

    cache: keep the compiled code beside the source, or where NUMBA_CACHE_DIR says. inner: only compiled code calls the
    function. No entry from Python is then compiled, which may take longer than the function itself; a call from Python
    raises TypeError. Every other function has an inner twin, which compiled code calls; its entry is compiled when
    Python first calls it. A number written into a call is an argument as others are: numba would compile the function
    once more for each. short_loops: the innermost loops run over few elements, so the processor's vectors are not used
    for them. The results have the same bits, and the function compiles and runs in less time. borrows: it makes no
    arrays, it only looks at those that it is given: nothing counts who holds them, which takes a call for each part of
    one. It may return a part to others that borrow, not to a function that counts.
    """
    if borrows:
        options["_nrt"] = False

    def compiled(function: Callable[..., Any]) -> Any:
        entries: dict[str, Any] = {"no_cpython_wrapper": inner, "no_cfunc_wrapper": True}
        entries["pipeline_class"] = compiler(inner, short_loops)
        dispatcher: Any = numba.njit(**{**_FIXED_OPTIONS, **options, **entries})(function)
        if cache:
            dispatcher._cache = cache_of(dispatcher, inner)
        dispatcher.compile = _quickly(dispatcher)
        if inner:  # numba would take the entry that is not there
            dispatcher._insert = _nothing
            dispatcher._compile_for_args = functools.partial(_refused, function.__name__)
            dispatcher.called = lambda: dispatcher
            dispatcher.get_call_template = _without_numbers(dispatcher.get_call_template)
        else:

            @functools.cache
            def twin() -> Any:
                return njit(cache=cache, inner=True, **options)(function)

            dispatcher.called = twin
            dispatcher.get_call_template = lambda *arguments: twin().get_call_template(*arguments)
            dispatcher.get_overload = lambda signature: twin().get_overload(signature)
        return dispatcher

    return compiled


def _without_numbers(call_template: Callable[..., Any]) -> Callable[..., Any]:
    """A dispatcher's get_call_template, for any numbers of the arguments' types."""

    def plain(kind: Any) -> Any:
        return numba.types.unliteral(kind) if isinstance(kind, _NUMBERS) else kind

    def run(arguments: Any, keywords: Any) -> Any:
        named = {name: plain(kind) for name, kind in keywords.items()}
        return call_template(tuple(map(plain, arguments)), named)

    return run


def _quickly(dispatcher: Any) -> Callable[[Any], Any]:
    """The dispatcher's compile in less time. The code then learns the environments of inner functions."""
    compile_ = dispatcher.compile

    @functools.wraps(compile_)
    def run(signature: Any) -> Any:
        arguments = tuple(normalize_signature(signature)[0])
        if (known := dispatcher.overloads.get(arguments)) is not None:
            return known.entry_point
        with global_compiler_lock, _turn(dispatcher, signature), in_less_time(), into(InnerLibrary):
            missed = sum(dispatcher.stats.cache_misses.values())
            entry = compile_(signature)
            if sum(dispatcher.stats.cache_misses.values()) == missed:
                let_age()
        library = dispatcher.overloads[arguments].library
        for held in library._final_module.global_variables:
            if held.name.startswith(_ENVIRONMENT) and (found := lookup_environment(held.name)) is not None:
                library.codegen.set_env(held.name, found)
        return entry

    return run


@contextmanager
def _turn(dispatcher: Any, signature: Any) -> Iterator[None]:
    """While one process compiles a function, the others wait for what it keeps."""
    cache = dispatcher._cache
    if not isinstance(cache, KernelCache):
        yield
        return
    with turn(cache.cache_path, cache.number(signature, dispatcher.targetctx.codegen())):
        yield


def _nothing(*_: Any) -> None:
    pass


def _refused(name: str, *_: Any, **__: Any) -> None:
    raise TypeError(f"{name} is for compiled functions: it was compiled without an entry from Python")
