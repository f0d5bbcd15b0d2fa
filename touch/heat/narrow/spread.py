"""How heat spreads under one narrow contact, compiled: tables.py's numbers between the widths that it has.

J: widths of a table, K: rates.
"""

from __future__ import annotations

import numpy as np

from thermograsp.compiled import njit

from ....thermal.contact import NARROW
from .tables import ROOT, STEPS


@njit(cache=True, borrows=True, error_model="numpy")
def spread(tip_side, other, widths, area, length, aside, ends, root):
    """Fills root (K,) with the b_k of a contact of that area m2 and length m, along the second axis, under a sensor.
    tip_side, other: of narrow_table, of the pad and of what it touches, and widths_of them, m; aside, ends: (2,) the
    shares by which the contact lies at an end of either. Returns whether there are any: not where the contact is as
    wide as both faces or its area is not told."""
    if not area > 0.0:
        return False
    i, u, j, v = seen(widths[0], area, length)
    m, s, n, t = seen(widths[1], area, length) if widths[1] != widths[0] else (i, u, j, v)
    if i < 0 and m < 0:
        return False
    for k in range(len(root)):
        root[k] = 0.0
    if i >= 0:
        add_squares(tip_side, i, u, j, v, aside, root)
    if m >= 0:
        add_squares(other, m, s, n, t, ends, root)
    for k in range(len(root)):
        root[k] = np.sqrt(root[k])
    return True


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def seen(width, area, length):
    """Where a contact stands in narrow_tables: of both widths the number of the one before and the share of the way to
    the next; numbers of -1 for one that is as wide as the face."""
    first = min(area / length, width)
    second = min(area / first, width)
    if not min(first, second) < width * NARROW:
        return -1, 0.0, -1, 0.0
    i, u = between_widths(width / first)
    j, v = between_widths(width / second)
    return i, u, j, v


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def add_own(table, width, area, length, shares, squares):
    """add_squares of a contact of that area m2 and length m on a face of that width m, where it is narrow."""
    i, u, j, v = seen(width, area, length)
    if i >= 0:
        add_squares(table, i, u, j, v, shares, squares)


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def add_squares(table, i, u, j, v, shares, squares):
    """Adds the b_k^2 of a table to squares (K,), of a contact as `seen` tells it. shares: (2,) by which it lies at an
    end."""
    for place in range(4):
        a, b = place & 1, place >> 1
        weight = share_of(shares[0], a) * share_of(shares[1], b)
        if weight > 0.0:  # most contacts are in the middle, where one is
            for k in range(len(squares)):
                squares[k] += weight * table_between(table, a, b, i, u, j, v, k)


@njit(cache=True, error_model="numpy", inline="always")
def table_between(table, a, b, i, u, j, v, k):
    """One b_k^2 of a table between the widths that `seen` tells; 0 where the network knows more."""
    near = (1 - v) * table[a, b, i, j, k] + v * table[a, b, i, j + 1, k]
    far = (1 - v) * table[a, b, i + 1, j, k] + v * table[a, b, i + 1, j + 1, k]
    return max((1 - u) * near + u * far, 0.0)


@njit(cache=True, error_model="numpy")
def lean(tip_side, other, width, area, length, aside, ends, shares, curved, root, rest):
    """What a narrow contact of the face (see spread) does to the object under a ring of the pad around it: fills root
    (K,) with what of the face's states the ring sees, and adds to squares, rest (K,), what its own flow does beyond
    that. shares: (STEPS, 2) of ring_shares. curved: the share of the time in which the object is curved. Returns
    whether there is any."""
    if not area > 0.0:
        return False
    i, u, j, v = seen(width, area, length)
    if i < 0:
        return False
    both, object_alone = np.zeros(len(root)), np.zeros(len(root))
    add_squares(tip_side, i, u, j, v, aside, both)
    add_squares(other, i, u, j, v, ends, object_alone)
    # the strip's breadth is what tells
    n, w = (i, u) if area < length * length else (j, v)
    alone = curved * ((1 - w) * shares[n, 0] + w * shares[n + 1, 0])
    across = curved * ((1 - w) * shares[n, 1] + w * shares[n + 1, 1])
    for k in range(len(root)):
        of_both = both[k] + object_alone[k]
        root[k] = across * object_alone[k] / np.sqrt(of_both) if of_both > 0.0 else 0.0
        rest[k] += max(alone * object_alone[k] - root[k] * root[k], 0.0)
    return True


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def between_widths(ratio):
    """(number of the width before, share of the way to the next) of a width that is a ratio-th of the sensor's: evenly
    by its inverse, to which the impedance is proportional at first."""
    at, size = 0, 1.0
    while at < STEPS - 2 and ratio > size * ROOT:
        at, size = at + 1, size * ROOT
    return at, min((ratio / size - 1) / (ROOT - 1), 1.0)


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def share_of(share, end):
    """Of a contact that lies at an end of the face by that share, or in the middle by the rest."""
    share = min(max(share, 0.0), 1.0)
    return share if end == 1 else 1 - share
