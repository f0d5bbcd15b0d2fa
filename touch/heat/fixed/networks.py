"""Networks of every fingertip on every object, each pair at one place, for objects of several materials.

F: fingertips, O: objects, N = F O: pairs, V: materials of an object, T: combinations of materials, M: patterns of a
contact, K: states, those of the objects first, S: states of a narrow contact, J: widths of its table.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ....thermal.kernels import Tip
from ..places import BodyField


@dataclass(frozen=True, slots=True, eq=False)
class FixedNetworks:
    """For steps of dt s. Pairs count through the objects of a fingertip, then through the fingertips; combinations
    through the materials of the last object, then of the one before.

    rates (T, K) 1/s. ports (T, K, N M) sqrt(K/J). drop (N, K): what a pair's fingertip feels. difference (N,) K of the
    fingertips above the air. begin (O + 1,): where the states of the objects begin, the first ones those of their mean
    temperatures, and where the last object's end. held (O, V): J in one of the first ones.
    narrow (U, 2, 2, J, J, S) K/J and ripples (U,) m2 K/W of narrow_tables, narrow_number (N V, 3) of those of each
    pair's sides, its materials behind one another, and of the object while pair number behind (N,) presses it from the
    other side, width (N,) m, decay (S,) 1/s and modes (F, MODES, MODES, S) K/J of face_modes.
    state (K,) and narrow_state (N, S): as they are now."""

    dt: float
    rates: np.ndarray
    ports: np.ndarray
    drop: np.ndarray
    difference: np.ndarray
    begin: np.ndarray
    held: np.ndarray
    narrow: np.ndarray
    ripples: np.ndarray
    narrow_number: np.ndarray
    behind: np.ndarray
    width: np.ndarray
    decay: np.ndarray
    modes: np.ndarray
    state: np.ndarray
    narrow_state: np.ndarray


def fixed_networks(
    dt: float,
    patterns: int,
    tips: Sequence[Tip],
    fields: Sequence[Sequence[BodyField]],
    places: np.ndarray,
    warm: np.ndarray,
    narrow: np.ndarray,
    ripples: np.ndarray,
    narrow_number: np.ndarray,
    behind: np.ndarray,
    width: np.ndarray,
    decay: np.ndarray,
    modes: np.ndarray,
    states: Sequence[np.ndarray],
    narrow_state: np.ndarray,
) -> FixedNetworks:
    """fields: of the objects, by material. places: (F, O) each pair's among its object's. warm: (F,) K. narrow,
    ripples: tables, and narrow_number, behind, width: by pair. modes: by fingertip. states: of the objects, then of
    the fingertips."""
    objects, most = len(fields), max(map(len, fields))
    lengths = [max(len(field.rates) for field in choices) for choices in fields] + [
        len(tip.side.rates) for tip in tips
    ]
    begin = np.cumsum([0, *lengths])
    pairs, total = len(tips) * objects, int(begin[-1])
    counts = tuple(map(len, fields))
    rates = np.zeros((int(np.prod(counts)), total))
    ports, drop = np.zeros((*rates.shape, pairs * patterns)), np.zeros((pairs, total))
    held = np.zeros((objects, most))
    for o, choices in enumerate(fields):
        held[o] = [choices[min(v, len(choices) - 1)].heat[0] for v in range(most)]
    for n, (f, o) in enumerate(np.ndindex(len(tips), objects)):
        side, first = tips[f].side, begin[objects + f]
        part = slice(first, first + len(side.rates))
        rates[:, part], drop[n, part] = side.rates, side.outputs["drop"]
        ports[:, part, n * patterns : (n + 1) * patterns] = -side.ports
        for row, chosen in enumerate(np.ndindex(*counts)):
            field = fields[o][chosen[o]]
            part = slice(begin[o], begin[o] + len(field.rates))
            rates[row, part] = field.rates
            ports[row, part, n * patterns : (n + 1) * patterns] = field.port(int(places[f, o]), patterns)
    state = np.zeros(total)
    for first, field_states in zip(begin, states, strict=False):
        state[first : first + len(field_states)] = field_states
    return FixedNetworks(
        dt,
        rates,
        ports,
        drop,
        np.repeat(warm, objects),
        begin[: objects + 1],
        held,
        narrow,
        ripples,
        narrow_number,
        behind,
        width,
        decay,
        modes,
        state,
        narrow_state,
    )
