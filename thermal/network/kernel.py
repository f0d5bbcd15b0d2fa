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

from thermograsp.compiled import njit

from ..numerics import FAST
from .coupling import POLES, WEIGHTS, Propagator

_PAIRS = len(POLES)
_LAGS = WEIGHTS / POLES


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
) -> StepArrays:
    """Arrays of a propagator. modes: ports of each contact (None: all belong to one). sensor_states: of each fingertip,
    at the end of the states, seeing only its own contact's ports."""
    states, ports = propagator.ports.shape
    each = ports if modes is None else modes
    return StepArrays(
        propagator.dt,
        np.ascontiguousarray(propagator.rates),
        np.ascontiguousarray(propagator.ports.T),
        np.ascontiguousarray(np.real(propagator.scale)),
        np.ascontiguousarray(np.imag(propagator.scale)),
        np.ascontiguousarray(propagator.gram),
        states - sensor_states * (ports // each),
        sensor_states,
        each,
        ports // each,
        np.zeros(states),
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
    # Written for the compiler: a helper inlined twice, a slice and a loop more each cost tenths of a second, once.
    n = system.object_states + system.contacts * system.sensor_states
    m = system.contacts * system.modes
    rates, ports, dt, watched, around = system.rates, system.ports, system.dt, system.watched, system.around
    scale_real, scale_imag, gram = system.scale_real, system.scale_imag, system.gram
    rate, change, real, imag = room.rate, room.change, room.real, room.imag
    lagged, gathered, matrix = room.lagged, room.gathered, room.matrix
    conducting = 0  # ports to solve for: none where nothing conducts
    for j in range(m):
        seen = 0.0
        for i in range(n):
            seen += ports[j, i] * state[i]
        flow[j] = conductance[j] * (difference[j] - seen)
        lagged[j] = 0.0
        if conductance[j] > 0:
            conducting = m
    watched_now, watched_lag = 0.0, 0.0
    for i in range(n):
        rate[i] = around * watched[i] - rates[i] * state[i]
        change[i] = 0.0
        watched_now += watched[i] * state[i]
    for q in range(_PAIRS):
        for j in range(conducting):
            heard_real, heard_imag = 0.0, 0.0
            for i in range(n):
                heard = ports[j, i] * rate[i]
                heard_real += heard * scale_real[q, i]
                heard_imag += heard * scale_imag[q, i]
            weight = dt * conductance[j]
            gathered[j] = complex(flow[j] - weight * heard_real, -weight * heard_imag)
            for k in range(m):
                matrix[j, k] = weight * gram[q, j, k]
            matrix[j, j] += 1.0
        # Elimination without pivots: they are at least sin 102 degrees (see batch/step.py).
        for c in range(conducting):
            pivot = matrix[c, c]
            size = 1 / (pivot.real * pivot.real + pivot.imag * pivot.imag)
            inverse = matrix[c, c] = complex(pivot.real * size, -pivot.imag * size)
            for r in range(c + 1, m):
                factor = matrix[r, c] * inverse
                for k in range(c + 1, m):
                    matrix[r, k] -= factor * matrix[c, k]
                gathered[r] -= factor * gathered[c]
        for i in range(n):
            real[i] = rate[i]
            imag[i] = 0.0
        for j in range(conducting - 1, -1, -1):
            total = gathered[j]
            for k in range(j + 1, m):
                total -= matrix[j, k] * gathered[k]
            total *= matrix[j, j]
            gathered[j] = total
            lagged[j] += _LAGS[q].real * total.real - _LAGS[q].imag * total.imag
            for i in range(n):
                real[i] += ports[j, i] * total.real
                imag[i] += ports[j, i] * total.imag
        for i in range(n):
            solved_real = scale_real[q, i] * real[i] - scale_imag[q, i] * imag[i]
            solved_imag = scale_real[q, i] * imag[i] + scale_imag[q, i] * real[i]
            change[i] += WEIGHTS[q].real * solved_real - WEIGHTS[q].imag * solved_imag
            watched_lag += watched[i] * (_LAGS[q].real * solved_real - _LAGS[q].imag * solved_imag)
    for j in range(m):
        flow[j] = -2 * lagged[j]
    for i in range(n):
        state[i] -= 2 * dt * change[i]
    return watched_now - 2 * dt * watched_lag
