"""The thermal step of many grasps as a pure function of arrays: NumPy, PyTorch, JAX.

What batch.py's compiled kernel computes, to round-off, without a branch on data, a write in place or a shape that
depends on a value: it can be traced, compiled, vectorised and differentiated. It uses products and sums alone, so no
setting that lets matrix products be taken in TF32 or bfloat16 coarsens it, and no complex numbers, which compilers of
tensor programs hardly know.

The M x M systems of each pole pair are eliminated in the order of the ports, unrolled. With t = h/(1 + h g), a port's
conductance in series with the bodies behind it,

    g_kl <- g_kl - g_kj t_j g_jl,    v_k <- v_k - g_kj t_j v_j,    y_j = t_j (v_j - sum_{l > j} g_jl y_l)

keeps g symmetric, needs no division by h, gives exactly no flow where h = 0, and has no large numbers where h is large.
It needs no pivoting: the poles lie within 102 degrees of the positive axis, so the numerical range of g, of its Schur
complements too, lies in the sector from -102 degrees to 0, and |1 + h g| >= sin 102 degrees for any h.

B: rows (leading axes; none is allowed too), F: fingertips, P: modes of a contact, M = F P: ports, K: states, Q: pole
pairs.
"""

from __future__ import annotations

from functools import reduce
from operator import add

from thermograsp.errors import InvalidValueError

from ..numerics import Array
from .rows import HeatReading
from .tables import ArrayTables

_Complex = tuple[Array, Array]


def array_step(
    tables: ArrayTables, network: Array | int, state: Array, conductance: Array, difference: Array
) -> tuple[Array, HeatReading]:
    """State (B, K) after one step, and what is read then; the readings have no axis of samples: drop (B, F) and so on.

    tables: array_tables. network: (B,) integers, which of the tables' networks; or one int for all rows. state: (B, K),
    zeros where everything is at its first temperature. conductance: (B, F) W/K of each contact, constant over the
    step, >= 0; 0 where nothing touches. difference: (B, F) K, what sensor less object was when both were uniform.
    A value that is not finite makes its own row's results not finite. JAX takes the nearest network where there is none
    of that index. Raises InvalidValueError where conductance or difference are not those of the tables' fingertips.
    """
    decay, hear, gram, push, read, _ = (table[network] for table in tables)
    ports, pairs, fingertips = gram.shape[-2], gram.shape[-1], (read.shape[-1] - 1) // 4
    if not conductance.shape[-1] == difference.shape[-1] == fingertips:
        raise InvalidValueError(
            f"conductance and difference must end in an axis of {fingertips} fingertip(s), got shapes "
            f"{tuple(conductance.shape)} and {tuple(difference.shape)}"
        )
    modes = ports // fingertips
    heard = (state[..., None] * hear).sum(-2)
    drive = []
    for j in range(ports):
        real, imag = (heard[..., (c * ports + j) * pairs : (c * ports + j + 1) * pairs] for c in range(2))
        f, mode = divmod(j, modes)
        drive.append((difference[..., f, None] - real if mode == 0 else -real, -imag))
    contact = [conductance[..., j // modes, None] for j in range(ports)]
    bodies = [[(gram[..., 0, j, k, :], gram[..., 1, j, k, :]) for k in range(j, ports)] for j in range(ports)]
    flows = _flows(contact, bodies, drive)

    pushed = reduce(
        add,
        ((flows[j][c][..., None] * push[..., c, j, :, :]).sum(-2) for j in range(ports) for c in range(2)),
    )
    states = state.shape[-1]
    state = state + (decay * state + pushed[..., :states])
    rows = (state[..., None] * read).sum(-2)
    per_tip = [rows[..., i * fingertips : (i + 1) * fingertips] for i in range(4)]
    reading = HeatReading(
        drop=per_tip[0],
        element_heat=per_tip[1],
        object_heat=rows[..., -1],
        sensor_rise=per_tip[2],
        object_rise=per_tip[3],
        flow=pushed[..., states:-1],
        air_loss=heard[..., -1] + pushed[..., -1],
    )
    return state, reading


def array_forget(tables: ArrayTables, network: Array | int, state: Array, rows: Array) -> Array:
    """State (B, K) with the object of the given rows (B,) bool at its mean temperature throughout: what a touch at a
    new place finds. As batch.forget_field."""
    return state * (tables.settled[network] + (1 - tables.settled[network]) * ~rows[..., None])


def _flows(contact: list[Array], bodies: list[list[_Complex]], drive: list[_Complex]) -> list[_Complex]:
    """y of (1 + H g) y = H v: the first port is eliminated, the others are solved for, the first one follows.

    contact: h of each port. bodies: g, of each port the entries from the diagonal on. drive: v.
    """
    if not drive:
        return []
    (h, *contacts), ((diagonal, *row), *rows), (v, *others) = contact, bodies, drive
    series = _in_series(h, diagonal)
    factors = [_times(series, g) for g in row]
    left = [
        [_minus(g, _times(factor, across)) for g, across in zip(entries, row[k:], strict=True)]
        for k, (factor, entries) in enumerate(zip(factors, rows, strict=True))
    ]
    later = _flows(contacts, left, [_minus(w, _times(f, v)) for f, w in zip(factors, others, strict=True)])
    first = _times(series, v)
    for factor, flow in zip(factors, later, strict=True):
        first = _minus(first, _times(factor, flow))
    return [first, *later]


def _in_series(conductance: Array, g: _Complex) -> _Complex:
    """h/(1 + h g)."""
    real, imag = 1 + conductance * g[0], conductance * g[1]
    ratio = conductance / (real * real + imag * imag)
    return real * ratio, -imag * ratio


def _times(a: _Complex, b: _Complex) -> _Complex:
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


def _minus(a: _Complex, b: _Complex) -> _Complex:
    return a[0] - b[0], a[1] - b[1]
