"""A curved body's contact as a table over force and place, for code that has not its law: arrays, and C.

What a footprint conducts, gas beside it with it, and the patch that stands for it (footprint.py, spread.py), at FORCES
and at places of the body's crown, or of its middle along a cylinder, from the pad's middle. In between it is taken
evenly by the places, and the conductance as a power of the force. A table is a row of numbers: PLACES distances m along
the pad's two axes each; then W/K, m2 and m (the patch's length along the second) by force and both places; then by the
same the shares by which the patch lies at an end of the face along both axes, and at an end of the body
(patch_place.py).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import lru_cache

import numpy as np

from thermograsp.compiled import njit

from ..matter import Material, Skin
from ..numerics import Array, as_integers, namespace_of
from .area import Pad
from .fingertip import touching
from .law import CYLINDER, round_footprint
from .patch_place import patch_ends, patch_offset
from .rough_faces import Surface
from .spread import beneath, even_contact

FORCES, PLACES = 14, 16
FIRST_FORCE, FORCE_STEP = math.log(0.02), math.log(2.2)
"""Logarithms of the first force N and of the ratio of two that follow one another."""
LEAST_CURVED = 1e-9
"""W/K: less is none."""
_SHARES = 2 * PLACES + 3 * FORCES * PLACES * PLACES
CURVED_TABLE = _SHARES + 4 * FORCES * PLACES * PLACES
_RIM = 0.001  # m beyond a pad's sides, where a contact may be named
_INSIDE = np.array([0.0, 0.3, 0.55, 0.75, 0.87, 0.94, 0.98, 1.0])  # of the face's half width
_MORE = 5.0
_NEAR = 1e-6  # m: places of a table are further apart, in single precision too


@lru_cache(maxsize=256)
def curved_table(
    pad: Pad, skin: Skin | None, body: Material, radius: float, length: float | None = None
) -> np.ndarray:
    """(CURVED_TABLE,) of a fingertip on a ball of that radius m, or on a cylinder of that length m. pad: its silicone;
    skin: over it, None for a bare face, which is rigid. Raises InvalidValueError for sizes that are none."""
    surface, face = Surface.of(body), touching(skin)
    law = round_footprint(pad, skin, surface, radius, length)
    aside, along = curved_places(pad, length)
    table = np.empty(CURVED_TABLE)
    table[:PLACES], table[PLACES : 2 * PLACES] = aside, along
    values, shares = table_values(table)
    _fill(
        law,
        beneath(body, face),
        np.exp(FIRST_FORCE + FORCE_STEP * np.arange(FORCES)),
        aside,
        along,
        values,
        shares,
    )
    narrow_gas(values, shares)
    table.flags.writeable = False
    return table


def table_values(table: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Views of a table: (FORCES, PLACES, PLACES, 3) W/K, m2 and m, and (FORCES, PLACES, PLACES, 4) shares."""
    grid = FORCES, PLACES, PLACES
    return table[2 * PLACES : _SHARES].reshape(*grid, 3), table[_SHARES:].reshape(*grid, 4)


def narrow_gas(values: np.ndarray, shares: np.ndarray) -> None:
    """Makes the patch of gas alone that of a contact at the next force or place that conducts over _MORE times as much:
    in between most heat passes the contact, and not the wide patch that gas conducts through. values, shares: as
    table_values tells them."""
    through, patches, ends = values[..., 0].copy(), values[..., 1:].copy(), shares.copy()
    most = np.zeros_like(through)
    for axis, way in ((0, -1), (1, -1), (1, 1), (2, -1), (2, 1)):
        beside = np.roll(through, way, axis)
        edge = [slice(None)] * 3
        edge[axis] = slice(-1, None) if way < 0 else slice(0, 1)
        beside[tuple(edge)] = 0.0
        small = np.roll(patches, way, axis)
        taken = (beside > _MORE * through) & (beside > most) & (small[..., 0] < patches[..., 0])
        most[taken] = beside[taken]
        values[..., 1:][taken] = small[taken]
        shares[taken] = np.roll(ends, way, axis)[taken]


def curved_places(pad: Pad, length: float | None) -> tuple[np.ndarray, np.ndarray]:
    """(PLACES,) m each: of the tables of a ball, or of a cylinder of that length m, across it and along it."""
    aside = _aside(pad)
    return aside, aside if length is None else _along(pad, length)


def _aside(pad: Pad) -> np.ndarray:
    """(PLACES,) m: close together at the face's edge."""
    half = pad.face / 2
    beyond = max(pad.width / 2 + _RIM - half, 0.1 * half)
    return np.concatenate(
        (_INSIDE * half, half + beyond * (np.arange(1, PLACES - len(_INSIDE) + 1) / 8) ** 2)
    )


def _along(pad: Pad, length: float) -> np.ndarray:
    """(PLACES,) m: where an end of the cylinder comes to an edge of the face or the pad, and between."""
    edges = [abs(half + way * length / 2) for half in (pad.width / 2, pad.face / 2) for way in (1, -1)]
    return even_places(0.0, pad.width / 2 + _RIM, edges)


def even_places(first: float, last: float, edges: Iterable[float]) -> np.ndarray:
    """(PLACES,) m from first to last: those of the edges that lie between, and others where there is most room."""
    places = [first, last]
    for edge in edges:
        if all(abs(edge - place) > _NEAR for place in places) and first < edge < last:
            places.append(edge)
    while len(places) < PLACES:
        places.sort()
        widest = int(np.argmax(np.diff(places)))
        places.append((places[widest] + places[widest + 1]) / 2)
    return np.sort(places)


@njit(cache=True, error_model="numpy")
def _fill(law, resistance, forces, aside, along, values, shares):
    place, width = np.zeros(3), 2 * law.half_face
    for i in range(len(aside)):
        for j in range(len(along)):
            place[1], place[2] = aside[i], along[j]
            for k in range(len(forces)):
                conducts, area = even_contact(law, resistance, forces[k], place)
                long = math.sqrt(area)
                beside = along[j]
                if law.shape == CYLINDER:
                    half, other = law.half_face, law.length / 2
                    low, high = max(-half, -along[j] - other), min(half, other - along[j])
                    long, beside = max(high - low, 0.0), (low + high) / 2
                    middle = along[j] + beside
                    shares[k, i, j, 3] = patch_ends(middle, along[j], long, law.length, width)
                else:
                    shares[k, i, j, 3] = 0.0
                broad = area / long if long > 0.0 else 0.0
                shares[k, i, j, 0] = patch_offset(aside[i], broad, width)
                shares[k, i, j, 1] = patch_offset(beside, long, width)
                shares[k, i, j, 2] = 0.0
                values[k, i, j, 0], values[k, i, j, 1], values[k, i, j, 2] = conducts, area, long


@njit(cache=True, error_model="numpy", forceinline=True)
def curved_contact(table, force, aside, along):
    """(W/K, patch m2, its length m) at a force N > 0 on the pad, the crown that far m from the pad's middle, either
    sign; 0 where nothing conducts. table: of curved_table."""
    i, u = _between(table[:PLACES], abs(aside))
    j, v = _between(table[PLACES : 2 * PLACES], abs(along))
    at = (math.log(force) - FIRST_FORCE) / FORCE_STEP
    k = min(max(int(at), 0), FORCES - 2)
    w = min(at - k, 1.0)
    first = 2 * PLACES + 3 * ((k * PLACES + i) * PLACES + j)
    low, high = first, first + 3 * PLACES * PLACES
    conducts = max(_even(table, low, u, v), LEAST_CURVED)
    conducts *= math.exp(w * math.log(max(_even(table, high, u, v), LEAST_CURVED) / conducts))
    if conducts <= 2 * LEAST_CURVED:
        return 0.0, 0.0, 0.0
    w = max(w, 0.0)
    area, more = _even(table, low + 1, u, v), _even(table, high + 1, u, v)
    long, longer = _even(table, low + 2, u, v), _even(table, high + 2, u, v)
    return conducts, area + w * (more - area), long + w * (longer - long)


@njit(cache=True, error_model="numpy", forceinline=True)
def curved_shares(table, force, aside, along, shares):
    """Fills shares (4,): by how much such a contact lies at an end of the face along both axes, and of the body."""
    i, u = _between(table[:PLACES], abs(aside))
    j, v = _between(table[PLACES : 2 * PLACES], abs(along))
    at = (math.log(force) - FIRST_FORCE) / FORCE_STEP
    k = min(max(int(at), 0), FORCES - 2)
    w = min(max(at - k, 0.0), 1.0)
    for n in range(4):
        shares[n] = 0.0
    for corner in range(8):
        a, b, c = corner & 1, corner >> 1 & 1, corner >> 2
        weight = (w if a else 1 - w) * (u if b else 1 - u) * (v if c else 1 - v)
        first = _SHARES + 4 * (((k + a) * PLACES + i + b) * PLACES + j + c)
        for n in range(4):
            shares[n] += weight * table[first + n]


@njit(cache=True, inner=True, error_model="numpy")
def _between(places, at):
    """(number of the place before, share of the way to the next)."""
    k = 0
    while k < PLACES - 2 and at >= places[k + 1]:
        k += 1
    return k, min((at - places[k]) / (places[k + 1] - places[k]), 1.0)


@njit(cache=True, inner=True, error_model="numpy")
def _even(table, at, u, v):
    """Between four places."""
    one = table[at] + v * (table[at + 3] - table[at])
    at += 3 * PLACES
    other = table[at] + v * (table[at + 3] - table[at])
    return one + u * (other - one)


def array_curved_contact(
    tables: Array, number: Array, force: Array, aside: Array, along: Array
) -> tuple[Array, Array, Array]:
    """curved_contact as a pure function of arrays: NumPy, PyTorch, JAX. tables: (K CURVED_TABLE,), number: integers
    below K, of the others' shape. Forces that are not above 0 count as none."""
    xp = namespace_of(force)
    start = number * CURVED_TABLE
    i, u = _array_between(xp, tables, start, abs(aside))
    j, v = _array_between(xp, tables, start + PLACES, abs(along))
    pressed = force.clip(1e-9, None)
    at = (xp.log(pressed) - FIRST_FORCE) / FORCE_STEP
    before = at.clip(0.0, FORCES - 2.0)
    k = as_integers(before)
    w = (at - k).clip(None, 1.0)
    low = start + 2 * PLACES + 3 * ((k * PLACES + i) * PLACES + j)
    high = low + 3 * PLACES * PLACES

    def even(first: Array) -> Array:
        one = tables[first] + v * (tables[first + 3] - tables[first])
        second = first + 3 * PLACES
        other = tables[second] + v * (tables[second + 3] - tables[second])
        return one + u * (other - one)

    conducts = even(low).clip(LEAST_CURVED, None)
    conducts = conducts * xp.exp(w * xp.log(even(high).clip(LEAST_CURVED, None) / conducts))
    w = w.clip(0.0, None)
    area, long = even(low + 1), even(low + 2)
    area, long = area + w * (even(high + 1) - area), long + w * (even(high + 2) - long)
    closed = (force > 0) & (conducts > 2 * LEAST_CURVED)
    none = 0.0 * force
    return xp.where(closed, conducts, none), xp.where(closed, area, none), xp.where(closed, long, none)


def array_curved_shares(tables: Array, number: Array, force: Array, aside: Array, along: Array) -> Array:
    """curved_shares, (..., 4), as a pure function of arrays."""
    xp = namespace_of(force)
    start = number * CURVED_TABLE
    i, u = _array_between(xp, tables, start, abs(aside))
    j, v = _array_between(xp, tables, start + PLACES, abs(along))
    at = (xp.log(force.clip(1e-9, None)) - FIRST_FORCE) / FORCE_STEP
    k = as_integers(at.clip(0.0, FORCES - 2.0))
    w = (at - k).clip(0.0, 1.0)
    first = start + _SHARES + 4 * ((k * PLACES + i) * PLACES + j)

    def value(n: int) -> Array:
        def along_places(at: Array) -> Array:
            one = tables[at] + v * (tables[at + 4] - tables[at])
            at = at + 4 * PLACES
            other = tables[at] + v * (tables[at + 4] - tables[at])
            return one + u * (other - one)

        low, high = along_places(first + n), along_places(first + n + 4 * PLACES * PLACES)
        return low + w * (high - low)

    return xp.stack([value(n) for n in range(4)], -1)


def _array_between(xp, tables, start, at):
    k = 0 * start
    for place in range(1, PLACES - 1):
        k = k + as_integers(xp.where(at >= tables[start + place], 1.0 + 0.0 * at, 0.0 * at))
    before, after = tables[start + k], tables[start + k + 1]
    return k, ((at - before) / (after - before)).clip(None, 1.0)
