"""Which places of an object are forgotten: those whose loss changes the field least.

P: ports, K: rates.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .bodies import BodyField
from .by_rate import by_rate

MOST_PLACES = 12
"""Of an object that are remembered besides those in use."""
_SOON = 0.5  # s, from when on what is lost counts
_UNFELT, _AT_ONCE = (
    1e-3,
    0.01,
)  # K, that what is lost of a place that is forgotten without need may be felt as; from s on
_RIDGE = 1e-4  # of a port's mean square
_ALIKE = 1e-6  # relative: round-off does not decide between places of which as much would be lost


def forgotten(
    field: BodyField, patterns: int, states: np.ndarray, idle: Sequence[int], count: int
) -> list[int]:
    """So many of the idle places at least, by number, and those of whose loss nothing is felt. states: (n,) of the
    field.

    What is stored is the sum of the states' squares. Without a place those states are left that the others' ports
    bring about: by each rate, what is lost is u^T S u, where u are the flows that would make the states and S is what
    is stored by a unit flow that the other places see nothing of, the inverse of the inverse Gram matrix' block. Of
    places as good as each other the first one goes. No state is felt as more than its root times the port's, so that
    what is lost is felt at the place, twice _AT_ONCE later, as the root of its product with the port's square at
    most."""
    if not idle:
        return []
    ports = [n * patterns + m for n, whole in enumerate(field.whole) for m in range(patterns if whole else 1)]
    owner = np.array(ports) // patterns
    rates, _, seen = known = by_rate(field, field.ports[:, ports])
    gram, hears = seen @ seen.swapaxes(1, 2), np.einsum("kpc,kc->kp", seen, known.of(states))
    left, soon = (np.exp(-2 * rates * time) for time in (_SOON, _AT_ONCE))
    diagonal = np.arange(len(ports))
    shown = soon @ gram[:, diagonal, diagonal]
    ridge = _RIDGE * np.trace(gram, axis1=1, axis2=2) / len(ports)
    gram[:, diagonal, diagonal] += ridge[:, None]
    gone: list[int] = []
    while len(gone) < len(idle):
        alive = np.flatnonzero(~np.isin(owner, gone))
        inverse = np.linalg.inv(gram[:, alive[:, None], alive])
        flows = np.einsum("kij,kj->ki", inverse, hears[:, alive])
        # of a place of one port
        by_port = flows**2 / inverse[:, diagonal[: len(alive)], diagonal[: len(alive)]]
        lost = {}
        for n in (n for n in idle if n not in gone):
            members = np.flatnonzero(owner[alive] == n)
            lost[n] = by_port[:, members[0]]
            if len(members) > 1:
                block = np.linalg.solve(inverse[:, members[:, None], members], flows[:, members, None])
                lost[n] = (flows[:, members] * block[..., 0]).sum(axis=1)
        late = {n: float(left @ each) for n, each in lost.items()}
        least = min(late.values()) * (1 + _ALIKE)
        first = next(n for n, each in late.items() if each <= least)
        if len(gone) >= count and soon @ lost[first] * shown[np.argmax(owner == first)] > _UNFELT**2:
            break
        gone.append(first)
    return gone
