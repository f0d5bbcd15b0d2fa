"""A curved body's contact as a table over force and place, for code that has not its law: arrays, and C.

What the contact and the gas beside it conduct, and the patches that stand for them (footprint.py, spread.py), at FORCES
and at places of the body's crown, or of its middle along a cylinder, from the pad's middle. A table is a row of
numbers: PLACES distances m along the pad's two axes each; then by force and both places W/K of the contact and of the
gas, m2 of both patches and m of both along the second axis; then by the same the shares by which the patch lies at an
end of the face along both axes, and at an end of the body (patch_place.py).

In between, values are taken evenly by the places. What the contact conducts is a power of the force, up to the power
that ends a table: 1, or more for soft bodies, which touch ever more of the face. Where it rises faster, the force has
only begun to reach the face; it is then taken evenly by that power of the force. Below it a table has it less than 0,
on the line from the forces above, so that a contact begins where it does and not at the next force or place. The patch
of both, and its sides to one another, are the mean of theirs, weighted by what they conduct.
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
from .law import CYLINDER, round_footprint
from .patch_place import patch_ends, patch_offset
from .rough_faces import Surface
from .spread import beneath, patches

FORCES, PLACES = 14, 24
FIRST_FORCE, FORCE_STEP = math.log(0.02), math.log(2.2)
"""Logarithms of the first force N and of the ratio of two that follow one another."""
_RATIO = math.exp(FORCE_STEP)
LEAST_CURVED = 1e-9
"""W/K: less is none."""
_CONTACT, _GAS, _PATCH, _WIDE, _LONG, _LONGER, _VALUES = range(7)
_SHARES = 2 * PLACES + _VALUES * FORCES * PLACES * PLACES
CURVED_TABLE = _SHARES + 4 * FORCES * PLACES * PLACES + 1
_RIM = 0.001  # m beyond a pad's sides, where a contact may be named
_INSIDE = np.array(
    [0.0, 0.15, 0.3, 0.43, 0.55, 0.66, 0.75, 0.82, 0.87, 0.91, 0.94, 0.96, 0.98, 1.0]
)  # of the face's half width
_LATEST = 0.95  # a contact begins, over the force at which it is
_LITTLE, _MOST_POWER = 0.01, 4.0
_THIN = 1e-12  # m: a patch that is narrower is none
_NEAR = 1e-6  # m: places of a table are further apart, in single precision too


@lru_cache(maxsize=256)
def curved_table(
    pad: Pad, skin: Skin | None, body: Material, radius: float, length: float | None = None
) -> np.ndarray:
    """(CURVED_TABLE,) of a fingertip on a ball of that radius m, or on a cylinder of that length m. pad: its silicone;
    skin: over it, None for a bare face, which is rigid. Raises InvalidValueError for sizes that are none."""
    law = round_footprint(pad, skin, Surface.of(body), radius, length)
    aside, along = curved_places(pad, length)
    table = np.empty(CURVED_TABLE)
    table[:PLACES], table[PLACES : 2 * PLACES] = aside, along
    values, shares = table_values(table)
    _fill(
        law,
        pad.sensor_width,
        beneath(body, skin),
        np.exp(FIRST_FORCE + FORCE_STEP * np.arange(FORCES)),
        aside,
        along,
        values,
        shares,
    )
    table[-1] = begin_contacts(values)
    table.flags.writeable = False
    return table


def table_values(table: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Views of a table: (FORCES, PLACES, PLACES, 6) W/K of the contact and of the gas, m2 of their patches, m of
    these along the second axis, and (FORCES, PLACES, PLACES, 4) shares."""
    grid = FORCES, PLACES, PLACES
    return table[2 * PLACES : _SHARES].reshape(*grid, _VALUES), table[_SHARES:-1].reshape(*grid, 4)


@njit(cache=True, error_model="numpy")
def begin_contacts(values):
    """Continues what contacts conduct below the force at which they begin, on a straight line over that power of the
    force which is returned, with the patch that they begin with. values: of table_values, the contact's 0 where there
    is none."""
    last, power = len(values) - 1, _power(values)
    ratio = _RATIO**power
    for i in range(values.shape[1]):
        for j in range(values.shape[2]):
            at, first = values[:, i, j], 0
            while first <= last and at[first, _CONTACT] <= 0.0:
                first += 1
            if first == 0 or first > last:
                continue
            one, least, slope = at[first, _CONTACT], 1.0 / ratio, 0.0
            if first < last - 1:
                least = _beginning(ratio, one, at[first + 1, _CONTACT], at[first + 2, _CONTACT])
            if first < last and at[first + 1, _CONTACT] > one:
                like = math.log(at[first + 1, _CONTACT] / one) / math.log((ratio - least) / (1.0 - least))
                slope = one * (least / (1.0 - least)) ** like / least  # to twice that force
            for k in range(first):
                at[k, _CONTACT] = min(slope * (ratio ** (k - first) - least), 0.0)
                at[k, _PATCH], at[k, _LONG] = at[first, _PATCH], at[first, _LONG]
    return power


@njit(cache=True, error_model="numpy")
def _power(values):
    """Of the force, at most, by which a contact that touches at every force conducts more, where it conducts."""
    most, found = 0.0, 1.0
    for i in range(values.shape[1]):
        for j in range(values.shape[2]):
            most = max(most, values[-1, i, j, _CONTACT])
    for i in range(values.shape[1]):
        for j in range(values.shape[2]):
            at, everywhere = values[:, i, j, _CONTACT], True
            for k in range(len(at)):
                everywhere &= at[k] > 0.0
            if not everywhere:
                continue
            for k in range(1, len(at)):
                if at[k] > _LITTLE * most:
                    found = max(found, math.log(at[k] / at[k - 1]) / FORCE_STEP)
    return min(found, _MOST_POWER)


@njit(cache=True, error_model="numpy")
def _beginning(ratio, one, two, three):
    """The force, over the first of three that are that ratio apart, of which a power's excess conducts so much at them;
    at least that before the first."""
    low, high = 1.0 / ratio, 1.0
    if not one < two < three:
        return low
    rise, more = math.log(two / one), math.log(three / two)
    for _ in range(30):
        middle = (low + high) / 2
        after = math.log((ratio - middle) / (1.0 - middle))
        if after * more < rise * math.log((ratio * ratio - middle) / (ratio - middle)):
            low = middle
        else:
            high = middle
    return min(low, _LATEST)


def curved_places(pad: Pad, length: float | None) -> tuple[np.ndarray, np.ndarray]:
    """(PLACES,) m each: of the tables of a ball, or of a cylinder of that length m, across it and along it."""
    aside = _aside(pad)
    return aside, aside if length is None else _along(pad, length)


def _aside(pad: Pad) -> np.ndarray:
    """(PLACES,) m: close together at the face's edge."""
    half = pad.face / 2
    beyond = max(pad.width / 2 + _RIM - half, 0.1 * half)
    more = PLACES - len(_INSIDE)
    return np.concatenate((_INSIDE * half, half + beyond * (np.arange(1, more + 1) / more) ** 2))


def _along(pad: Pad, length: float) -> np.ndarray:
    """(PLACES,) m: where an end of the cylinder comes to an edge of the face or the pad, and between, until it has left
    the pad. As long as both ends are beyond the pad nothing changes."""
    edges = [abs(half + way * length / 2) for half in (pad.width / 2, pad.face / 2) for way in (1, -1)]
    last, still = (length + pad.width) / 2, (length - pad.width) / 2
    if still > _NEAR:
        return np.concatenate(([0.0], even_places(still, last, edges, PLACES - 1)))
    return even_places(0.0, last, edges)


def even_places(first: float, last: float, edges: Iterable[float], count: int = PLACES) -> np.ndarray:
    """(count,) m from first to last: those of the edges that lie between, and others where there is most room."""
    places = [first, last]
    for edge in edges:
        if all(abs(edge - place) > _NEAR for place in places) and first < edge < last:
            places.append(edge)
    while len(places) < count:
        places.sort()
        widest = int(np.argmax(np.diff(places)))
        places.append((places[widest] + places[widest + 1]) / 2)
    return np.sort(places)


@njit(cache=True, error_model="numpy")
def _fill(law, width, below, forces, aside, along, values, shares):
    """Fills values and shares, as table_values tells them. width: m of the sensor's face. below: as patches
    takes it."""
    place = np.zeros(3)
    for i in range(len(aside)):
        for j in range(len(along)):
            place[1], place[2] = aside[i], along[j]
            for k in range(len(forces)):
                at = values[k, i, j]
                at[_CONTACT], at[_GAS], at[_PATCH], at[_WIDE], area = patches(law, below, forces[k], place)
                at[_LONG], at[_LONGER], long = math.sqrt(at[_PATCH]), math.sqrt(at[_WIDE]), math.sqrt(area)
                beside = along[j]
                if law.shape == CYLINDER:
                    half, other = law.half_face, law.length / 2
                    low, high = max(-half, -along[j] - other), min(half, other - along[j])
                    long, beside = max(high - low, 0.0), (low + high) / 2
                    at[_LONG], at[_LONGER] = long, long
                    middle = along[j] + beside
                    shares[k, i, j, 3] = patch_ends(middle, along[j], long, law.length, width)
                else:
                    shares[k, i, j, 3] = 0.0
                broad = area / long if long > 0.0 else 0.0
                shares[k, i, j, 0] = patch_offset(aside[i], broad, width)
                shares[k, i, j, 1] = patch_offset(beside, long, width)
                shares[k, i, j, 2] = 0.0


@njit(cache=True, borrows=True, error_model="numpy", forceinline=True)
def curved_contact(table, force, aside, along):
    """(W/K, patch m2, its length m) at a force N > 0 on the pad, the crown that far m from the pad's middle, either
    sign; 0 where nothing conducts. table: of curved_table."""
    return _contact_between(table, *_placed(table, force, aside, along))


@njit(cache=True, borrows=True, error_model="numpy", forceinline=True)
def curved_touch(table, force, aside, along, shares):
    """As curved_contact; fills shares (4,): by how much the contact lies at an end of the face along both axes, and of
    the body."""
    i, u, j, v, k, w = _placed(table, force, aside, along)
    for n in range(4):
        shares[n] = 0.0
    pressed = max(w, 0.0)
    for corner in range(8):
        a, b, c = corner & 1, corner >> 1 & 1, corner >> 2
        weight = (pressed if a else 1 - pressed) * (u if b else 1 - u) * (v if c else 1 - v)
        first = _SHARES + 4 * (((k + a) * PLACES + i + b) * PLACES + j + c)
        for n in range(4):
            shares[n] += weight * table[first + n]
    return _contact_between(table, i, u, j, v, k, w)


@njit(cache=True, inner=True, borrows=True, error_model="numpy", forceinline=True)
def _placed(table, force, aside, along):
    """(number of the place before and share of the way to the next, along both axes, and of the force)."""
    i, u = _between(table[:PLACES], abs(aside))
    j, v = _between(table[PLACES : 2 * PLACES], abs(along))
    at = (math.log(force) - FIRST_FORCE) / FORCE_STEP
    k = min(max(int(at), 0), FORCES - 2)
    return i, u, j, v, k, min(at - k, 1.0)


@njit(cache=True, inner=True, borrows=True, error_model="numpy", forceinline=True)
def _contact_between(table, i, u, j, v, k, w):
    """curved_contact there."""
    low = 2 * PLACES + _VALUES * ((k * PLACES + i) * PLACES + j)
    high = low + _VALUES * PLACES * PLACES
    contact = _by_force(_even(table, low, u, v), _even(table, high, u, v), w, table[CURVED_TABLE - 1])
    w = max(w, 0.0)
    gas = _mixed(table, low + _GAS, high + _GAS, u, v, w)
    total = contact + gas
    if total <= LEAST_CURVED:
        return 0.0, 0.0, 0.0
    part = contact / total
    wide, longer = (
        _mixed(table, low + _WIDE, high + _WIDE, u, v, w),
        _mixed(table, low + _LONGER, high + _LONGER, u, v, w),
    )
    area, long = (
        _mixed(table, low + _PATCH, high + _PATCH, u, v, w),
        _mixed(table, low + _LONG, high + _LONG, u, v, w),
    )
    broad = area / long if long > _THIN else 0.0
    broader = wide / longer if longer > _THIN else 0.0
    area, long, broad = (
        wide + part * (area - wide),
        longer + part * (long - longer),
        broader + part * (broad - broader),
    )
    return total, area, math.sqrt(area * long / broad) if broad > _THIN else long


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _between(places, at):
    """(number of the place before, share of the way to the next)."""
    k = 0
    while k < PLACES - 2 and at >= places[k + 1]:
        k += 1
    return k, min((at - places[k]) / (places[k + 1] - places[k]), 1.0)


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _even(table, at, u, v):
    """Between four places."""
    one = table[at] + v * (table[at + _VALUES] - table[at])
    at += _VALUES * PLACES
    other = table[at] + v * (table[at + _VALUES] - table[at])
    return one + u * (other - one)


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _mixed(table, low, high, u, v, w):
    """Between four places at two forces."""
    one = _even(table, low, u, v)
    return one + w * (_even(table, high, u, v) - one)


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _by_force(low, high, w, power):
    """What a contact conducts between two forces of a table."""
    step = FORCE_STEP * power
    if 0.0 < low and 0.0 < high:
        rise = math.log(high / low)
        if rise < step:
            return low * math.exp(w * rise)
    return max(low + (high - low) * (math.exp(w * step) - 1.0) / (math.exp(step) - 1.0), 0.0)


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
    low = start + 2 * PLACES + _VALUES * ((k * PLACES + i) * PLACES + j)

    def even(first: Array) -> Array:
        one = tables[first] + v * (tables[first + _VALUES] - tables[first])
        second = first + _VALUES * PLACES
        other = tables[second] + v * (tables[second + _VALUES] - tables[second])
        return one + u * (other - one)

    more = _VALUES * PLACES * PLACES
    less, most = even(low), even(low + more)
    step = FORCE_STEP * tables[start + CURVED_TABLE - 1]
    ratio = xp.exp(step)
    gently = (less > 0) & (most > 0) & (most < ratio * less)
    first, second = (xp.where(gently, each, 1.0 + 0.0 * each) for each in (less, most))
    steep = (less + (most - less) * (xp.exp(w * step) - 1.0) / (ratio - 1.0)).clip(0.0, None)
    contact = xp.where(gently, first * xp.exp(w * xp.log(second / first)), steep)
    w = w.clip(0.0, None)

    def mixed(value: int) -> Array:
        one = even(low + value)
        return one + w * (even(low + more + value) - one)

    total = contact + mixed(_GAS)
    closed, none = (force > 0) & (total > LEAST_CURVED), 0.0 * force
    part = contact / xp.where(closed, total, 1.0 + none)
    wide, longer = mixed(_WIDE), mixed(_LONGER)
    area, long = mixed(_PATCH), mixed(_LONG)
    broad, broader = (
        area / xp.where(long > _THIN, long, 1.0 + none),
        wide / xp.where(longer > _THIN, longer, 1.0 + none),
    )
    broad, broader = xp.where(long > _THIN, broad, none), xp.where(longer > _THIN, broader, none)
    area, long, broad = (
        wide + part * (area - wide),
        longer + part * (long - longer),
        broader + part * (broad - broader),
    )
    square = area * long / xp.where(broad > _THIN, broad, 1.0 + none)
    long = xp.where(broad > _THIN, xp.sqrt(xp.where(broad > _THIN, square, 1.0 + none)), long)
    return xp.where(closed, total, none), xp.where(closed, area, none), xp.where(closed, long, none)


def array_curved_shares(tables: Array, number: Array, force: Array, aside: Array, along: Array) -> Array:
    """The shares of curved_touch, (..., 4), as a pure function of arrays."""
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
