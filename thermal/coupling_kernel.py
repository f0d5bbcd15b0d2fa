"""The step of coupling.py compiled row by row: a row's result does not depend on how many rows there are.

States of the object come first and see every contact port; then each fingertip's own, which see only its own ports.
Sums may be reassociated by the compiler (fastmath "reassoc"), the same way for every row. What does so and is called by
compiled code is inlined there (forceinline): of a function of its own there would be two versions, one beside its
caller and one alone, rounded differently, and which of them ran would depend on what the process has just compiled.

n: states, M: contact ports, Q: pole pairs.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from .coupling import POLES, WEIGHTS, Propagator

_PAIRS = len(POLES)
_LAGS = WEIGHTS / POLES
FAST = {"reassoc", "contract", "nsz"}


class StepArrays(NamedTuple):
    """One system's matrices for one step length, laid out for the kernel and possibly padded behind their true sizes.
    dt: s. rates: (n,) 1/s. ports: (M, n). scale_real, scale_imag: (Q, n). gram: (Q, M, M) complex. object_states,
    sensor_states: how many, the latter of each fingertip. modes: ports of each of `contacts` contacts. watched: (n,)
    a row on the state whose mean `advance` returns: W lost to surroundings at the first temperature. around: K, how
    much warmer those are than that."""

    dt: float
    rates: np.ndarray
    ports: np.ndarray
    scale_real: np.ndarray
    scale_imag: np.ndarray
    gram: np.ndarray
    object_states: int
    sensor_states: int
    modes: int
    contacts: int
    watched: np.ndarray
    around: float


def step_arrays(
    propagator: Propagator,
    *,
    modes: int | None = None,
    sensor_states: int = 0,
    watched: np.ndarray | None = None,
) -> StepArrays:
    """Arrays of a propagator. modes: ports of each contact (None: all belong to one). sensor_states: of each fingertip,
    at the end of the states, seeing only its own contact's ports."""
    states, ports = propagator.ports.shape
    own = ports if modes is None else modes
    return StepArrays(
        propagator.dt,
        np.ascontiguousarray(propagator.rates),
        np.ascontiguousarray(propagator.ports.T),
        np.ascontiguousarray(np.real(propagator.scale)),
        np.ascontiguousarray(np.imag(propagator.scale)),
        np.ascontiguousarray(propagator.gram),
        states - sensor_states * (ports // own),
        sensor_states,
        own,
        ports // own,
        np.zeros(states) if watched is None else np.ascontiguousarray(watched),
        0.0,
    )


class Workspace(NamedTuple):
    """Memory of `advance` and of what calls it, for systems of at most its sizes; what it holds between calls does not
    matter."""

    rate: np.ndarray
    change: np.ndarray
    real: np.ndarray
    imag: np.ndarray
    lagged: np.ndarray
    gathered: np.ndarray
    matrix: np.ndarray
    weight: np.ndarray
    drive: np.ndarray
    flow: np.ndarray


@njit(cache=True)
def workspace(states: int, ports: int) -> Workspace:
    """Room for systems of up to that many states and ports."""
    # Few blocks: getting one takes as long as a loop over it.
    long, short = np.zeros((4, states)), np.zeros((4, ports))
    matrix = np.zeros((1 + ports, ports), np.complex128)
    return Workspace(
        long[0],
        long[1],
        long[2],
        long[3],
        short[0],
        matrix[ports],
        matrix[:ports],
        short[1],
        short[2],
        short[3],
    )


@njit(cache=True, error_model="numpy", fastmath=FAST, forceinline=True)
def advance(
    system: StepArrays,
    state: np.ndarray,
    conductance: np.ndarray,
    difference: np.ndarray,
    flow: np.ndarray,
    room: Workspace,
) -> float:
    """One step of one system: state (n,) in place, flow (M,) filled with the mean heat flow W during the step.

    conductance: (M,) W/K, >= 0. difference: (M,) K. room: workspace of at least this size. Returns the mean during the
    step of the watched row on the state.
    """
    n = system.object_states + system.contacts * system.sensor_states
    m = system.contacts * system.modes
    rates, ports, dt, watched, around = system.rates, system.ports, system.dt, system.watched, system.around
    scale_real, scale_imag, gram = system.scale_real, system.scale_imag, system.gram
    shared, own, modes = system.object_states, system.sensor_states, system.modes
    rate, change, real, imag = room.rate, room.change, room.real, room.imag
    lagged, gathered, matrix = room.lagged, room.gathered, room.matrix
    for j in range(m):
        flow[j] = conductance[j] * (
            difference[j] - _see(ports, j, state, shared, shared + (j // modes) * own, own)
        )
        lagged[j] = 0.0
    for i in range(n):
        rate[i] = around * watched[i] - rates[i] * state[i]
        change[i] = 0.0
    met = 0  # ports to solve for: none where nothing conducts
    for j in range(m):
        if conductance[j] > 0:
            met = m
    watched_now, watched_lag = 0.0, 0.0
    for i in range(n):
        watched_now += watched[i] * state[i]
    for q in range(_PAIRS):
        for i in range(n):
            real[i] = scale_real[q, i] * rate[i]
            imag[i] = scale_imag[q, i] * rate[i]
        for j in range(met):
            heard = _hear(ports, j, real, imag, shared, shared + (j // modes) * own, own)
            weight = dt * conductance[j]
            gathered[j] = flow[j] - weight * heard
            for k in range(m):
                matrix[j, k] = weight * gram[q, j, k]
            matrix[j, j] += 1.0
        _solve(matrix, gathered, met)
        for i in range(n):
            real[i] = rate[i]
            imag[i] = 0.0
        for j in range(met):
            _push(ports, j, gathered[j], real, imag, shared, shared + (j // modes) * own, own)
            lagged[j] += (_LAGS[q] * gathered[j]).real
        a, b = WEIGHTS[q].real, WEIGHTS[q].imag
        c, d = _LAGS[q].real, _LAGS[q].imag
        for i in range(n):
            solved_real = scale_real[q, i] * real[i] - scale_imag[q, i] * imag[i]
            solved_imag = scale_real[q, i] * imag[i] + scale_imag[q, i] * real[i]
            change[i] += a * solved_real - b * solved_imag
            watched_lag += watched[i] * (c * solved_real - d * solved_imag)
    for j in range(m):
        flow[j] = -2 * lagged[j]
    mean = watched_now - 2 * dt * watched_lag
    for i in range(n):
        state[i] -= 2 * dt * change[i]
    return mean


@njit(cache=True, error_model="numpy", fastmath=FAST, inline="always")
def _see(ports, j, values, shared, start, own):
    """A port's sum over the states that it sees: the object's, and `own` of its fingertip from `start` on."""
    total = 0.0
    for i in range(shared):
        total += ports[j, i] * values[i]
    for i in range(start, start + own):
        total += ports[j, i] * values[i]
    return total


@njit(cache=True, error_model="numpy", fastmath=FAST, inline="always")
def _hear(ports, j, real, imag, shared, start, own):
    """The same of complex values."""
    total_real, total_imag = 0.0, 0.0
    for i in range(shared):
        total_real += ports[j, i] * real[i]
        total_imag += ports[j, i] * imag[i]
    for i in range(start, start + own):
        total_real += ports[j, i] * real[i]
        total_imag += ports[j, i] * imag[i]
    return complex(total_real, total_imag)


@njit(cache=True, error_model="numpy", fastmath=FAST, inline="always")
def _push(ports, j, amount, real, imag, shared, start, own):
    """Adds a port's column times a complex amount to the states that it drives."""
    a, b = amount.real, amount.imag
    for i in range(shared):
        real[i] += ports[j, i] * a
        imag[i] += ports[j, i] * b
    for i in range(start, start + own):
        real[i] += ports[j, i] * a
        imag[i] += ports[j, i] * b


@njit(cache=True, error_model="numpy", fastmath=FAST, forceinline=True)
def _solve(matrix: np.ndarray, vector: np.ndarray, m: int) -> None:
    """Solves matrix x = vector, the leading m of each, in place by elimination with row pivoting."""
    for c in range(m):
        pivot, largest = c, -1.0
        for r in range(c, m):
            size = abs(matrix[r, c].real) + abs(matrix[r, c].imag)
            if size > largest:
                pivot, largest = r, size
        if pivot != c:
            for k in range(c, m):
                matrix[c, k], matrix[pivot, k] = matrix[pivot, k], matrix[c, k]
            vector[c], vector[pivot] = vector[pivot], vector[c]
        real, imag = matrix[c, c].real, matrix[c, c].imag
        size = 1 / (real * real + imag * imag)
        inverse = complex(real * size, -imag * size)
        for r in range(c + 1, m):
            factor = matrix[r, c] * inverse
            for k in range(c + 1, m):
                matrix[r, k] -= factor * matrix[c, k]
            vector[r] -= factor * vector[c]
        matrix[c, c] = inverse
    for c in range(m - 1, -1, -1):
        total = vector[c]
        for k in range(c + 1, m):
            total -= matrix[c, k] * vector[k]
        vector[c] = total * matrix[c, c]
