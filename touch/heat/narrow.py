"""Contacts narrower than the sensor's face: what heat has still to spread there.

The networks of fields.py know patches of the sensor's whole face. Under a contact of p by q that is narrower the two
bodies have more impedance, Z(p, q) - Z(width, width), which builds up as heat spreads. It is taken from heat kernels
(thermal/curves/narrow.py), the object's as of a plate that is as thick as it is there, and put on the networks' rates:
Z = sum b_k^2 / (s + rate_k). Its states, c_k' = -rate_k c_k + b_k q with q W through the contact, put the difference
sum b_k c_k between its faces. They hold no heat, they tell where it is. As the same b_k send and receive, they are
passive whatever the widths do.

Each side has a table of its own, for contacts in the middle of a face and at its ends: a half-space ends there, which
its mirror image stands for, twice as broad a contact that twice the heat flows through. In between the shares of
thermal/contact/patch_place.py count, and along both axes alike.

J: widths of a table, K: rates, S: moments, T: times.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from thermograsp.compiled import njit

from ...thermal import Material, SensorStack
from ...thermal.contact import NARROW
from ...thermal.curves import CONFORMING, LAPPED, plate_impedance, stack_impedance
from ...thermal.kernels import Resolution, residues
from ..scene import PadPlace

STEPS = 13
"""Widths of a table: the sensor's, and each the last one's over the root of 2; narrower ones count as the last."""
_ROOT = 2.0**0.5
_WHOLE = 0.9  # of the face, from which on an object counts as being under all of it
_STEPS, _THICK, _THINNEST = 8, 0.5, 2.0**-8
"""Steps of thickness from one to its half; what is thick and the thinnest, of the sensor's width."""
_FINEST = 3e4
"""W/(m2 K) of the contact beside which errors of the impedance are weighed."""


@dataclass(frozen=True, slots=True)
class Beside:
    """A ring of the pad around a sensor's element under a part of its front: as much more impedance as the part is
    smaller. impedance: K/W of all of it at GRASP."""

    impedance: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Wall:
    """What of an object is under a sensor's face: share of the face, from less than all of which its network knows how
    heat spreads, and thickness m, inf where heat has spread before it comes to the other side."""

    material: Material
    share: float = 1.0
    thickness: float = math.inf


Side = tuple[Wall | SensorStack | Beside | None, float]
"""What spreads heat on one side of a contact, None for nothing, and W/(m2 K) of the contact if that matters."""


def wall_of(made_of: Material, covered: float, thickness: float, width: float) -> Wall:
    """An object of that material which is under a share of a sensor's face of that width m and so many m thick there:
    in steps that many places share."""
    thick = math.inf
    if thickness < _THICK * width:
        step = round(_STEPS * math.log2(width / max(thickness, _THINNEST * width)))
        thick = width * 2.0 ** (-step / _STEPS)
    return Wall(made_of, 1.0 if covered > _WHOLE else covered, thick)


def narrow_sides(pad: PadPlace, target: Wall | PadPlace) -> tuple[Side, Side]:
    """What spreads heat on either side of a pad's contact with an object or another fingertip: None for
    bare thermostats, which have no impedance, and where an element is glued on, which is met with its whole face."""
    if pad.glued is not None or (isinstance(target, PadPlace) and target.glued is not None):
        return (None, 0.0), (None, 0.0)
    tip_side = _side(pad)
    return tip_side, _side(target) if isinstance(target, PadPlace) else (target, tip_side[1])


def widths_of(pad: PadPlace, target: Wall | PadPlace) -> tuple[float, float]:
    """m, the sensor's face whose patch the network on either side of that contact knows: an object has the pad's."""
    return pad.stack.width, target.stack.width if isinstance(target, PadPlace) else pad.stack.width


def _side(pad: PadPlace) -> Side:
    return (None if pad.bare else pad.stack, LAPPED if pad.skin is None else CONFORMING)


@lru_cache(maxsize=4096)
def narrow_table(side: Side, width: float, level: Resolution) -> np.ndarray:
    """(2, 2, J, J, K) K/J, the b_k^2 of one side under a sensor of that width m: in the middle or at an end along each
    axis, by the contact's width along each."""
    matter, conducts = side
    table = np.zeros((2, 2, STEPS, STEPS, level.rates))
    if matter is None:
        return table
    if isinstance(matter, Wall) and matter.share < 1.0:
        table[:] = narrow_table((replace(matter, share=1.0), conducts), width, level)
        return np.maximum(table - _known_of(table, matter.share), 0.0)
    widths = width * 2.0 ** (-np.arange(STEPS) / 2)
    if isinstance(matter, Beside):
        known = _of_part(np.array(matter.impedance), width**2 / np.outer(widths, widths))
    elif isinstance(matter, SensorStack):
        known = stack_impedance(matter, conducts, widths)
    else:
        known = plate_impedance(matter.material, matter.thickness, conducts, widths)
    area = np.outer(widths, widths)
    for first, second, i, j in np.ndindex(table.shape[:-1]):
        each, whole = known[first, second, i, j], known[first, second, 0, 0]
        weight = 1 / (each + 1 / (_FINEST * area[i, j]))
        found = residues((each - whole)[:, None, None], level.decay, weight)
        table[first, second, i, j] = found[:, 0, 0]
    table.setflags(write=False)
    return table


def rippling(side: Side, dt: float) -> float:
    """m2 K/W, what a side resists pulses of heat in samples of dt s by, see ripple.py."""
    matter, _ = side
    if matter is None or isinstance(matter, Beside):
        return 0.0
    face = matter.layers[-1] if isinstance(matter, SensorStack) else matter.material
    return math.sqrt(dt / math.pi) / face.effusivity


def narrow_tables(
    pairs: Sequence[tuple[PadPlace, Wall | PadPlace]], level: Resolution, dt: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Every narrow_table that pairs need (N, 2, 2, J, J, K), the same sides' `rippling` (N,) m2 K/W, and the numbers
    (pairs, 2) of those of their sides."""
    keys = [
        (side, width)
        for pad, target in pairs
        for side, width in zip(narrow_sides(pad, target), widths_of(pad, target), strict=True)
    ]
    numbers = {key: number for number, key in enumerate(dict.fromkeys(keys))}
    tables = np.array([narrow_table(*key, level) for key in numbers])
    ripples = np.array([rippling(side, dt) for side, _ in numbers])
    return tables, ripples, np.array([numbers[key] for key in keys]).reshape(-1, 2)


def _known_of(table: np.ndarray, share: float) -> np.ndarray:
    """(2, 2, 1, 1, K) K/J of a table that belong to a contact of all of the face's length and that share of its width,
    along either axis: of the next width that is narrower, so that such a contact has no more."""
    at = min(max(math.ceil(2 * math.log2(1 / max(share, 1e-3))), 1), STEPS - 1)
    return np.maximum(table[:, :, at, 0], table[:, :, 0, at])[:, :, None, None]


def _of_part(impedance: np.ndarray, ratio: np.ndarray) -> np.ndarray:
    """(2, 2, J, J, S) K/W, of which all has an impedance (S,), of parts that are a ratio-th (J, J) of it."""
    return np.broadcast_to(ratio[..., None] * impedance, (2, 2, *ratio.shape, len(impedance)))


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
    i, u = _between(width / first)
    j, v = _between(width / second)
    return i, u, j, v


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
    """One b_k^2 of a table between the widths that `seen` tells."""
    near = (1 - v) * table[a, b, i, j, k] + v * table[a, b, i, j + 1, k]
    far = (1 - v) * table[a, b, i + 1, j, k] + v * table[a, b, i + 1, j + 1, k]
    return (1 - u) * near + u * far


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
def _between(ratio):
    """(number of the width before, share of the way to the next) of a width that is a ratio-th of the sensor's: evenly
    by its inverse, to which the impedance is proportional at first."""
    at, size = 0, 1.0
    while at < STEPS - 2 and ratio > size * _ROOT:
        at, size = at + 1, size * _ROOT
    return at, min((ratio / size - 1) / (_ROOT - 1), 1.0)


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def share_of(share, end):
    """Of a contact that lies at an end of the face by that share, or in the middle by the rest."""
    share = min(max(share, 0.0), 1.0)
    return share if end == 1 else 1 - share
