"""What makes and fills FixedTables: elements, boxes, and what meets at their contacts.

Letters as in fixed_rates.py.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermograsp.compiled import njit
from thermograsp.lanes import LANES

from ..kernels import BodyResidues
from ..network import POLES, WEIGHTS
from ..numerics import ThermalNetwork
from .fixed_rates import (
    AIRED,
    DROP,
    FADING,
    HELD,
    PAIRS,
    POLE_HEAT,
    POLES_KEPT,
    PORT,
    PUSHED,
    RATE_ROWS,
    RATES,
    SEEN,
    SHARED,
    USED,
    WHERE,
    FixedTables,
    rate_table,
)


def fixed_tables(
    rows: int, fingertips: int, places: int, patterns: int, whole: ThermalNetwork, dt: float
) -> FixedTables:
    """Empty tables. whole: the element under a contact with all of its face, which is element 0."""
    slow = _slow_poles(whole)
    poles, rates = np.zeros((RATE_ROWS + 3, POLES_KEPT)), np.zeros((RATE_ROWS, RATES))
    poles[:RATE_ROWS, :slow] = rate_table(whole.rates[:slow], dt)
    seen = whole.ports[:, 0], whole.outputs["drop"], whole.outputs["element"]
    poles[PORT, :slow], poles[DROP, :slow], poles[POLE_HEAT, :slow] = (row[:slow] for row in seen)
    rates[:] = rate_table(SHARED, dt)
    ports = places * patterns
    tables = FixedTables(
        dt,
        patterns,
        places,
        rates,
        poles,
        np.zeros((1 + rows * fingertips, patterns * patterns + 2 * patterns + 2, RATES)),
        np.zeros((rows, RATE_ROWS + 1 + ports)),
        np.zeros((rows, ports * ports + ports + 1, RATES)),
        np.zeros((rows, fingertips * patterns, fingertips * patterns, 2, LANES)),
        np.full((rows, WHERE + 2 * fingertips), -1),
        np.zeros((RATES, 2, LANES)),
    )
    tables.links[:, WHERE + fingertips :] = 0
    tables.seen[:, :, :PAIRS] = tables.rates[SEEN:PUSHED].reshape(2, PAIRS, RATES).transpose(2, 0, 1)
    tables.tips[0] = tip_residues(whole)
    return tables


def _slow_poles(element: ThermalNetwork) -> int:
    """How many of an element's states are its slow poles, which only the even pattern sees."""
    return int(np.argmax(np.append(element.ports[:, 1:].any(axis=1), True)))


def tip_residues(side: ThermalNetwork) -> np.ndarray:
    """(P P + 2 P + 2, K) of an element at FIXED_LEVEL's rates: a row of FixedTables.tips. Raises ValueError for one of
    other rates."""
    found = np.zeros((side.ports.shape[1] ** 2 + 2 * side.ports.shape[1] + 2, RATES))
    if not _tip_residues(
        side.rates, side.ports, side.outputs["drop"], side.outputs["element"], SHARED, found
    ):
        raise ValueError(f"rates {side.rates} 1/s are not among the shared ones, {SHARED}")
    return found


@njit(cache=True, short_loops=True, error_model="numpy")
def _tip_residues(rates, ports, drop, heat, shared, found):
    """Fills found, the sums over the states that fade at each of the shared rates. Whether each does."""
    patterns, first = ports.shape[1], 0
    while first < len(rates) and _even_alone(ports, first):
        first += 1
    for n in range(first, len(rates)):
        k = 0
        while k < len(shared) and shared[k] != rates[n]:
            k += 1
        if k == len(shared):
            return False
        for p in range(patterns):
            for r in range(patterns):
                found[p * patterns + r, k] += ports[n, p] * ports[n, r]
            found[patterns * patterns + p, k] += ports[n, p] * drop[n]
            found[patterns * patterns + patterns + p, k] += ports[n, p] * heat[n]
        found[len(found) - 2, k] += drop[n] * heat[n]
        found[len(found) - 1, k] += heat[n] * heat[n]
    return True


@njit(cache=True, inner=True, error_model="numpy")
def _even_alone(ports, n):
    """Whether only the even pattern sees that state."""
    for p in range(1, ports.shape[1]):
        if ports[n, p] != 0.0:
            return False
    return True


def set_body(tables: FixedTables, row: int, box: BodyResidues, places: Sequence[int]) -> None:
    """Makes a box the row's, whose patches, those under fingertips first, are the places of these numbers."""
    parts = tables.slow[row], tables.body[row], tables.links[row]
    _body(*parts, np.array(places), tables.patterns, tables.dt, *box)


@njit(cache=True, error_model="numpy")
def _body(slow, body, index, places, patterns, dt, rate, ports, held, residues, heat, still):
    """Fills one row's slow, body and index, for steps of dt s. The rest is a BodyResidues."""
    most, touched, columns = (len(slow) - HELD - 1), len(residues), len(ports)
    slow[:], body[:] = 0.0, 0.0
    slow[0], slow[FADING], slow[HELD] = rate, 1.0, held
    for q in range(PAIRS):  # as in rate_table
        scale = 1 / (POLES[q] + dt * rate)
        pushed = -2 * dt * (WEIGHTS[q] * scale)
        slow[FADING] -= rate * pushed.real
        slow[SEEN + q], slow[SEEN + PAIRS + q] = scale.real, scale.imag
        slow[PUSHED + q], slow[PUSHED + PAIRS + q] = pushed.real, -pushed.imag
    for j in range(columns):
        at = places[j // patterns] * patterns + j % patterns
        slow[HELD + 1 + at] = ports[j]
        for k in range(RATES):
            body[most * most + at, k] = heat[j, k]
            for i in range(touched):
                to = places[i // patterns] * patterns + i % patterns
                body[to * most + at, k] = residues[i, j, k]
            if j >= touched and j % patterns == 0:
                body[at * most + at, k] = residues[0, 0, k]  # stands in for its own, which no step asks for
    index[USED], index[AIRED] = len(places), 0
    for k in range(RATES):
        body[most * most + most, k] = still[k]
        if still[k] != 0.0:
            index[AIRED] = 1


def set_gram(tables: FixedTables, row: int) -> None:
    """Makes what meets at the row's contacts what its other tables say; after these have changed."""
    parts = tables.slow[row], tables.body[row], tables.gram[row], tables.links[row]
    _gram(tables.rates, tables.poles, tables.tips, *parts, tables.patterns, tables.places)


@njit(cache=True, error_model="numpy")
def _gram(rates, poles, tips, slow, body, gram, index, patterns, places):
    """Fills gram (F P, F P, 2, LANES) of one row from the other tables and its own slow, body and index."""
    most = places * patterns
    fingertips = (len(index) - WHERE) // 2
    gram[:] = 0.0
    for f in range(fingertips):
        element = tips[index[WHERE + fingertips + f]]
        for p in range(patterns):
            a = f * patterns + p
            for part in range(2):
                for q in range(PAIRS):
                    at = SEEN + part * PAIRS + q
                    for r in range(patterns):
                        for k in range(RATES):
                            gram[a, f * patterns + r, part, q] += rates[at, k] * element[p * patterns + r, k]
                    if p == 0:
                        for k in range(POLES_KEPT):
                            gram[a, a, part, q] += poles[at, k] * poles[PORT, k] * poles[PORT, k]
                    if index[WHERE + f] < 0:
                        continue
                    j = index[WHERE + f] * patterns + p
                    for g in range(fingertips):
                        if index[WHERE + g] < 0:
                            continue
                        for r in range(patterns):
                            i, c = index[WHERE + g] * patterns + r, g * patterns + r
                            gram[a, c, part, q] += slow[at] * slow[HELD + 1 + j] * slow[HELD + 1 + i]
                            for k in range(RATES):
                                gram[a, c, part, q] += rates[at, k] * body[j * most + i, k]
