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

    change: np.ndarray
    lag: np.ndarray
    scaled: np.ndarray
    root: np.ndarray
    start: np.ndarray
    heard: np.ndarray
    matrix: np.ndarray
    weight: np.ndarray
    drive: np.ndarray
    flow: np.ndarray


@njit(cache=True)
def workspace(states: int, ports: int) -> Workspace:
    """Room for systems of up to that many states and ports."""
    # Few blocks: getting one takes as long as a loop over it.
    long, short = np.empty((2 + 2 * _PAIRS, states)), np.empty((5, ports))
    matrix = np.empty((_PAIRS + ports, ports), np.complex128)
    return Workspace(
        long[0],
        long[1],
        long[2:],
        short[0],
        short[1],
        matrix[ports:],
        matrix[:ports],
        short[2],
        short[3],
        short[4],
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
    # Written for the compiler: a helper inlined twice, a slice and a loop more each cost tenths of a second, once. The
    # sums over states take all pairs of poles at once, which are written out, and zeros too: short loops take longer.
    n = system.object_states + system.contacts * system.sensor_states
    m = system.contacts * system.modes
    rates, ports, dt, watched = system.rates, system.ports, system.dt, system.watched
    scale_real, scale_imag, gram = system.scale_real, system.scale_imag, system.gram
    change, lag, scaled, heard = room.change, room.lag, room.scaled, room.heard
    root, start, matrix = room.root, room.start, room.matrix
    watched_now, watched_lag = 0.0, 0.0
    for i in range(n):
        rate = system.around * watched[i] - rates[i] * state[i]
        now, mean = 0.0, 0.0
        for q in range(_PAIRS):
            real, imag = scale_real[q, i] * rate, scale_imag[q, i] * rate
            scaled[2 * q, i], scaled[2 * q + 1, i] = real, imag
            now += WEIGHTS[q].real * real - WEIGHTS[q].imag * imag
            mean += _LAGS[q].real * real - _LAGS[q].imag * imag
        change[i], lag[i] = now, mean
        watched_now += watched[i] * state[i]
    conducting = 0  # ports to solve for: none where nothing conducts
    for j in range(m):
        seen = real_0 = imag_0 = real_1 = imag_1 = real_2 = imag_2 = 0.0
        for i in range(n):
            port = ports[j, i]
            seen += port * state[i]
            real_0 += port * scaled[0, i]
            imag_0 += port * scaled[1, i]
            real_1 += port * scaled[2, i]
            imag_1 += port * scaled[3, i]
            real_2 += port * scaled[4, i]
            imag_2 += port * scaled[5, i]
        heard[0, j], heard[1, j] = complex(real_0, imag_0), complex(real_1, imag_1)
        heard[2, j] = complex(real_2, imag_2)
        root[j], start[j] = np.sqrt(dt * conductance[j]), (difference[j] - seen) / dt
        flow[j] = 0.0
        if conductance[j] > 0:
            conducting = m
    # The flows are I + dt H G: taken over the root of dt H they have a symmetric matrix, with zeros for open contacts.
    for q in range(_PAIRS):
        for j in range(conducting):
            heard[q, j] = root[j] * (start[j] - heard[q, j])
            for k in range(j, m):
                matrix[j, k] = root[j] * root[k] * gram[q, j, k]
            matrix[j, j] += 1.0
        # Elimination without pivots: they are at least sin 102 degrees (see batch/step.py).
        for c in range(conducting):
            pivot = matrix[c, c]
            size = 1 / (pivot.real * pivot.real + pivot.imag * pivot.imag)
            inverse = matrix[c, c] = complex(pivot.real * size, -pivot.imag * size)
            for r in range(c + 1, m):
                factor = matrix[c, r] * inverse
                for k in range(r, m):
                    matrix[r, k] -= factor * matrix[c, k]
                heard[q, r] -= factor * heard[q, c]
        for j in range(conducting - 1, -1, -1):
            total = heard[q, j]
            for k in range(j + 1, m):
                total -= matrix[j, k] * heard[q, k]
            heard[q, j] = total * matrix[j, j]
        for j in range(conducting):
            total = heard[q, j] = root[j] * heard[q, j]
            flow[j] -= 2 * (_LAGS[q].real * total.real - _LAGS[q].imag * total.imag)
    for j in range(conducting):
        zero, one, two = heard[0, j], heard[1, j], heard[2, j]
        now_0, now_1, now_2 = WEIGHTS[0] * zero, WEIGHTS[1] * one, WEIGHTS[2] * two
        mean_0, mean_1, mean_2 = _LAGS[0] * zero, _LAGS[1] * one, _LAGS[2] * two
        for i in range(n):
            port = ports[j, i]
            real_0, real_1, real_2 = scale_real[0, i], scale_real[1, i], scale_real[2, i]
            imag_0, imag_1, imag_2 = scale_imag[0, i], scale_imag[1, i], scale_imag[2, i]
            change[i] += port * (
                (now_0.real * real_0 - now_0.imag * imag_0)
                + (now_1.real * real_1 - now_1.imag * imag_1)
                + (now_2.real * real_2 - now_2.imag * imag_2)
            )
            lag[i] += port * (
                (mean_0.real * real_0 - mean_0.imag * imag_0)
                + (mean_1.real * real_1 - mean_1.imag * imag_1)
                + (mean_2.real * real_2 - mean_2.imag * imag_2)
            )
    for i in range(n):
        watched_lag += watched[i] * lag[i]
        state[i] -= 2 * dt * change[i]
    return watched_now - 2 * dt * watched_lag
