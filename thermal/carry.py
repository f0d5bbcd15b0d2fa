"""A fingertip's field carried from one object's network to another's.

Each material's network keeps the fingertip's field on a basis of its own, so a fingertip that goes from one object to
the next changes coordinates. What both understand is what it would show from then on, left alone: its temperature drop
and the temperature of its face. The carried field is the one whose drop and face temperature follow the old one's most
closely at TIMES, with the stored heat exactly the same. Matching their values at one moment alone is not enough: fields
that agree in all three there may differ by kelvins a second later.

s: states of one fingertip.
"""

from __future__ import annotations

import numpy as np

from thermograsp.errors import InvalidValueError

from .system import ContactSystem

LEAST_STATES = 6  # of a fingertip, with which any field that an object leaves in it is kept within 5 mK
TIMES = np.concatenate(([0.0], np.geomspace(0.005, 5.0, 13)))  # s
_LEAST_WEIGHT = 1e-6  # singular values below that share of the largest are left out


def carry_matrix(source: ContactSystem, target: ContactSystem) -> np.ndarray:
    """(s of target, s of source): a fingertip's states on the target's basis from those on the source's. The element's
    stored heat stays the same to round-off. Raises InvalidValueError in O mode, where fingertips have no states."""
    heat, future = _watched(source)
    own_heat, own_future = _watched(target)
    # The least field with that heat, and what may be added to it without changing the heat.
    least = np.outer(own_heat, heat) / (own_heat @ own_heat)
    free = np.linalg.svd(own_heat[None])[2][1:].T
    added = np.linalg.lstsq(own_future @ free, future - own_future @ least, rcond=_LEAST_WEIGHT)[0]
    return least + free @ added


def _watched(system: ContactSystem) -> tuple[np.ndarray, np.ndarray]:
    """Rows on one fingertip's states: stored heat (s,) J, and drop and face temperature (2 TIMES, s) K at TIMES from
    now."""
    states = system.orders.sensor
    if states == 0:
        raise InvalidValueError("in O mode the elements stay on their objects: there is nothing to carry")
    first = system.orders.even + (system.orders.odd or 0)
    own = slice(first, first + states)
    decay = np.exp(-TIMES[:, None] * system.rates[own])
    return system.element_heat[0, own], np.vstack(
        (system.drop[0, own] * decay, system.sensor_surface[0, own] * decay)
    )
