"""A fingertip's field carried from one object's network to another's.

Each material's network keeps the fingertip's field on a basis of its own, so a fingertip that goes from one object to
the next changes coordinates. What both understand is what it would show from then on, left alone: its temperature drop
and the temperature of its face, and of the pad around it. The carried field is the one whose drop and temperatures
follow the old one's most closely at TIMES, with the stored heat exactly the same. Matching their values at one moment
alone is not enough: fields that agree in all of them there may differ by kelvins a second later.

s: states of one fingertip.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermograsp.errors import InvalidValueError

from ..network import ContactSystem
from ..padded import RING_PORTS

LEAST_STATES = 6  # of a fingertip, with which any field that an object leaves in it is kept within 5 mK
TIMES = np.concatenate(([0.0], np.geomspace(0.005, 5.0, 13)))  # s
_LEAST_WEIGHT = 1e-6  # singular values below that share of the largest are left out


@dataclass(frozen=True, slots=True)
class TipRows:
    """What the states (s,) of one fingertip tell. rates: 1/s. heat: J in its element. drop and face: K, the temperature
    drop and the temperature of its face. beside: (R, s) K of the pad's front around it, R = 0 without one."""

    rates: np.ndarray
    heat: np.ndarray
    drop: np.ndarray
    face: np.ndarray
    beside: np.ndarray

    @property
    def future(self) -> np.ndarray:
        """((2 + R) TIMES, s) K: the drop and temperatures of the front at TIMES from now."""
        decay = np.exp(-TIMES[:, None] * self.rates)
        return np.vstack((self.drop * decay, self.face * decay, *(row * decay for row in self.beside)))


def carry_matrix(source: TipRows, target: TipRows) -> np.ndarray:
    """(s of target, s of source): a fingertip's states on the target's basis from those on the source's. The element's
    stored heat stays the same to round-off."""
    heat, target_heat = source.heat, target.heat
    # The least field with that heat, and what may be added to it without changing the heat.
    least = np.outer(target_heat, heat) / (target_heat @ target_heat)
    free = np.linalg.svd(target_heat[None])[2][1:].T
    target_future = target.future
    added = np.linalg.lstsq(target_future @ free, source.future - target_future @ least, rcond=_LEAST_WEIGHT)[
        0
    ]
    return least + free @ added


def carry_steps(systems: Sequence[ContactSystem], states: int) -> tuple[np.ndarray, np.ndarray]:
    """(leave (T, K, J), enter (T, J, K)), K = states: from the states of one of the systems to J numbers that all
    share, and from these to the states of another. Their product is the carry_matrix of every fingertip by way of the
    system whose fingertips have most states, and leaves the object at its first temperature. In O mode, where a
    fingertip has no states, J is 0 and everything is."""
    between = max(systems, key=lambda system: system.orders.sensor)
    shared, fingertips = between.orders.sensor, between.geometry.fingertips
    leave = np.zeros((len(systems), states, fingertips * shared))
    enter = np.zeros((len(systems), fingertips * shared, states))
    if shared == 0:
        return leave, enter
    for i, system in enumerate(systems):
        sensor_states, first = system.orders.sensor, len(system.rates) - fingertips * system.orders.sensor
        rows, shared_rows = tip_rows(system), tip_rows(between)
        out, back = carry_matrix(rows, shared_rows), carry_matrix(shared_rows, rows)
        for f in range(fingertips):
            of_tip = slice(first + f * sensor_states, first + (f + 1) * sensor_states)
            of_body = slice(f * shared, (f + 1) * shared)
            leave[i, of_tip, of_body], enter[i, of_body, of_tip] = out.T, back.T
    return leave, enter


def tip_rows(system: ContactSystem) -> TipRows:
    """The rows of a contact system's fingertips. Raises InvalidValueError in O mode, where fingertips have no
    states."""
    states = system.orders.sensor
    if states == 0:
        raise InvalidValueError("in O mode the elements stay on their objects: there is nothing to carry")
    first = system.orders.even + (system.orders.odd or 0)
    tip_states = slice(first, first + states)
    rings = np.zeros((0, states))
    if system.geometry.surround is not None:
        rings = -system.ports[tip_states, : system.modes][:, RING_PORTS.start : RING_PORTS.start + 1].T
    return TipRows(
        system.rates[tip_states],
        system.element_heat[0, tip_states],
        system.drop[0, tip_states],
        system.sensor_surface[0, tip_states],
        rings,
    )
