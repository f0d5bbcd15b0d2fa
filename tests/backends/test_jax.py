"""jit, vmap, scan and grad."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from thermograsp import thermal

from ..thermal.heat_cases import Batch, difference_between
from .conftest import Kind

jax = pytest.importorskip("jax", reason="the extra jax is not installed")

CASE = ("O", 2)


def test_jit_vmap_and_scan_are_the_loop(jax_kind: Kind) -> None:
    """A history of touches, scanned in one compiled call, row by row."""
    batch = Batch(CASE, 8)
    tables = thermal.array_tables(batch.tables, jax_kind.float64)
    start, network, difference = map(jax_kind.of, (batch.state, batch.network, batch.difference))
    history = list(batch.steps(15))
    conductances = np.stack([conductance for conductance, _, _ in history], axis=1)

    @jax.jit
    @jax.vmap
    def rows(state: Any, network: Any, conductances: Any, difference: Any):
        def step(state: Any, conductance: Any):
            return thermal.array_step(tables, network, state, conductance, difference)

        return jax.lax.scan(step, state, conductances)

    state, readings = rows(start, network, jax_kind.of(conductances), difference)
    for k, (_, _, expected) in enumerate(history):
        reading = thermal.HeatReading(*(values[:, k] for values in readings))
        assert difference_between(state, reading, history[-1][1], expected) < 1e-12


def test_gradients_are_finite_differences(jax_kind: Kind) -> None:
    """By conductance, also where nothing touches."""
    batch = Batch(CASE, 3)
    list(batch.steps(5))
    tables = thermal.array_tables(batch.tables, jax_kind.float64)
    network, state, difference = map(jax_kind.of, (batch.network, batch.state, batch.difference))

    @jax.jit
    def drop(conductance: Any) -> Any:
        return thermal.array_step(tables, network, state, conductance, difference)[1].drop.sum()

    conductance = np.array([[0.0, 0.3], [2.0, 8.0], [0.0, 0.0]])
    found = np.asarray(jax.jit(jax.grad(drop))(jax_kind.of(conductance)))
    for place in np.ndindex(conductance.shape):
        step = np.zeros_like(conductance)
        step[place] = 1e-5
        slope = float(drop(jax_kind.of(conductance + step)) - drop(jax_kind.of(conductance - step))) / 2e-5
        assert abs(found[place] - slope) < 1e-6 * max(np.abs(found).max(), 1e-3)


def test_gradient_of_voltage_by_force(jax_kind: Kind) -> None:
    """Finite everywhere; 0 where nothing touches, above 0 where something does."""
    tips = thermal.array_fingertips(
        ["glass", "rubber"], dt=0.02, like=jax_kind.float64, tolerance=0.2, chain=thermal.IDEAL
    )
    which = jax_kind.of(np.array([0, 1]))

    def voltage(force: Any) -> Any:
        return tips.step(tips.start(2), tips.conductance(force, which), which)[1].sum()

    slope = np.asarray(jax.jit(jax.grad(voltage))(jax_kind.of(np.array([[0.0, 5.0], [-1.0, 5.0]]))))
    assert np.all(slope[:, 0] == 0) and np.all(slope[:, 1] > 0)
