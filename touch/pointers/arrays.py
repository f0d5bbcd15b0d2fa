"""Arrays handed to compiled code as addresses: a table of a dozen is there in a fraction of the time that the arrays
themselves take, each of which numba takes apart at every call."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numba import from_dtype, types  # pyright: ignore[reportPrivateImportUsage]
from numba.core import cgutils
from numba.extending import intrinsic
from numba.np.arrayobj import populate_array

from ...thermal import CONTACT_LAW
from ...thermal.contact import FOOTPRINT_LAW
from ...thermal.readout import CHAIN_NUMBERS

_LAW, _FOOTPRINT, _CHAIN = (from_dtype(each) for each in (CONTACT_LAW, FOOTPRINT_LAW, CHAIN_NUMBERS))


def table(arrays: Sequence[np.ndarray], numbers: Sequence[int] = ()) -> np.ndarray:
    """The addresses of contiguous arrays, and numbers behind them. It holds as long as the arrays live. Raises
    ValueError for an array whose numbers do not stand in rows one behind the other: compiled code would read others."""
    for number, array in enumerate(arrays):
        if not array.flags.c_contiguous:
            raise ValueError(
                f"array {number} of {array.shape} has strides {array.strides}: hand over a copy in rows"
            )
    return np.array([*(array.ctypes.data for array in arrays), *numbers], np.int64)


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


floats: Any = intrinsic(_floats)
integers: Any = intrinsic(_integers)
words: Any = intrinsic(_words)
flags: Any = intrinsic(_flags)
laws: Any = intrinsic(_laws)
footprints: Any = intrinsic(_footprints)
chains: Any = intrinsic(_chains)
"""The array of a shape that begins at an address: of floating-point numbers, of integers of 32 and 64 bits, of
booleans, of CONTACT_LAW, of FOOTPRINT_LAW and of CHAIN_NUMBERS."""
