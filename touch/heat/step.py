"""The step of thermal/network/coupling.py for fields that contacts join, compiled.

A field's states lie by their rates, of which there are few. How contacts see those of one rate is summed before it is
taken to the poles, and what comes back from the poles is the same for all of them: the poles cost by the rate, not by
the state. A sum never depends on how many worlds there are.

m: ports, C: contacts, R: different rates, Q: pole pairs.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit
from thermograsp.lanes import LANES, add_sum, dot, put, put_sum, solve_symmetric

from ...thermal.network import POLES, WEIGHTS

CONTACTS, FIELDS, PORTS, GRAM, HEADER = range(5)
"""Of a group's integers, the first: contacts and fields, and where its ports and its gram begin. Behind them its
contacts' pairs; then of each field its number, how many lanes it has, how many rates and states, the lanes by number,
the row of its first rate among the paces, and of each rate how many states."""
_RATE, _LEFT, _MEAN, _SEEN, _PUSHED, _LAGGED = 0, 1, 2, 3, 9, 15
PACE = 21
"""Numbers of a rate: itself 1/s; of a state left alone what is there after a step, and its mean; how it is seen at the
poles, how flows there push it, and push its mean: real parts, then imaginary ones."""
_PAIRS = len(POLES)
_LAGS = WEIGHTS / POLES
_MOST = 1e100  # K/W, of a port


def pace(rate: float, dt: float) -> np.ndarray:
    """(PACE,) for steps of dt s."""
    scale = 1 / (POLES + dt * rate)
    seen, pushed, lagged = POLES * scale / dt, -2 * dt * WEIGHTS * scale, -2 * dt * _LAGS * scale
    alone = [rate, 1 - rate * pushed.real.sum(), 1 - rate * lagged.real.sum()]
    parts = [seen.real, seen.imag, pushed.real, -pushed.imag, lagged.real, -lagged.imag]
    return np.concatenate((alone, *parts))


def lanes(patterns: int) -> int:
    """Of a contact."""
    return -(-patterns // LANES)


def gram(rates: np.ndarray, ports: np.ndarray, dt: float) -> np.ndarray:
    """(m, m, 2, LANES) K/J, real and imaginary parts of how ports (n, m) of states of those rates (n,) hear one another
    at the poles."""
    heard = np.einsum("na,nq,nb->abq", ports, 1 / (POLES + dt * rates[:, None]), ports)
    found = np.zeros((*heard.shape[:2], 2, LANES))
    found[:, :, 0, :_PAIRS], found[:, :, 1, :_PAIRS] = heard.real, heard.imag
    return found


class Room(NamedTuple):
    """Memory of `step`. Of each port: resistance K/W, difference K and flow W. By column, a lane's port: heard and
    flows (2 Q, columns), and into (columns,), all flat. Of the solution, complex lanes, one pole each: matrix (m, m),
    solved and factors (m,). Lanes by rate: summed."""

    resistance: np.ndarray
    difference: np.ndarray
    flow: np.ndarray
    heard: np.ndarray
    flows: np.ndarray
    into: np.ndarray
    matrix: np.ndarray
    solved: np.ndarray
    factors: np.ndarray
    summed: np.ndarray


def room_size(contacts: int, patterns: int, rates: int) -> int:
    """Numbers of which `room_of` makes a Room for so many contacts and rates of a field."""
    m, columns = contacts * patterns, contacts * LANES * lanes(patterns)
    return 3 * m + (4 * _PAIRS + 1) * columns + 2 * LANES * (m * m + 2 * m) + LANES * rates


@njit(cache=True, inner=True, borrows=True, forceinline=True)
def room_of(numbers, contacts, patterns):
    """A Room for so many contacts."""
    m, columns = contacts * patterns, contacts * LANES * ((patterns + LANES - 1) // LANES)
    heard = 3 * m
    flows, into = heard + 2 * _PAIRS * columns, heard + 4 * _PAIRS * columns
    solved = into + columns
    factors, matrix = solved + 2 * LANES * m, solved + 4 * LANES * m
    summed = matrix + 2 * LANES * m * m
    return Room(
        numbers[:m],
        numbers[m : 2 * m],
        numbers[2 * m : heard],
        numbers[heard:flows],
        numbers[flows:into],
        numbers[into:solved],
        numbers[matrix:summed],
        numbers[solved:factors],
        numbers[factors:matrix],
        numbers[summed:],
    )


@njit(cache=True, inner=True, borrows=True, error_model="numpy", forceinline=True)
def step(dt, at, integers, ports, grams, paces, patterns, states, first, stride, held, room, shared, mutual):
    """One step of dt s of a group, whose integers begin at `at`. states: flat, in place; from `first` on the
    world's fields, each `stride` behind the last. held: (O,) J
    of the mean's state, the first of an object. ports, grams: of all groups. paces: (R PACE,). room: with the
    ports' resistances and differences; their mean flows are filled. shared: whether mutual counts: (C C,) K/W, above
    the diagonal, what the flow of one contact does at another. Returns what the air takes of its objects, W."""
    contacts, fields = integers[at + CONTACTS], integers[at + FIELDS]
    objects, wide = len(held), LANES * ((patterns + LANES - 1) // LANES)
    columns, m = contacts * wide, contacts * patterns
    heard, flows, into, solved, matrix = room.heard, room.flows, room.into, room.solved, room.matrix
    resistance, difference, flow, summed = room.resistance, room.difference, room.flow, room.summed
    for c in range(2 * _PAIRS * columns):
        heard[c] = 0.0
    listed, port = at + HEADER + 2 * contacts, integers[at + PORTS]
    for _ in range(fields):
        field, touched, rates = integers[listed], integers[listed + 1], integers[listed + 2]
        paced, first_port = listed + 4 + touched, port
        for b in range(touched):
            state, port = first + field * stride, first_port + LANES * b
            for s in range(rates):
                size = integers[paced + 1 + s]
                put_sum(summed, LANES * s, ports, port, LANES * touched, states, state, size)
                state += size
                port += LANES * touched * size
            column, row = LANES * integers[listed + 4 + b], PACE * integers[paced] + _SEEN
            for r in range(2 * _PAIRS):
                add_sum(heard, r * columns + column, summed, 0, LANES, paces, row + r, PACE, rates)
        port = first_port + LANES * touched * integers[listed + 3]
        listed = paced + 1 + rates
    row, touched_gram = 2 * LANES * m, integers[at + GRAM]
    for c in range(contacts):
        for p in range(patterns):
            a = c * patterns + p
            resists, differs = min(resistance[a], _MOST) / dt, difference[a] / dt
            diagonal = a * row + 2 * LANES * a
            for n in range(diagonal, (a + 1) * row, LANES):
                put(matrix, n, grams, touched_gram + n)
            for q in range(LANES):
                matrix[diagonal + q] += resists
            if p == 0 and shared:
                for other in range(c + 1, contacts):
                    lane = diagonal + 2 * LANES * patterns * (other - c)
                    for q in range(LANES):
                        matrix[lane + q] += mutual[c * contacts + other] / dt
            for q in range(_PAIRS):
                real, imag = 2 * LANES * a + q, 2 * LANES * a + LANES + q
                solved[real] = -heard[q * columns + c * wide + p]
                solved[imag] = -heard[(_PAIRS + q) * columns + c * wide + p]
                solved[real] += differs
    solve_symmetric(matrix, row, solved, room.factors, m)
    for c in range(contacts):
        for p in range(patterns):
            flow[c * patterns + p] = 0.0
            for q in range(_PAIRS):
                at_pole = 2 * LANES * (c * patterns + p) + q
                real, imag = solved[at_pole], solved[at_pole + LANES]
                flows[q * columns + c * wide + p], flows[(_PAIRS + q) * columns + c * wide + p] = real, imag
                flow[c * patterns + p] -= 2 * (_LAGS[q].real * real - _LAGS[q].imag * imag)
    listed, port, lost = at + HEADER + 2 * contacts, integers[at + PORTS], 0.0
    for _ in range(fields):
        field, touched, rates = integers[listed], integers[listed + 1], integers[listed + 2]
        paced, state = listed + 4 + touched, first + field * stride
        row = PACE * integers[paced]
        if field < objects:  # of the mean temperature, its first state
            mean = paces[row + _MEAN] * states[state]
            for b in range(touched):
                column = LANES * integers[listed + 4 + b]
                for r in range(2 * _PAIRS):
                    mean += paces[row + _LAGGED + r] * dot(
                        ports, port + LANES * b, flows, r * columns + column, 1
                    )
            lost += held[field] * paces[row + _RATE] * mean
        for s in range(rates):
            for b in range(touched):
                column = LANES * integers[listed + 4 + b]
                put_sum(into, LANES * b, flows, column, columns, paces, row + _PUSHED, 2 * _PAIRS)
            for _ in range(integers[paced + 1 + s]):
                states[state] = paces[row + _LEFT] * states[state] + dot(ports, port, into, 0, touched)
                state += 1
                port += LANES * touched
            row += PACE
        listed = paced + 1 + rates
    return lost
