"""Fingertips that stay on the places where they are, as a pure step of arrays: NumPy, PyTorch, JAX.

B: rows, F: fingertips, N: pairs that touch or have touched, K: states of all their fields, one behind the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermograsp.errors import InvalidValueError

from ....thermal import ArrayTables, HeatTables, array_step, array_tables
from ....thermal.network import propagator
from ....thermal.numerics import Array, as_like


@dataclass(frozen=True, slots=True)
class FixedPlaces:
    """Networks of fingertips at fixed places of objects, for steps of dt s; made by ThermalTouch.fixed_places.
    `advance` is pure: it can be traced, compiled, vectorised and differentiated. Contacts are the sensor's whole face
    wide: what heat has still to spread under a narrower one (narrow.py) must be in its conductance.

    pairs: (fingertip, object), names, in the order of conductances. fingertips: labels, in the order of drops. tables,
    difference (N,) K: what a step needs. state: (K,) where the ThermalTouch was."""

    dt: float
    pairs: tuple[tuple[str, str], ...]
    fingertips: tuple[str, ...]
    tables: ArrayTables
    difference: Array
    state: Array

    def start(self, rows: int) -> Array:
        """(rows, K), each as the ThermalTouch was."""
        return self.state + as_like(np.zeros((rows, 1)), self.state)

    def advance(self, state: Array, conductance: Array) -> tuple[Array, Array]:
        """State (B, K) and temperature drops (B, F) K after dt. conductance: (B, N) W/K of each pair, constant over the
        step, 0 where apart. A row that is not finite spoils no other. Raises InvalidValueError for another number of
        pairs."""
        if conductance.shape[-1] != len(self.pairs):
            raise InvalidValueError(
                f"conductance must end in an axis of {len(self.pairs)} pairs, {self.pairs}, got shape "
                f"{tuple(conductance.shape)}"
            )
        after, reading = array_step(self.tables, 0, state, conductance, self.difference + 0 * conductance)
        first = [next(n for n, pair in enumerate(self.pairs) if pair[0] == tip) for tip in self.fingertips]
        return after, reading.drop[..., np.array(first)]


def fixed_places(
    pairs: Sequence[tuple[str, str]],
    rates: np.ndarray,
    ports: np.ndarray,
    drop: np.ndarray,
    difference: np.ndarray,
    state: np.ndarray,
    dt: float,
    like: Array,
) -> FixedPlaces:
    """pairs: N. rates: (K,) 1/s. ports: (K, N M) sqrt(K/J), as `Propagator` has them. drop: (N, K) of each pair's
    fingertip. difference: (N,) K. state: (K,)."""
    return FixedPlaces(
        dt,
        tuple(pairs),
        tuple(dict.fromkeys(tip for tip, _ in pairs)),
        network_tables(rates[None], ports[None], drop, dt, like),
        as_like(difference, like),
        as_like(state, like),
    )


def network_tables(
    rates: np.ndarray, ports: np.ndarray, drop: np.ndarray, dt: float, like: Array
) -> ArrayTables:
    """Of networks (T) for array_step, in which each of N pairs is a fingertip. rates: (T, K) 1/s. ports: (T, K, N M)
    sqrt(K/J). drop: (N, K) of each pair's fingertip."""
    count, states = rates.shape
    none, still = np.zeros((3, states)), np.zeros((3 * len(drop), states))
    made = [propagator(decay, seen, dt) for decay, seen in zip(rates, ports, strict=True)]
    rows = [
        np.concatenate(
            (one.rates[None], none, drop, still, np.real(one.scale), np.imag(one.scale), one.ports.T)
        )
        for one in made
    ]
    sizes = np.tile([states, states, 0, ports.shape[2] // len(drop), 0], (count, 1))
    return array_tables(HeatTables(dt, sizes, np.array(rows), np.array([one.gram for one in made])), like)
