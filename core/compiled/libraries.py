"""Libraries of machine code: what only compiled code calls is compiled into its callers; loops may stay as they are."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, cast

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.registry import cpu_target


class InnerLibrary(JITCodeLibrary):
    """Code that is compiled into its callers' only: with them it is optimised and becomes machine code."""

    @property
    def codegen(self) -> Any:
        """Without an engine, where numba would note the function's environment: its callers' code holds that too."""
        return _NoEngine

    def serialize_using_object_code(self) -> Any:
        return self.serialize_using_bitcode()

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True


class _ShortLoopsLibrary(JITCodeLibrary):
    """Code whose loops take one element after the other. Of an inner loop over three coordinates LLVM would make two
    versions, of which the one for many elements never runs."""

    def _optimize_final_module(self) -> None:
        made = self._codegen._module_pass_manager(loop_vectorize=False)
        passes, *builder = made if isinstance(made, tuple) else (made,)  # numba 0.61 makes no builder
        passes.run(self._final_module, *builder)


class _NoEngine:
    @staticmethod
    def set_env(name: str, environment: Any) -> None:
        pass


class _InnerCompiler(Compiler):
    """numba's, into an InnerLibrary."""

    _library: type[JITCodeLibrary] = InnerLibrary

    def __init__(self, typingctx: Any, targetctx: Any, library: Any, *rest: Any) -> None:
        library = self._library(targetctx.codegen(), self._library.__name__)
        library.enable_object_caching()
        super().__init__(typingctx, targetctx, library, *rest)


class _OuterCompiler(_InnerCompiler):
    """numba's, into a library that Python can call."""

    _library = JITCodeLibrary


class _ShortLoopsCompiler(_InnerCompiler):
    """numba's, into a library that Python can call and whose loops are left as they are."""

    _library = _ShortLoopsLibrary


def compiler(inner: bool, short_loops: bool) -> type[Compiler]:
    """numba's, into the library of such a function (see njit)."""
    return _InnerCompiler if inner else _ShortLoopsCompiler if short_loops else _OuterCompiler


@contextmanager
def into(library: type[JITCodeLibrary]) -> Iterator[None]:
    """While it lasts, numba makes libraries of that kind, also of its own functions, which only compiled code calls."""
    codegen = cast(Any, cpu_target.target_context).codegen()
    before, codegen._library_class = codegen._library_class, library
    try:
        yield
    finally:
        codegen._library_class = before
