"""The tables of array_step: what a step multiplies, worked out once in float64.

With y the complex heat flows at the poles, a step of coupling.py is linear before and after its solve:

    v = u - pole P' S x                the driving differences, K; P' (1 - dt rates S) = pole P' S needs no subtraction
    (1 + dt H G) y = H v               M equations a pole pair
    x <- x + (R - 1) x - 2 dt Re sum w S P y     R the propagator of a state that no contact touches

so that products of tables are all that is left. R is near 1 for slow states; R - 1 keeps its digits in float32. Every
table has a leading axis T of networks.

T: networks, K: states of the largest, F: fingertips, P: modes of a contact, M = F P: ports, Q: pole pairs.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..network import POLES, WEIGHTS
from ..numerics import Array, as_like
from .rows import HeatTables


class ArrayTables(NamedTuple):
    """Networks for steps of one length, in a namespace, dtype and device; a pytree of arrays.

    decay: (T, K), R - 1 of each state. hear: (T, K, 2 M Q + 1), from the states to the real, then the imaginary
    parts of the driving differences K, and to the air's part of the loss W. gram: (T, 2, M, M, Q) K/W, dt G. push:
    (T, 2, M, Q, K + F + 1), from the flows' real and imaginary parts to the states, the mean flows of the step W and
    the loss to the air W. read: (T, K, 4 F + 1), from the states to drop, element_heat, sensor_rise, object_rise and
    object_heat. settled: (T, K), 0 at the states that an object at one temperature has at 0, 1 at the others.
    """

    decay: Array
    hear: Array
    gram: Array
    push: Array
    read: Array
    settled: Array


def array_tables(tables: HeatTables, like: Array) -> ArrayTables:
    """The tables in the namespace, dtype and device of the array `like`, which holds floating-point numbers."""
    most = int(tables.modes.max())
    networks = [
        _network(HeatTables(tables.dt, *(array[i] for array in tables[1:])), most)
        for i in range(len(tables.sizes))
    ]
    return ArrayTables(*(as_like(np.stack(arrays), like) for arrays in zip(*networks, strict=True)))


def _network(network: HeatTables, most: int) -> tuple[np.ndarray, ...]:
    """The tables of one network, in the order of ArrayTables. most: modes of the largest network."""
    fingertips, states = network.drop.shape
    modes, pairs, dt = int(network.modes), len(POLES), network.dt
    # a contact's ports begin at f P whatever the network's own number of modes
    place = np.concatenate([f * most + np.arange(modes) for f in range(fingertips)])
    count = fingertips * most
    ports = np.zeros((count, states))
    ports[place] = network.ports[: fingertips * modes]
    gram = np.zeros((pairs, count, count), complex)
    gram[:, place[:, None], place] = network.gram[:, : fingertips * modes, : fingertips * modes]
    scale = network.scale_real + 1j * network.scale_imag  # (Q, K)
    lags = WEIGHTS / POLES

    seen = np.einsum("q,qk,jk->kjq", POLES, scale, ports)
    lost = network.air_loss * (1 + 2 * dt * network.rates * np.real(lags @ scale))
    hear = np.concatenate((_parts(seen, 1).reshape(states, -1), lost[:, None]), axis=1)
    moved = -2 * dt * np.einsum("q,qk,jk->jqk", WEIGHTS, scale, ports)
    first = np.zeros((fingertips, count))
    first[np.arange(fingertips), np.arange(fingertips) * most] = 1.0
    flow = -2 * np.einsum("q,fj->jqf", lags, first)
    loss = -2 * dt * np.einsum("q,qk,jk,k->jq", lags, scale, ports, network.air_loss)[..., None]
    pushed = np.concatenate((moved, flow, loss), axis=-1)
    rows = (
        network.drop,
        network.element_heat,
        network.sensor_surface,
        network.object_surface,
        network.object_heat[None],
    )
    settled = np.ones(states)
    settled[: network.object_states] = 0.0
    settled[network.mean] = 1.0
    return (
        2 * dt * network.rates * np.real(WEIGHTS @ scale),
        hear,
        dt * _parts(gram.transpose(1, 2, 0), 0),
        np.stack((np.real(pushed), -np.imag(pushed))),
        np.concatenate(rows).T,
        settled,
    )


def _parts(values: np.ndarray, axis: int) -> np.ndarray:
    """Real and imaginary parts along a new axis."""
    return np.stack((np.real(values), np.imag(values)), axis=axis)
