"""Numbers of contiguous arrays taken four at once in compiled code, where the compiler would not do so by itself: loops
of four it unrolls first. The bits are those of one number after the other, save that a product and a sum may round
once.

Complex lanes are four real parts with four imaginary ones behind them.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from thermograsp.compiled import njit

LANES = 4
_ONCE = ("contract",)


def _put(typingctx, out, i, a, j):
    """out[i:i + 4] = a[j:j + 4]"""

    def code(context, builder, signature, values):
        to, first = (_place(context, builder, signature, values, n) for n in (0, 2))
        _store(builder, _load(builder, first), to)
        return context.get_dummy_value()

    return types.void(out, i, a, j), code


def _put_sum(typingctx, out, i, a, j, stride, factors, k, count):
    """out[i:i + 4] is the sum over n < count of factors[k + n] times the four of a at j + n stride."""

    def code(context, builder, signature, values):
        to, first, factor = (_place(context, builder, signature, values, n) for n in (0, 2, 5))
        one = ir.Constant(values[4].type, 1)
        _store(builder, _sum(builder, _zeros(), first, values[4], factor, one, values[7]), to)
        return context.get_dummy_value()

    return types.void(out, i, a, j, stride, factors, k, count), code


def _add_sum(typingctx, out, i, a, j, stride, factors, k, ahead, count):
    """out[i:i + 4] += the sum over n < count of factors[k + n ahead] times the four of a at j + n stride."""

    def code(context, builder, signature, values):
        to, first, factor = (_place(context, builder, signature, values, n) for n in (0, 2, 5))
        total = _sum(builder, _load(builder, to), first, values[4], factor, values[7], values[8])
        _store(builder, total, to)
        return context.get_dummy_value()

    return types.void(out, i, a, j, stride, factors, k, ahead, count), code


def _sum(builder: Any, begun: Any, first: Any, stride: Any, factor: Any, ahead: Any, count: Any) -> Any:
    """What has begun and the sum behind it."""
    total = cgutils.alloca_once_value(builder, begun)
    with cgutils.for_range(builder, count) as loop:
        lane = _load(builder, _ahead(builder, first, builder.mul(loop.index, stride)))
        number = builder.load(_number(builder, _ahead(builder, factor, builder.mul(loop.index, ahead))))
        product = builder.fmul(lane, _spread(builder, number), flags=_ONCE)
        builder.store(builder.fadd(builder.load(total), product, flags=_ONCE), total)
    return builder.load(total)


def _put_next(typingctx, out, i, a, rows, k, factors, f, count):
    """out[i:i + 4] becomes the sum over n < count of factors[f + n] times row rows[k + n] of a, whose rows are four
    numbers, less what it was."""

    def code(context, builder, signature, values):
        to, factor = (_place(context, builder, signature, values, n) for n in (0, 5))
        first, row = (context.make_array(signature.args[n])(context, builder, values[n]).data for n in (2, 3))
        row, lanes = builder.gep(row, [values[4]]), ir.Constant(values[4].type, LANES)
        total = cgutils.alloca_once_value(builder, builder.fneg(_load(builder, to)))
        with cgutils.for_range(builder, values[7]) as loop:
            number = builder.sext(builder.load(builder.gep(row, [loop.index])), lanes.type)
            lane = _load(builder, _ahead(builder, first, builder.mul(number, lanes)))
            share = builder.load(_number(builder, _ahead(builder, factor, loop.index)))
            product = builder.fmul(lane, _spread(builder, share), flags=_ONCE)
            builder.store(builder.fadd(builder.load(total), product, flags=_ONCE), total)
        _store(builder, builder.load(total), to)
        return context.get_dummy_value()

    return types.void(out, i, a, rows, k, factors, f, count), code


def _add_products(typingctx, out, i, a, j, b, k, stride, count):
    """out[i:i + 4] += the sum over n < count of the four of a at j + n stride times those of b at k + n stride."""
    return types.void(out, i, a, j, b, k, stride, count), _products("fadd")


def _take_products(typingctx, out, i, a, j, b, k, stride, count):
    """The same, taken from them."""
    return types.void(out, i, a, j, b, k, stride, count), _products("fsub")


def _products(join: str) -> Any:
    """Joins products to what stands there, each by that instruction."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        to, first, second = (_place(context, builder, signature, values, n) for n in (0, 2, 4))
        total = cgutils.alloca_once_value(builder, _load(builder, to))
        with cgutils.for_range(builder, values[7]) as loop:
            at = builder.mul(loop.index, values[6])
            one, other = (_load(builder, _ahead(builder, place, at)) for place in (first, second))
            product = builder.fmul(one, other, flags=_ONCE)
            builder.store(getattr(builder, join)(builder.load(total), product, flags=_ONCE), total)
        _store(builder, builder.load(total), to)
        return context.get_dummy_value()

    return code


def _dot(typingctx, a, i, b, j, count):
    """The sum of a[i:i + 4 count] b[j:j + 4 count], lane by lane, then of the lanes."""

    def code(context, builder, signature, values):
        first, second = (_place(context, builder, signature, values, n) for n in (0, 2))
        total = cgutils.alloca_once_value(builder, _zeros())
        with cgutils.for_range(builder, values[4]) as loop:
            at = builder.mul(loop.index, ir.Constant(loop.index.type, LANES))
            one, other = (_load(builder, _ahead(builder, place, at)) for place in (first, second))
            product = builder.fmul(one, other, flags=_ONCE)
            builder.store(builder.fadd(builder.load(total), product, flags=_ONCE), total)
        both = builder.load(total)
        one, two, three, four = (
            builder.extract_element(both, ir.Constant(ir.IntType(32), n)) for n in range(LANES)
        )
        return builder.fadd(builder.fadd(one, two), builder.fadd(three, four))

    return types.float64(a, i, b, j, count), code


def _put_product(typingctx, out, i, a, j, b, k):
    """Complex lanes: out at i is a at j times b at k."""

    def code(context, builder, signature, values):
        real, imag = _product(builder, *_operands(context, builder, signature, values))
        _store_complex(builder, _place(context, builder, signature, values, 0), real, imag)
        return context.get_dummy_value()

    return types.void(out, i, a, j, b, k), code


def _take_product(typingctx, out, i, a, j, b, k):
    """Complex lanes: out at i less a at j times b at k."""

    def code(context, builder, signature, values):
        real, imag = _product(builder, *_operands(context, builder, signature, values))
        to = _place(context, builder, signature, values, 0)
        had_real, had_imag = _complex(builder, to)
        _store_complex(
            builder,
            to,
            builder.fsub(had_real, real, flags=_ONCE),
            builder.fsub(had_imag, imag, flags=_ONCE),
        )
        return context.get_dummy_value()

    return types.void(out, i, a, j, b, k), code


def _rotate(typingctx, a, i, ahead, j, other_ahead, cosine, k, sine, m, count):
    """Of `count` fours of a from i on, each so many numbers ahead of the last, and as many from j on: the first by the
    cosines at k less the second by the sines at m, and the first by the sines with the second by the cosines."""

    def code(context, builder, signature, values):
        first = _place(context, builder, signature, values, 0)
        second = _place(context, builder, signature, (values[0], *values[3:]), 0)
        by = [_load(builder, _place(context, builder, signature, values, n)) for n in (5, 7)]
        with cgutils.for_range(builder, values[9]) as loop:
            places = [
                _ahead(builder, place, builder.mul(loop.index, step))
                for place, step in ((first, values[2]), (second, values[4]))
            ]
            one, other = (_load(builder, place) for place in places)
            (real, imag), (less, more) = ([builder.fmul(each, part) for part in by] for each in (one, other))
            _store(builder, builder.fsub(real, more, flags=_ONCE), places[0])
            _store(builder, builder.fadd(imag, less, flags=_ONCE), places[1])
        return context.get_dummy_value()

    return types.void(a, i, ahead, j, other_ahead, cosine, k, sine, m, count), code


def _invert(typingctx, out, i):
    """Complex lanes: out at i is its inverse."""

    def code(context, builder, signature, values):
        at = _place(context, builder, signature, values, 0)
        real, imag = _complex(builder, at)
        squares = (builder.fmul(part, part, flags=_ONCE) for part in (real, imag))
        size = builder.fdiv(ir.Constant(_four(), [1.0] * LANES), builder.fadd(*squares, flags=_ONCE))
        _store_complex(builder, at, builder.fmul(real, size), builder.fmul(builder.fneg(imag), size))
        return context.get_dummy_value()

    return types.void(out, i), code


def _zeros() -> Any:
    return ir.Constant(_four(), [0.0] * LANES)


def _number(builder: Any, place: Any) -> Any:
    """A pointer to the first of four numbers."""
    return builder.bitcast(place, ir.DoubleType().as_pointer())


def _ahead(builder: Any, place: Any, numbers: Any) -> Any:
    """A pointer to the four that are so many numbers ahead of a place."""
    return builder.bitcast(builder.gep(_number(builder, place), [numbers]), _four().as_pointer())


def _four() -> Any:
    return ir.VectorType(ir.DoubleType(), LANES)


def _place(context: Any, builder: Any, signature: Any, values: Any, number: int) -> Any:
    """A pointer to where the array of that number and the index behind it say."""
    kind, array = signature.args[number], values[number]
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [values[number + 1]]), _four().as_pointer())


def _load(builder: Any, place: Any) -> Any:
    return builder.load(place, align=8)


def _store(builder: Any, value: Any, place: Any) -> None:
    builder.store(value, place, align=8)


def _complex(builder: Any, place: Any) -> tuple[Any, Any]:
    return _load(builder, place), _load(builder, _behind(builder, place))


def _store_complex(builder: Any, place: Any, real: Any, imag: Any) -> None:
    _store(builder, real, place)
    _store(builder, imag, _behind(builder, place))


def _behind(builder: Any, place: Any) -> Any:
    return builder.gep(place, [ir.Constant(ir.IntType(64), 1)])


def _spread(builder: Any, number: Any) -> Any:
    one = builder.insert_element(_zeros(), number, ir.Constant(ir.IntType(32), 0))
    return builder.shuffle_vector(
        one, _zeros(), ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
    )


def _operands(context: Any, builder: Any, signature: Any, values: Any) -> tuple[Any, ...]:
    """Real and imaginary parts of a and b."""
    return tuple(
        part for n in (2, 4) for part in _complex(builder, _place(context, builder, signature, values, n))
    )


def _product(builder: Any, real: Any, imag: Any, other_real: Any, other_imag: Any) -> tuple[Any, Any]:
    def both(join: Any, one: Any, two: Any, three: Any, four: Any) -> Any:
        first, second = builder.fmul(one, two, flags=_ONCE), builder.fmul(three, four, flags=_ONCE)
        return join(first, second, flags=_ONCE)

    return (
        both(builder.fsub, real, other_real, imag, other_imag),
        both(builder.fadd, real, other_imag, imag, other_real),
    )


put: Any = intrinsic(_put)
put_sum: Any = intrinsic(_put_sum)
add_sum: Any = intrinsic(_add_sum)
put_next: Any = intrinsic(_put_next)
add_products: Any = intrinsic(_add_products)
take_products: Any = intrinsic(_take_products)
dot: Any = intrinsic(_dot)
put_product: Any = intrinsic(_put_product)
take_product: Any = intrinsic(_take_product)
rotate: Any = intrinsic(_rotate)
invert: Any = intrinsic(_invert)


@njit(cache=True, inner=True, borrows=True, error_model="numpy", forceinline=True)
def solve_symmetric(matrix, row, solved, factors, m):
    """Solves matrix x = solved for four complex lanes at once, in place, without pivoting: the matrix is symmetric, of
    which the upper half is looked at, and its numerical range lies in a half plane (thermal/batch/step.py). matrix: the
    leading m of each of its rows, which are so many numbers apart. solved, factors: (m,) complex lanes."""
    one = 2 * LANES
    for c in range(m):
        pivot = c * row + c * one
        invert(matrix, pivot)
        for r in range(c + 1, m):
            put_product(factors, r * one, matrix, c * row + r * one, matrix, pivot)
            for s in range(r, m):
                take_product(matrix, r * row + s * one, factors, r * one, matrix, c * row + s * one)
            take_product(solved, r * one, factors, r * one, solved, c * one)
    for c in range(m - 1, -1, -1):
        for s in range(c + 1, m):
            take_product(solved, c * one, matrix, c * row + s * one, solved, s * one)
        put_product(solved, c * one, solved, c * one, matrix, c * row + c * one)
