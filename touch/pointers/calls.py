"""Functions handed to compiled code as addresses, which are not compiled into their callers once more."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types  # pyright: ignore[reportPrivateImportUsage]
from numba.core import cgutils
from numba.extending import intrinsic


def entry(kernel: Any, arguments: int) -> int:
    """The address of a compiled function of one, two or four integers that returns one, for `called_one`, `called_two`
    and `called`."""
    kinds = (types.int64,) * arguments
    kernel.compile(kinds)
    compiled = kernel.overloads[kinds]
    return compiled.library.get_pointer_to_function(compiled.fndesc.mangled_name)


def _called_one(context, address, first):
    return types.int64(types.int64, types.int64), _call


def _called_two(context, address, first, second):
    return types.int64(types.int64, types.int64, types.int64), _call


def _called(context, address, first, second, third, fourth):
    return types.int64(*[types.int64] * 5), _call


def _call(context, builder, signature, arguments):
    kinds = signature.args[1:]
    kind = context.call_conv.get_function_type(types.int64, kinds)
    function = builder.inttoptr(arguments[0], kind.as_pointer())
    status, found = context.call_conv.call_function(builder, function, types.int64, kinds, arguments[1:])
    with cgutils.if_unlikely(builder, status.is_error):
        context.call_conv.return_status_propagate(builder, status)
    return found


def _asked(context, address, number):
    return types.int64(types.int64, types.int64), _ask


def _ask(context, builder, signature, arguments):
    word = ir.IntType(64)
    function = builder.inttoptr(arguments[0], ir.FunctionType(word, [word]).as_pointer())
    return builder.call(function, [arguments[1]])


called_one: Any = intrinsic(_called_one)
called_two: Any = intrinsic(_called_two)
called: Any = intrinsic(_called)
"""What the function at an address returns of one, two or four integers."""
asked: Any = intrinsic(_asked)
"""What Python's function at an address, ctypes.CFUNCTYPE(c_int64, c_int64), returns of a number."""
