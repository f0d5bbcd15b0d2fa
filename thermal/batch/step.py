"""The thermal step of many grasps as a pure function of arrays: NumPy, PyTorch, JAX.

What batch.py's compiled kernel computes, to round-off, without a branch on data, a write in place or a shape that
depends on a value: it can be traced, compiled, vectorised and differentiated. It uses products and sums alone, so no
setting that lets matrix products be taken in TF32 or bfloat16 coarsens it, and no complex numbers, which compilers of
tensor programs hardly know.

The M x M systems of each pole pair are eliminated in the order of the ports, one port at a time. With t = h/(1 + h g),
a port's conductance in series with the bodies behind it,

    g_kl <- g_kl - g_kj t_j g_jl,    v_k <- v_k - g_kj t_j v_j,    y_j = t_j (v_j - sum_{l > j} g_jl y_l)

keeps g symmetric, needs no division by h, gives exactly no flow where h = 0, and has no large numbers where h is large.
It needs no pivoting: the poles lie within 102 degrees of the positive axis, so the numerical range of g, of its Schur
complements too, lies in the sector from -102 degrees to 0, and |1 + h g| >= sin 102 degrees for any h.

B: rows (leading axes; none is allowed too), F: fingertips, P: modes of a contact, M = F P: ports, K: states, Q: pole
pairs.
"""

from __future__ import annotations

import numpy as np

from thermograsp.errors import InvalidValueError

from ..numerics import Array, as_like, namespace_of
from .rows import HeatReading
from .tables import ArrayTables

_Complex = tuple[Array, Array]


def array_step(
    tables: ArrayTables,
    network: Array | int,
    state: Array,
    conductance: Array,
    difference: Array,
    mutual: Array | None = None,
) -> tuple[Array, HeatReading]:
    """State (B, K) after one step, and what is read then; the readings have no axis of samples: drop (B, F) and so on.

    tables: array_tables. network: (B,) integers, which of the tables' networks; or one int for all rows. state: (B, K),
    zeros where everything is at its first temperature. conductance: (B, F) W/K of each contact, constant over the
    step, >= 0; 0 where nothing touches. difference: (B, F) K, what sensor less object was when both were uniform.
    mutual: (B, F, F) K/W, symmetric, what the even flow of one contact does against that of another.
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
    xp, system = namespace_of(state), 2 * ports * pairs
    heard = (state[..., None] * hear).sum(-2)
    rows = heard.shape[:-1]
    real, imag = (
        heard[..., c * system // 2 : (c + 1) * system // 2].reshape((*rows, fingertips, modes, pairs))
        for c in range(2)
    )
    even = difference[..., None, None] - real[..., :1, :]
    drive = (
        xp.concatenate((even, -real[..., 1:, :]), -2).reshape((*rows, ports, pairs)),
        -imag.reshape((*rows, ports, pairs)),
    )
    contact = xp.broadcast_to(conductance[..., None], (*rows, fingertips, modes)).reshape((*rows, ports, 1))
    bodies = gram[..., 0, :, :, :], gram[..., 1, :, :, :]
    if mutual is not None:
        even = as_like(np.eye(1, modes)[0], mutual)
        between = mutual[..., :, None, :, None] * even[:, None, None] * even
        bodies = bodies[0] + between.reshape((*mutual.shape[:-2], ports, ports, 1)), bodies[1]
    flows = xp.stack(_flows(contact, bodies, drive), -3)
    pushed = (
        flows.reshape((*rows, system, 1)) * push.reshape((*push.shape[:-4], system, push.shape[-1]))
    ).sum(-2)

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


def _flows(contact: Array, bodies: _Complex, drive: _Complex) -> _Complex:
    """y (..., M, Q) of (1 + H g) y = H v: the first port is eliminated, the others are solved for, it follows.

    contact: h (..., M, 1). bodies: g (..., M, M, Q). drive: v (..., M, Q).
    """
    if not contact.shape[-2]:
        return drive
    row, v = _part(bodies, (0, slice(1, None))), _part(drive, (slice(None, 1),))
    series = _in_series(contact[..., :1, :], _part(bodies, (0, slice(None, 1))))
    factor = _times(series, row)
    across = _times(_part(factor, (slice(None), None)), _part(row, (None, slice(None))))
    left = _minus(_part(bodies, (slice(1, None), slice(1, None))), across)
    later = _flows(contact[..., 1:, :], left, _minus(_part(drive, (slice(1, None),)), _times(factor, v)))
    back = _times(factor, later)
    first = _minus(_times(series, v), (back[0].sum(-2)[..., None, :], back[1].sum(-2)[..., None, :]))
    xp = namespace_of(contact)
    return xp.concatenate((first[0], later[0]), -2), xp.concatenate((first[1], later[1]), -2)


def _part(values: _Complex, at: tuple[int | slice | None, ...]) -> _Complex:
    """Of both parts, what stands there along the axes before the pole pairs'."""
    return values[0][(..., *at, slice(None))], values[1][(..., *at, slice(None))]


def _in_series(conductance: Array, g: _Complex) -> _Complex:
    """h/(1 + h g)."""
    real, imag = 1 + conductance * g[0], conductance * g[1]
    ratio = conductance / (real * real + imag * imag)
    return real * ratio, -imag * ratio


def _times(a: _Complex, b: _Complex) -> _Complex:
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


def _minus(a: _Complex, b: _Complex) -> _Complex:
    return a[0] - b[0], a[1] - b[1]
