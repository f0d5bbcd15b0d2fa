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
    found, own = np.zeros(len(after.rates)), min(before.own, after.own)
    found[:own] = states[:own]
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
    found = []
    with _BLAS.limit(limits=1, user_api="blas"):  # or the number of threads would decide last bits
        for rate in np.unique(after.rates[after.own :]):
            was, now = (each.own + np.flatnonzero(each.rates[each.own :] == rate) for each in (before, after))
            if len(was):
                found.append(Turn(now, was, _inverse(wanted[:, now]) @ seen[:, was]))
    return tuple(found)


def _inverse(matrix: np.ndarray) -> np.ndarray:
    left, values, right = np.linalg.svd(matrix, full_matrices=False)
    kept = values > LEAST * values[0]
    share = (1 - (LEAST * values[0] / values[kept]) ** 2) / values[kept]
    return (right[kept].T * share) @ left[:, kept].T


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
