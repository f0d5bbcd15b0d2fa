"""What numba makes of elements of arrays, of loops over a range and of variables that are not used any more, in fewer
instructions: to compile takes as long as there are instructions, and most of ours were of these. What they do is the
same, to the last bit."""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.base import BaseContext
from numba.core.imputils import impl_ret_borrowed
from numba.core.lowering import Lower
from numba.np.arrayobj import load_item, store_item

_FUNCTION, _DELETED = BaseContext.get_function, Lower.delvar
_STEPS = types.range_state64_type


def function(self: Any, fn: Any, sig: Any, _firstcall: bool = True) -> Any:
    """BaseContext.get_function, which says how a function is told in instructions."""
    key = getattr(fn, "typing_key", fn)
    known = _KNOWN.get(key) if isinstance(key, str) or callable(key) else None
    make = None if known is None else known(self, sig.args)
    if make is None:
        return _FUNCTION(self, fn, sig, _firstcall)
    return lambda builder, args, loc=None: make(self, builder, sig, args)


def deleted(self: Any, name: str) -> None:
    """Lower.delvar, which forgets a variable. One that nobody counts is left as it is."""
    kind = self.typeof(name)
    if self.context.enable_nrt and self.context.data_model_manager[kind].contains_nrt_meminfo():
        _DELETED(self, name)
        return
    if name not in self._blk_local_varmap and not self._disable_sroa_like_opt:
        self._singly_assigned_vars.discard(name)
    self._alloca_var(name, kind)


def _of_range(make: Any) -> Callable[[Any, Any], Any]:
    """Takes loops over int64."""

    def known(context: Any, args: Any) -> Any:
        return make if args[0] in (_STEPS, types.range_iter64_type) else None

    return known


def _of_element(make: Any, values: int) -> Callable[[Any, Any], Any]:
    """Takes indices that are all integers, into arrays whose axes lie one behind the other or have strides."""

    def known(context: Any, args: Any) -> Any:
        array, index = args[0], args[1]
        if type(array) is not types.Array or array.layout not in "CA" or context.enable_boundscheck:
            return None
        kinds = _kinds(index)
        if not 0 < len(kinds) <= array.ndim or not all(isinstance(kind, types.Integer) for kind in kinds):
            return None
        whole = len(kinds) == array.ndim and isinstance(array.dtype, types.Number)
        # what is put is a number
        serves = whole and isinstance(args[2], types.Number) if values else whole or len(kinds) < array.ndim
        return make if serves else None

    return known


def _kinds(index: Any) -> tuple[Any, ...]:
    return tuple(index.types) if isinstance(index, types.BaseTuple) else (index,)


def _begun(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    """An iterator at a range's start, with how many numbers are to come. A step is not 0."""
    start, stop, step = (builder.extract_value(args[0], i) for i in range(3))
    zero, one = ir.Constant(start.type, 0), ir.Constant(start.type, 1)
    up = builder.icmp_signed(">", step, zero)
    far = builder.select(up, builder.sub(stop, start), builder.sub(start, stop))
    size = builder.select(up, step, builder.neg(step))
    count = builder.add(builder.sdiv(builder.sub(far, one), size), one)
    count = builder.select(builder.icmp_signed(">", far, zero), count, zero)
    found = ir.Constant(context.get_value_type(sig.return_type), ir.Undefined)
    for place, part in enumerate((_kept(builder, start), stop, step, _kept(builder, count))):
        found = builder.insert_value(found, part, place)
    return found


def _kept(builder: Any, value: Any) -> Any:
    at = cgutils.alloca_once(builder, value.type)
    builder.store(value, at)
    return at


def _next(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    """The next number and whether there is one. It counts on behind the last, which nobody looks at."""
    at, _, step, counted = (builder.extract_value(args[0], i) for i in range(4))
    number, count = builder.load(at), builder.load(counted)
    builder.store(builder.sub(count, ir.Constant(count.type, 1), flags=["nsw"]), counted)
    builder.store(builder.add(number, step), at)
    found = ir.Constant(context.get_value_type(sig.return_type), ir.Undefined)
    found = builder.insert_value(found, number, 0)
    return builder.insert_value(found, builder.icmp_signed(">", count, ir.Constant(count.type, 0)), 1)


def _taken(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    """An element, or the part of an array that has the first few indices."""
    kind, (array, index) = sig.args[0], args
    at = _address(context, builder, kind, array, sig.args[1], index)
    if not isinstance(sig.return_type, types.Array):
        return load_item(context, builder, kind, at)
    model, made = (context.data_model_manager[each] for each in (kind, sig.return_type))
    found = ir.Constant(made.get_value_type(), ir.Undefined)
    for name in ("meminfo", "parent", "itemsize"):
        found = made.set(builder, found, model.get(builder, array, name), name)
    first, count = len(_kinds(sig.args[1])), context.get_constant(types.intp, 1)
    for name in ("shape", "strides"):
        place = model.get_field_position(name)
        for axis in range(first, kind.ndim):
            part = builder.extract_value(array, (place, axis))
            found = builder.insert_value(found, part, (made.get_field_position(name), axis - first))
            count = builder.mul(count, part, flags=["nsw"]) if name == "shape" else count
    found = made.set(builder, made.set(builder, found, count, "nitems"), at, "data")
    return impl_ret_borrowed(context, builder, sig.return_type, found)


def _put(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    """An element's new number."""
    kind, index, given = sig.args
    at = _address(context, builder, kind, args[0], index, args[1])
    store_item(context, builder, kind, context.cast(builder, args[2], given, kind.dtype), at)
    return context.get_dummy_value()


def _address(context: Any, builder: Any, kind: Any, array: Any, index: Any, value: Any) -> Any:
    """Of what has these first indices."""
    model, whole = context.data_model_manager[kind], isinstance(index, types.BaseTuple)
    shape, strides = (model.get_field_position(name) for name in ("shape", "strides"))
    offset: Any = None
    for axis, of in enumerate(_kinds(index)):
        place = builder.extract_value(value, axis) if whole else value
        place = context.cast(builder, place, of, types.intp if of.signed else types.uintp)
        if of.signed and not isinstance(place, ir.Constant):
            size = builder.extract_value(array, (shape, axis))
            behind = builder.icmp_signed("<", place, ir.Constant(place.type, 0))
            place = builder.select(behind, builder.add(place, size), place)
        elif isinstance(place, ir.Constant) and place.constant < 0:
            place = builder.add(place, builder.extract_value(array, (shape, axis)))
        if kind.layout != "C":
            place = builder.mul(place, builder.extract_value(array, (strides, axis)))
        elif offset is not None:
            offset = builder.mul(offset, builder.extract_value(array, (shape, axis)))
        offset = place if offset is None else builder.add(offset, place)
    data = model.get(builder, array, "data")
    if kind.layout != "C":
        return cgutils.pointer_add(builder, data, offset)
    for axis in range(len(_kinds(index)), kind.ndim):
        offset = builder.mul(offset, builder.extract_value(array, (shape, axis)))
    return builder.gep(data, [offset])


_KNOWN: dict[Any, Callable[[Any, Any], Any]] = {
    "getiter": _of_range(_begun),
    "iternext": _of_range(_next),
    operator.getitem: _of_element(_taken, 0),
    operator.setitem: _of_element(_put, 1),
}
