"""How an object's field survives a change of the places through which its network is seen.

n: states, M: patterns of a contact, K: rates, P: ports.
"""

from __future__ import annotations

import numpy as np
from threadpoolctl import ThreadpoolController

from ....thermal.padded import RINGS
from .bodies import BodyField
from .by_rate import by_rate

_HARDLY = 0.045  # of what is seen best, by temperature: a flow that is seen so little counts half
_GROWTH = 1.1  # times the norm of a field's states, the root of what they store: a new network has no more

_BLAS = ThreadpoolController()


def carried_states(before: BodyField, after: BodyField, patterns: int, states: np.ndarray) -> np.ndarray:
    """(n after,) the field of those states (n before,), on the states of a network with other places.

    What the object has of its own wherever it is touched stays as it is, and so does heat: it is all in the mean
    temperature's state. What fades sooner does so at rates that are the same whatever the places are: the states x of a
    rate are those by which the common places see of it what they saw, w, and else the smallest: less of what is stored
    cannot be there. With A what these places see of the new states and G = A A^T they are A^T G (G^2 + r^2)^-1 w: least
    squares for flows that are well seen, and nothing for those that hardly are, with r _HARDLY^2 of G's norm.

    The sum of their squares is what a passive network stores, which nothing but heat from outside makes grow. Networks
    with few states tell a field a little differently, and least squares might let it grow from place to place without
    end. Where the states but the mean would grow by more than _GROWTH, they are made smaller."""
    found, modal = np.zeros(len(after.rates)), min(before.modal, after.modal)
    found[:modal] = states[:modal]
    saw, sees = (by_rate(*each) for each in _common(before, after, patterns))
    if sees.seen.size:
        wanted = np.zeros(sees.seen.shape[:2])
        _, was, now = np.intersect1d(saw.rates, sees.rates, return_indices=True)
        wanted[now] = np.einsum("kpc,kc->kp", saw.seen[was], saw.of(states)[was])
        there = sees.states >= 0
        found[sees.states[there]] = _nearest(sees.seen, wanted)[there]
    stored, now = float(np.linalg.norm(states[1:])), float(np.linalg.norm(found[1:]))
    if now > _GROWTH * stored:
        found[1:] *= _GROWTH * stored / now
    return found


def _nearest(seen: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """(K, C) states of which ports, seen (K, P, C), tell what is wanted (K, P)."""
    with _BLAS.limit(limits=1, user_api="blas"):  # or the number of threads would decide last bits
        gram = seen @ seen.swapaxes(1, 2)
        square = gram @ gram
        port, trace = np.arange(gram.shape[1]), np.trace(square, axis1=1, axis2=2)
        square[:, port, port] += np.where(trace > 0, _HARDLY**4 * trace, 1.0)[:, None]
        flows = np.linalg.solve(square, gram @ wanted[..., None])[..., 0]
    return np.einsum("kpc,kp->kc", seen, flows)


def _common(
    before: BodyField, after: BodyField, patterns: int
) -> tuple[tuple[BodyField, np.ndarray], tuple[BodyField, np.ndarray]]:
    """Both fields, each with (n, P) of the common places' ports that both have."""
    numbers, faces, rings = {place: m for m, place in enumerate(after.places)}, [], []
    for n, place in enumerate(before.places):
        m = numbers.get(place, -1)
        if m < 0:
            continue
        whole = before.whole[n] and after.whole[m]
        faces += [(n * patterns + p, m * patterns + p) for p in range(patterns if whole else 1)]
        if whole and before.beside.size:
            rings += [(n * RINGS + r, m * RINGS + r) for r in range(RINGS)]
    seen = []
    for number, field in enumerate((before, after)):
        of_faces = field.ports[:, [pair[number] for pair in faces]]
        of_rings = field.beside[:, [pair[number] for pair in rings]] if rings else of_faces[:, :0]
        seen.append((field, np.concatenate((of_faces, of_rings), axis=1)))
    return seen[0], seen[1]
