"""Contacts narrower than the sensor's face: what heat has still to spread there.

The networks of fields.py know patches of the sensor's whole face. Under a contact of p by q that is narrower the two
bodies have more impedance, Z(p, q) - Z(width, width), which builds up as heat spreads. It is taken from heat kernels
(thermal/curves/narrow.py), the object's as of a plate that is as thick as it is there, and put on the networks' rates:
Z = sum b_k^2 / (s + rate_k). Its states, c_k' = -rate_k c_k + b_k q with q W through the contact, put the difference
sum b_k c_k between its faces. They hold no heat, they tell where it is. As the same b_k send and receive, they are
passive whatever the widths do. Where another fingertip presses a wall from behind, on half of it (Pinched).

Each side has a table of its own, for contacts in the middle of a face and at its ends: a half-space ends there, which
its mirror image stands for, twice as broad a contact that twice the heat flows through. In between the shares of
thermal/contact/patch_place.py count, and along both axes alike.

J: widths of a table, K: rates, S: moments, T: times.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from types import ModuleType

import numpy as np

from ....thermal import SensorStack
from ....thermal.curves import plate_impedance, stack_impedance
from ....thermal.kernels import GRASP, Resolution, residues
from ....thermal.numerics import Array, as_integers
from ....thermal.plates import stack_impedance as impedance_of_layers
from ...scene import PadPlace
from .walls import Beside, Pinched, Side, Wall, narrow_sides, widths_of

STEPS = 13
"""Widths of a table: the sensor's, and each the last one's over the root of 2; narrower ones count as the last."""
ROOT = 2.0**0.5
"""Of one width over the next."""
_FINEST = 3e4
"""W/(m2 K) of the contact beside which errors of the impedance are weighed."""
MODES = 7
"""Half waves, from none on, along each axis of a sensor's face that contacts hear one another by."""


@lru_cache(maxsize=4096)
def narrow_table(side: Side, width: float, level: Resolution) -> np.ndarray:
    """(2, 2, J, J, K) K/J, the b_k^2 of one side under a sensor of that width m: in the middle or at an end along each
    axis, by the contact's width along each. Below 0 where the network of a narrow object knows more: such a contact has
    none."""
    matter, conducts = side
    table = np.zeros((2, 2, STEPS, STEPS, level.rates))
    if matter is None:
        return table
    if isinstance(matter, Pinched):
        for part, share in ((matter.wall, 1.0 - matter.by), (matter.half, matter.by)):
            table += share * narrow_table((part, conducts), width, level)
        return table
    if isinstance(matter, Wall) and matter.share < 1.0:
        table[:] = narrow_table((replace(matter, share=1.0), conducts), width, level)
        return table - _known_of(table, matter.share)
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


def face_modes(pad: PadPlace, level: Resolution) -> np.ndarray:
    """(MODES, MODES, K) K/J, of a pad's sensor: by how much the temperature of its face falls in each product of
    cosines along its axes, of as many half waves, per flow in that product. Zeros where both are even, and of a bare
    thermostat."""
    return np.zeros((MODES, MODES, level.rates)) if pad.bare else _face_modes(pad.stack, level)


@lru_cache(maxsize=64)
def _face_modes(stack: SensorStack, level: Resolution) -> np.ndarray:
    modes = np.zeros((MODES, MODES, level.rates))
    waves = (np.arange(MODES) * math.pi / stack.width) ** 2
    places = [(n, m) for n, m in np.ndindex(MODES, MODES) if n + m > 0]
    squares = np.array([waves[n] + waves[m] for n, m in places])
    known = impedance_of_layers(stack.layers[::-1], "isothermal", GRASP[:, None], squares) / stack.face_area
    for (n, m), each in zip(places, known.T, strict=True):
        weight = 1 / (each + 1 / (_FINEST * stack.face_area))
        modes[n, m] = residues(each[:, None, None], level.decay, weight)[:, 0, 0]
    modes.setflags(write=False)
    return modes


def rippling(side: Side, dt: float) -> float:
    """m2 K/W, what a side resists pulses of heat in samples of dt s by, see ripple.py."""
    matter, _ = side
    if matter is None or isinstance(matter, Beside):
        return 0.0
    if isinstance(matter, Pinched):
        matter = matter.wall
    face = matter.layers[-1] if isinstance(matter, SensorStack) else matter.material
    return math.sqrt(dt / math.pi) / face.effusivity


def narrow_tables(
    pairs: Sequence[tuple[PadPlace, Wall | Pinched | PadPlace]], level: Resolution, dt: float
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
    along either axis, so that such a contact has no more."""
    at = min(int(2 * math.log2(1 / share)), STEPS - 2)
    way = min((1 / share / ROOT**at - 1) / (ROOT - 1), 1.0)
    along = (1 - way) * table[:, :, at, 0] + way * table[:, :, at + 1, 0]
    across = (1 - way) * table[:, :, 0, at] + way * table[:, :, 0, at + 1]
    return np.maximum(along, across)[:, :, None, None]


def _of_part(impedance: np.ndarray, ratio: np.ndarray) -> np.ndarray:
    """(2, 2, J, J, S) K/W, of which all has an impedance (S,), of parts that are a ratio-th (J, J) of it."""
    return np.broadcast_to(ratio[..., None] * impedance, (2, 2, *ratio.shape, len(impedance)))


def between_steps(xp: ModuleType, ratio: Array) -> tuple[Array, Array]:
    """between_widths as a pure function of arrays: NumPy, PyTorch, JAX."""
    steps = (2 * xp.log2(ratio)).clip(0.0, STEPS - 1.0)
    at = xp.floor(steps).clip(None, STEPS - 2.0)
    return as_integers(at), (2.0 ** ((steps - at) / 2) - 1) / (2.0**0.5 - 1)
