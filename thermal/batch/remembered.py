"""What the states of a row of FixedTables tell: heat and warmth of its box, and what a fingertip remembers.

Letters as in fixed_rates.py.
"""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit
from thermograsp.lanes import dot

from ..numerics import FAST
from .carry import TipRows
from .fixed_rates import AIRED, BLOCKS, DROP, HELD, POLE_HEAT, PORT, RATES, USED, FixedTables


def fixed_heat(tables: FixedTables, row: int, state: np.ndarray) -> float:
    """J in the row's box above its first temperature; state (n,)."""
    parts = tables.slow[row], tables.body[row], tables.links[row]
    return _box_heat(*parts, state, tables.patterns, tables.places)


def fixed_warmth(tables: FixedTables, row: int, state: np.ndarray, left: np.ndarray) -> list[float]:
    """K at each place of the row's box from what has flowed through it alone, of which so much is left (K,)."""
    return _warmth(tables.body[row], state, left, tables.patterns, tables.places).tolist()


def fixed_tip_rows(tables: FixedTables, number: int) -> TipRows:
    """What a fingertip with the element of that number tells of its states."""
    patterns, rates, poles, element = tables.patterns, tables.rates[0], tables.poles, tables.tips[number]
    drop, heat, ports = (
        element[first : first + patterns] for first in (patterns**2, patterns**2 + patterns, 0)
    )
    still = element[patterns**2 + 2 * patterns :]
    return TipRows(
        np.concatenate((poles[0], np.tile(rates, 1 + patterns))),
        np.concatenate((poles[POLE_HEAT], still[1], heat.ravel())),
        np.concatenate((poles[DROP], still[0], drop.ravel())),
        np.concatenate((poles[PORT], heat[0], ports.ravel())),
        np.zeros((0, len(poles[0]) + (1 + patterns) * len(rates))),
    )


def fixed_tip_heat(tables: FixedTables, element: np.ndarray) -> np.ndarray:
    """(of_tip,) of such rows, the heat's alone. element: one of the tips."""
    patterns = tables.patterns
    first = patterns**2 + patterns
    return np.concatenate((tables.poles[POLE_HEAT], element[-1], element[first : first + patterns].ravel()))


@njit(cache=True, error_model="numpy")
def _box_heat(slow, body, index, x, patterns, places):
    """See fixed_heat; of one row's slow, body and index."""
    most = patterns * places
    used, aired = index[USED] * patterns, index[AIRED] > 0
    return held_heat(slow, body, most * most, most * most + most, x, used, aired)


@njit(cache=True, error_model="numpy")
def _warmth(body, x, left, patterns, places):
    """See fixed_warmth; of one row's body."""
    most, found = patterns * places, np.zeros(places)
    for n in range(places):
        even, start = n * patterns * (most + 1), 1 + RATES * (1 + n * patterns)
        for k in range(RATES):
            found[n] += body[even, k] * x[start + k] * left[k]
        found[n] = abs(found[n])
    return found


@njit(cache=True, inner=True, error_model="numpy", fastmath=FAST, forceinline=True)
def held_heat(slow, body, heats, still, x, used, aired):
    """J in a box, above its first temperature."""
    total = slow[HELD] * x[0]
    if aired:
        total += dot(body, still * RATES, x, 1, BLOCKS)
        total += dot(body, heats * RATES, x, 1 + RATES, used * BLOCKS)
    return total
