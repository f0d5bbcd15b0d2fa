"""What a heat of one world, without glued elements and backs, tells after a step, for compiled code that steps many.

F: fingertips, O: objects.
"""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit

from ...thermal.padded import RINGS
from ..contacts import AREA, ASIDE, CLOSED, COLUMNS, CONDUCTANCE, LENGTH
from ..pointers import floats, words
from .march import TABLE
from .narrow import STEPS, seen, share_of, table_between

_BOOKS = 8
"""Of JoinedHeat.telling: the addresses of its elements' and even rows, of the objects' heats at the start, of the
places in use and of their ports, that of the table that `sample` takes, and how long the rows are."""


@njit(cache=True, borrows=True, error_model="numpy")
def tell_drop(at, drop):
    """Fills drop (F,) K. at: the address of JoinedHeat.telling."""
    entries = words(words(at, _BOOKS)[5], TABLE)
    found = floats(entries[29], entries[44])
    for f in range(len(found)):
        drop[f] = found[f]


@njit(cache=True, borrows=True, error_model="numpy")
def tell_books(at, given, elements, gained):
    """JoinedHeat.balance: fills given (F, O) J, elements (F,) J and gained (O,) J, and returns J to the air."""
    books = words(at, _BOOKS)
    entries = words(books[5], TABLE)
    tips, objects, states, contacts = entries[44], entries[45], entries[53], entries[60]
    x, held = floats(entries[25], (objects + tips, states)), floats(entries[19], objects)
    flowed, owners = floats(entries[27], (entries[61], objects + tips)), words(entries[37], contacts)
    rows, started = floats(books[0], (tips, books[6])), floats(books[2], objects)
    for f in range(tips):
        heat = 0.0
        for k in range(books[6]):
            heat += rows[f, k] * x[objects + f, k]
        elements[f] = heat
        for o in range(objects):
            given[f, o] = flowed[f, o]
    for lane in range(tips, entries[61]):
        for o in range(objects):
            given[owners[tips + (lane - tips) // RINGS], o] += flowed[lane, o]
    for o in range(objects):
        gained[o] = x[o, 0] * held[o] - started[o]
    return floats(entries[28], 1)[0]


@njit(cache=True, borrows=True, error_model="numpy")
def tell_warmth(at, touches_at, ambient, sensors, under, means):
    """JoinedHeat.faces and object_temperature: fills sensors and under (O, F) and means (O,) °C. touches_at: the
    address of the touches (F, O + F, COLUMNS) of the last step. ambient: °C."""
    books = words(at, _BOOKS)
    entries = words(books[5], TABLE)
    tips, objects, states, rates, lanes = entries[44], entries[45], entries[53], entries[56], entries[61]
    targets = objects + tips
    x, warmth = floats(entries[25], (targets, states)), floats(entries[31], objects)
    even, warm = floats(books[1], (tips, books[7])), floats(entries[11], tips)
    current, ports = words(books[3], (tips, objects)), floats(books[4], (tips, objects, states))
    touches, widths = floats(touches_at, (tips, targets, COLUMNS)), floats(entries[1], lanes)
    tables = floats(entries[23], (entries[55], 2, 2, STEPS, STEPS, rates))
    kinds, narrow = words(entries[24], (lanes, targets, 2)), floats(entries[26], (lanes, targets, rates))
    for o in range(objects):
        means[o] = ambient + warmth[o]
    for f in range(tips):
        on_face = warm[f]
        for k in range(books[7]):
            on_face += even[f, k] * x[objects + f, k]
        for o in range(objects):
            below = warmth[o]
            if current[f, o] >= 0:
                below = 0.0
                for k in range(states):
                    below += ports[f, o, k] * x[o, k]
            sides = tables[kinds[f, o, 0]], tables[kinds[f, o, 1]]
            falls = narrow_falls(*sides, widths[f], touches[f, o], narrow[f, o])
            sensors[o, f] = ambient + on_face - falls[0]
            under[o, f] = ambient + below + falls[1]


@njit(cache=True, borrows=True, error_model="numpy")
def narrow_falls(tip_side, other, width, touch, states):
    """K by which a narrow contact is colder on the mean than the whole of a sensor's face, and warmer than the object
    under it, as if no other contact shared the face. tip_side, other: of narrow_table. width: m. touch: (COLUMNS,).
    states: (K,) of the pair."""
    if not (touch[AREA] > 0.0 and touch[CONDUCTANCE] > 0.0):
        return 0.0, 0.0
    i, u, j, v = seen(width, touch[AREA] / touch[CLOSED], touch[LENGTH] / touch[AREA])
    if i < 0:
        return 0.0, 0.0
    first, second = 0.0, 0.0
    for k in range(len(states)):
        of_tip, of_other = 0.0, 0.0
        for place in range(4):
            a, b = place & 1, place >> 1
            at_tip = share_of(touch[ASIDE] / touch[AREA], a) * share_of(touch[ASIDE + 1] / touch[AREA], b)
            at_other = share_of(touch[ASIDE + 2] / touch[AREA], a) * share_of(
                touch[ASIDE + 3] / touch[AREA], b
            )
            of_tip += at_tip * table_between(tip_side, a, b, i, u, j, v, k)
            of_other += at_other * table_between(other, a, b, i, u, j, v, k)
        both = of_tip + of_other
        if both > 0.0:
            first += states[k] * of_tip / np.sqrt(both)
            second += states[k] * of_other / np.sqrt(both)
    return first, second
