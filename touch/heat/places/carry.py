"""How an object's field survives a change of the places through which its network is seen.

n: states, M: patterns of a contact.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from threadpoolctl import ThreadpoolController

from .bodies import BodyField
from .place import Place

AFTERWARDS = np.concatenate(([0.0], np.geomspace(3e-3, 100.0, 14)))  # s, over which a field is followed
_LEAST = 7e-4  # singular values below that share of the largest are left out
_LEAST_PORT = 0.03  # of the largest, below which a combination of flows is hardly seen
_GROWTH = 1.1  # times the norm of a field's states, the root of what they store: a new network has no more

_BLAS = ThreadpoolController()


@lru_cache(maxsize=1024)
def carried(before: BodyField, after: BodyField, patterns: int) -> np.ndarray:
    """(n after, n before): the field on the states of a network with other places.

    The field on the new states is the one that the places of both will see alike from then on, left alone: their
    temperatures at AFTERWARDS, by least squares. What the object has of its own stays as it is, and so does heat: it is
    all in the mean temperature's state.
    Singular values count the less the nearer they are to those that are left out: round-off decides nothing."""
    own = min(before.own, after.own)
    matrix = np.zeros((len(after.rates), len(before.rates)))
    matrix[:own, :own] = np.eye(own)
    common = [place for place in before.places if place in after.places]
    if not common:
        return matrix
    if own > 1:
        matrix[own:, own:] = _by_rates(before, after, common, patterns)
        return matrix
    source, target = (_future(field, common, patterns) for field in (before, after))
    with _BLAS.limit(limits=1, user_api="blas"):  # or the number of threads would decide last bits
        left, values, right = np.linalg.svd(target, full_matrices=False)
    kept = values > _LEAST * values[0]
    share = (1 - (_LEAST * values[0] / values[kept]) ** 2) / values[kept]
    matrix[1:, 1:] = (right[kept].T * share) @ (left[:, kept].T @ source)
    return matrix


def _by_rates(before: BodyField, after: BodyField, common: list[Place], patterns: int) -> np.ndarray:
    """(n after, n before) of what fades sooner than the states that an object has wherever it is touched: at the same
    rates whatever the places are, so that the states of one rate tell what the common places see of it."""
    old, new = (field.rates[field.own :] for field in (before, after))
    seen, wanted = (_seen(field, common, patterns)[:, field.own :] for field in (before, after))
    found = np.zeros((len(new), len(old)))
    for rate in np.unique(new):
        was, now = np.flatnonzero(old == rate), np.flatnonzero(new == rate)
        if len(was):
            found[np.ix_(now, was)] = np.linalg.pinv(wanted[:, now], rcond=_LEAST_PORT) @ seen[:, was]
    return found


def carried_states(before: BodyField, after: BodyField, patterns: int, states: np.ndarray) -> np.ndarray:
    """(n after,) the field of those states (n before,), on the states of a network with other places.

    The sum of their squares is what a passive network stores, which nothing but heat from outside makes grow. Networks
    with few states tell a field a little differently, but least squares may let it grow from place to place without
    end. Where the states but the mean would grow by more than _GROWTH, they are made smaller."""
    found = carried(before, after, patterns) @ states
    stored, now = float(np.linalg.norm(states[1:])), float(np.linalg.norm(found[1:]))
    if now > _GROWTH * stored:
        found[1:] *= _GROWTH * stored / now
    return found


def _seen(field: BodyField, common: list[Place], patterns: int) -> np.ndarray:
    """(temperatures, n) of the places' patterns and rings."""
    at = [field.places.index(place) for place in common]
    seen = [field.port(place, patterns) for place in at]
    if field.beside.size:
        seen += [field.in_rings(place) for place in at]
    return np.concatenate(seen, axis=1).T


def _future(field: BodyField, common: list[Place], patterns: int) -> np.ndarray:
    """(temperatures, n - 1) of the places' patterns at AFTERWARDS, each weighted by the time that it stays."""
    ports = _seen(field, common, patterns).T[1:]
    faded = np.exp(-np.outer(field.rates[1:], AFTERWARDS)) * np.sqrt(np.maximum(AFTERWARDS, AFTERWARDS[1]))
    return (ports[:, :, None] * faded[:, None, :]).reshape(len(ports), -1).T
