"""How an object's field survives a change of the places through which its network is seen.

n: states, M: patterns of a contact, K: rates.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from threadpoolctl import ThreadpoolController

from .bodies import BodyField
from .place import Place

LEAST = 0.03  # of the largest, singular values below which are left out: a flow that is hardly seen
_GROWTH = 1.1  # times the norm of a field's states, the root of what they store: a new network has no more

_BLAS = ThreadpoolController()


class Turn(NamedTuple):
    """Of the states of one rate, which `was` of the network before and `now` of the one after: (n now, n was)."""

    now: np.ndarray
    was: np.ndarray
    matrix: np.ndarray


def carried_states(before: BodyField, after: BodyField, patterns: int, states: np.ndarray) -> np.ndarray:
    """(n after,) the field of those states (n before,), on the states of a network with other places.

    The sum of their squares is what a passive network stores, which nothing but heat from outside makes grow. Networks
    with few states tell a field a little differently, and least squares might let it grow from place to place without
    end. Where the states but the mean would grow by more than _GROWTH, they are made smaller."""
    found, modal = np.zeros(len(after.rates)), min(before.modal, after.modal)
    found[:modal] = states[:modal]
    for turn in _turns(before, after, patterns):
        found[turn.now] = turn.matrix @ states[turn.was]
    stored, now = float(np.linalg.norm(states[1:])), float(np.linalg.norm(found[1:]))
    if now > _GROWTH * stored:
        found[1:] *= _GROWTH * stored / now
    return found


@lru_cache(maxsize=1024)
def _turns(before: BodyField, after: BodyField, patterns: int) -> tuple[Turn, ...]:
    """What the object has of its own wherever it is touched stays as it is, and so does heat: it is all in the mean
    temperature's state. What fades sooner does so at rates that are the same whatever the places are: the states of a
    rate are those by which the common places see of it what they saw, by least squares, and else the smallest: less of
    what is stored cannot be there.
    Singular values count the less the nearer they are to those that are left out: round-off decides nothing."""
    common = [place for place in before.places if place in after.places]
    if not common:
        return ()
    seen, wanted = _seen(before, after, common, patterns)
    alike: dict[tuple[int, int], list[tuple[np.ndarray, np.ndarray]]] = {}  # pairs of as many states
    for rate in dict.fromkeys(after.rates[after.modal :].tolist()):
        was, now = (each.modal + np.flatnonzero(each.rates[each.modal :] == rate) for each in (before, after))
        if len(was):
            alike.setdefault((len(was), len(now)), []).append((was, now))
    found = []
    with _BLAS.limit(limits=1, user_api="blas"):  # or the number of threads would decide last bits
        for pairs in alike.values():
            every_was, every_now = (np.array(each) for each in zip(*pairs, strict=True))
            matrices = _inverse(wanted[:, every_now].swapaxes(0, 1)) @ seen[:, every_was].swapaxes(0, 1)
            found += [Turn(now, was, matrix) for (was, now), matrix in zip(pairs, matrices, strict=True)]
    return tuple(found)


def _inverse(matrices: np.ndarray) -> np.ndarray:
    """Of each of (R, m, n)."""
    left, values, right = np.linalg.svd(matrices, full_matrices=False)
    least = LEAST * values[:, :1]
    kept = values > least
    values = np.where(kept, values, 1.0)
    share = np.where(kept, (1 - (least / values) ** 2) / values, 0.0)
    return (right.swapaxes(1, 2) * share[:, None]) @ left.swapaxes(1, 2)


def _seen(
    before: BodyField, after: BodyField, common: list[Place], patterns: int
) -> tuple[np.ndarray, np.ndarray]:
    """(temperatures, n) of the common places' ports that both networks have: of each one's states."""
    found = []
    for field in (before, after):
        ports = []
        for place in common:
            numbers = before.places.index(place), after.places.index(place)
            whole, at = before.whole[numbers[0]] and after.whole[numbers[1]], field.places.index(place)
            ports.append(field.port(at, patterns)[:, : patterns if whole else 1])
            if whole and field.beside.size:
                ports.append(field.in_rings(at))
        found.append(np.concatenate(ports, axis=1).T)
    return found[0], found[1]
