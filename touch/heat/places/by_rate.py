"""What the ports of an object's network see of its states, those of one rate at a time.

n: states, P: ports, K: rates, C: most states of one rate.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .bodies import BodyField


class ByRate(NamedTuple):
    """Of the states that are not the object's wherever it is touched. rates: (K,) 1/s, ascending. states: (K, C) their
    numbers, -1 behind the last of a rate. seen: (K, P, C) by ports, zeros there."""

    rates: np.ndarray
    states: np.ndarray
    seen: np.ndarray

    def of(self, states: np.ndarray) -> np.ndarray:
        """(K, C) of states (n,), zeros behind the last of a rate."""
        return np.where(self.states < 0, 0.0, states[self.states])


def by_rate(field: BodyField, ports: np.ndarray) -> ByRate:
    """ports: (n, P) of all states of the field."""
    order = field.modal + np.argsort(field.rates[field.modal :], kind="stable")
    rates, first, count = np.unique(field.rates[order], return_index=True, return_counts=True)
    row = np.repeat(np.arange(len(rates)), count)
    states = np.full((len(rates), int(count.max(initial=0))), -1)
    states[row, np.arange(len(order)) - first[row]] = order
    seen = np.where(states[..., None] < 0, 0.0, ports[states])
    return ByRate(rates, states, seen.swapaxes(1, 2))
