"""What a heat of one world, without glued elements and backs, tells after a step, for compiled code that steps many.

F: fingertips, O: objects.
"""

from __future__ import annotations

from thermograsp.compiled import njit

from ...thermal.padded import RINGS
from ..pointers import floats, words
from .march import TABLE

_BOOKS = 8
"""Of JoinedHeat.telling: the addresses of its elements' and even rows, of the objects' heats at the start, of the
places in use and of their ports, that of the table that `sample` takes, and how long the rows are."""


@njit(cache=True, borrows=True, error_model="numpy")
def tell_drop(at, drop):
    """Fills drop (F,) K. at: the address of JoinedHeat.telling."""
    entries = words(words(at, _BOOKS)[5], TABLE)
    found = floats(entries[29], entries[41])
    for f in range(len(found)):
        drop[f] = found[f]


@njit(cache=True, borrows=True, error_model="numpy")
def tell_books(at, given, elements, gained):
    """JoinedHeat.balance: fills given (F, O) J, elements (F,) J and gained (O,) J, and returns J to the air."""
    books = words(at, _BOOKS)
    entries = words(books[5], TABLE)
    tips, objects, states, contacts = entries[41], entries[42], entries[50], entries[57]
    x, held = floats(entries[25], (objects + tips, states)), floats(entries[19], objects)
    flowed, owners = floats(entries[27], (entries[58], objects + tips)), words(entries[37], contacts)
    rows, started = floats(books[0], (tips, books[6])), floats(books[2], objects)
    for f in range(tips):
        heat = 0.0
        for k in range(books[6]):
            heat += rows[f, k] * x[objects + f, k]
        elements[f] = heat
        for o in range(objects):
            given[f, o] = flowed[f, o]
    for lane in range(tips, entries[58]):
        for o in range(objects):
            given[owners[tips + (lane - tips) // RINGS], o] += flowed[lane, o]
    for o in range(objects):
        gained[o] = x[o, 0] * held[o] - started[o]
    return floats(entries[28], 1)[0]


@njit(cache=True, borrows=True, error_model="numpy")
def tell_warmth(at, ambient, sensors, under, means):
    """JoinedHeat.faces and object_temperature: fills sensors (F,), under (O, F) and means (O,) °C. ambient: °C."""
    books = words(at, _BOOKS)
    entries = words(books[5], TABLE)
    tips, objects, states = entries[41], entries[42], entries[50]
    x, warmth = floats(entries[25], (objects + tips, states)), floats(entries[31], objects)
    even, warm = floats(books[1], (tips, books[7])), floats(entries[11], tips)
    current, ports = words(books[3], (tips, objects)), floats(books[4], (tips, objects, states))
    for o in range(objects):
        means[o] = ambient + warmth[o]
    for f in range(tips):
        total = warm[f]
        for k in range(books[7]):
            total += even[f, k] * x[objects + f, k]
        sensors[f] = ambient + total
        for o in range(objects):
            total = warmth[o]
            if current[f, o] >= 0:
                total = 0.0
                for k in range(states):
                    total += ports[f, o, k] * x[o, k]
            under[o, f] = ambient + total
