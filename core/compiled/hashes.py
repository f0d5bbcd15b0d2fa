"""A hash of all that is compiled into a function."""

from __future__ import annotations

import hashlib
import inspect
import types
from collections.abc import Iterator, Mapping
from typing import Any, cast

import numba
import numpy as np
from numba.core.dispatcher import Dispatcher
from numba.core.extending import _Intrinsic

from thermograsp.errors import InvalidValueError

_BELOW = ("numpy", "numba", "scipy")
"""Packages whose functions numba compiles in its own way: their names say it."""


def compiled_hash(kernel: Any) -> str:
    """Hash of all that is compiled into an njit function: its own code and options, what it calls, and the values
    that it refers to. Raises InvalidValueError where it refers to something whose value cannot be read."""
    total = hashlib.sha256()
    for piece in _pieces(kernel, set()):
        total.update(piece.encode() + b"\0")
    return total.hexdigest()


def _pieces(value: Any, seen: set[int]) -> Iterator[str]:
    """Text that differs where what is compiled differs. seen: functions that are already in it."""
    if isinstance(value, Dispatcher):
        yield f"compiler {cast(Any, value)._compiler.pipeline_class.__name__}"
        for name, option in sorted(value.targetoptions.items()):
            yield f"option {name}"
            yield from _pieces(option, seen)
        yield from _pieces(value.py_func, seen)
    elif callable(value) and (getattr(value, "__module__", None) or "").partition(".")[0] in _BELOW:
        yield f"name {value.__module__}.{getattr(value, '__qualname__', value)}"
    elif isinstance(value, types.FunctionType):
        yield f"function {value.__module__}.{value.__qualname__}"
        if id(value) not in seen:
            seen.add(id(value))
            yield from _function(value, seen)
    elif isinstance(value, _Intrinsic):
        yield "intrinsic"
        yield from _pieces(value._defn, seen)
    elif isinstance(value, np.ndarray) and value.dtype != object:
        content = hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()
        yield f"array {value.dtype.str} {value.shape} {content}"
    elif isinstance(value, tuple | list):
        yield f"{type(value).__name__} of {len(value)}"
        for one in value:
            yield from _pieces(one, seen)
    elif isinstance(value, frozenset | set):
        yield f"set {sorted(map(repr, value))}"
    elif isinstance(value, Mapping):
        for key in sorted(value, key=repr):
            yield f"key {key!r}"
            yield from _pieces(value[key], seen)
    elif isinstance(value, type):
        yield f"class {value.__module__}.{value.__qualname__} {getattr(value, '_fields', ())}"
    elif (
        value is None
        or value is Ellipsis
        or isinstance(value, int | float | complex | str | bytes | np.generic)
    ):
        yield f"{type(value).__name__} {value!r}"
    elif isinstance(value, np.dtype | numba.types.Type):
        yield f"type {value!r}"
    elif isinstance(value, types.BuiltinFunctionType | np.ufunc) or inspect.ismodule(value):
        yield f"name {value.__name__}"
    else:
        raise InvalidValueError(
            f"a compiled function cannot refer to {value!r} ({type(value).__name__}): nothing would show whether it "
            "has changed since the code was compiled; pass it as an argument"
        )


def _function(function: types.FunctionType, seen: set[int]) -> Iterator[str]:
    yield from _pieces(function.__defaults__, seen)
    for cell in function.__closure__ or ():
        yield from _pieces(cell.cell_contents, seen)
    for code in _codes(function.__code__):
        yield code.co_code.hex()
        yield repr((code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars, code.co_argcount))
        yield from _pieces([one for one in code.co_consts if not isinstance(one, types.CodeType)], seen)
        for name in code.co_names:
            if name not in function.__globals__:
                continue
            value = function.__globals__[name]
            yield f"global {name}"
            yield from _pieces(value, seen)
            if inspect.ismodule(value) and value.__name__.partition(".")[0] not in _BELOW:
                for attribute in code.co_names:
                    if hasattr(value, attribute):
                        yield f"attribute {attribute}"
                        yield from _pieces(getattr(value, attribute), seen)


def _codes(code: types.CodeType) -> Iterator[types.CodeType]:
    """A function's code and that of those defined in it."""
    yield code
    for one in code.co_consts:
        if isinstance(one, types.CodeType):
            yield from _codes(one)
