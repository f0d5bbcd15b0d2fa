"""Arrays handed to compiled code as addresses: a table of a dozen is there in a fraction of the time that the arrays
themselves take, each of which numba takes apart at every call."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from llvmlite import ir
from numba import from_dtype, types  # pyright: ignore[reportPrivateImportUsage]
from numba.core import cgutils
from numba.extending import intrinsic
from numba.np.arrayobj import populate_array

from ..thermal import CONTACT_LAW
from ..thermal.contact import FOOTPRINT_LAW
from ..thermal.readout import CHAIN_NUMBERS

_LAW, _FOOTPRINT, _CHAIN = (from_dtype(each) for each in (CONTACT_LAW, FOOTPRINT_LAW, CHAIN_NUMBERS))


def table(arrays: Sequence[np.ndarray], numbers: Sequence[int] = ()) -> np.ndarray:
    """The addresses of contiguous arrays, and numbers behind them. It holds as long as the arrays live."""
    return np.array([*(array.ctypes.data for array in arrays), *numbers], np.int64)


def entry(kernel: Any, arguments: int) -> int:
    """The address of a compiled function of one, two or four integers that returns one, for `called_one`, `called_two`
    and `called`."""
    kinds = (types.int64,) * arguments
    kernel.compile(kinds)
    compiled = kernel.overloads[kinds]
    return compiled.library.get_pointer_to_function(compiled.fndesc.mangled_name)


def _floats(context, address, shape):
    return _array(types.float64, address, shape), _made


def _integers(context, address, shape):
    return _array(types.int32, address, shape), _made


def _words(context, address, shape):
    return _array(types.int64, address, shape), _made


def _flags(context, address, shape):
    return _array(types.boolean, address, shape), _made


def _laws(context, address, shape):
    return _array(_LAW, address, shape), _made


def _footprints(context, address, shape):
    return _array(_FOOTPRINT, address, shape), _made


def _chains(context, address, shape):
    return _array(_CHAIN, address, shape), _made


def _array(kind: types.Type, address: types.Type, shape: Any) -> Any:
    return types.Array(kind, getattr(shape, "count", 1), "C")(address, shape)


def _made(context, builder, signature, arguments):
    """An array that nobody counts, in a tenth of the code of numba.carray."""
    kind, (address, shape) = signature.return_type, arguments
    sizes = cgutils.unpack_tuple(builder, shape) if kind.ndim > 1 else [shape]
    kinds = signature.args[1].types if kind.ndim > 1 else [signature.args[1]]
    sizes = [context.cast(builder, size, of, types.intp) for size, of in zip(sizes, kinds, strict=True)]
    array = context.make_array(kind)(context, builder)
    item = context.get_constant(types.intp, context.get_abi_sizeof(context.get_data_type(kind.dtype)))
    strides = [item]
    for size in sizes[:0:-1]:
        strides.insert(0, builder.mul(strides[0], size))
    at = builder.inttoptr(address, array.data.type)
    populate_array(array, data=at, shape=sizes, strides=strides, itemsize=item, meminfo=None)
    return array._getvalue()


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


floats: Any = intrinsic(_floats)
integers: Any = intrinsic(_integers)
words: Any = intrinsic(_words)
flags: Any = intrinsic(_flags)
laws: Any = intrinsic(_laws)
footprints: Any = intrinsic(_footprints)
chains: Any = intrinsic(_chains)
"""The array of a shape that begins at an address: of floating-point numbers, of integers of 32 and 64 bits, of
booleans, of CONTACT_LAW, of FOOTPRINT_LAW and of CHAIN_NUMBERS."""
called_one: Any = intrinsic(_called_one)
called_two: Any = intrinsic(_called_two)
called: Any = intrinsic(_called)
"""What the function at an address returns of one, two or four integers. It is not compiled into its caller once
more."""
asked: Any = intrinsic(_asked)
"""What Python's function at an address, ctypes.CFUNCTYPE(c_int64, c_int64), returns of a number."""
