"""Coupled stepping: exactness, order, heat balance and range of temperatures for any history of the contact."""

import os
from functools import cache

import numpy as np
import pytest
from numba import njit
from scipy.linalg import expm

from thermograsp.thermal.matter.materials import material
from thermograsp.thermal.matter.sensors import sensor
from thermograsp.thermal.network.coupling import (
    POLES,
    WEIGHTS,
    propagator,
    step,
)
from thermograsp.thermal.network.kernel import advance, step_arrays, workspace
from thermograsp.thermal.network.states import Orders
from thermograsp.thermal.network.system import ContactSystem, contact_system, sample_geometry
from thermograsp.thermal.plates.samples import Geometry

PROPAGATOR_ERROR = 3e-6
HISTORIES = int(os.environ.get("THERMOGRASP_HISTORIES", "2000"))  # 100000 for the long run


@cache
def system(mode: str = "T", name: str = "glass", fingertips: int = 1, modes: int = 2) -> ContactSystem:
    geometry = Geometry(sensor("seed"), material(name), mode, 6e-5, "square", (0.04, 0.04, 0.01), fingertips)  # pyright: ignore[reportArgumentType]
    orders = Orders(modes, 8 if mode == "T" else 0, 10, 8 if fingertips == 2 else None)
    return contact_system(sample_geometry(geometry), orders)


def test_propagator_is_within_its_error_of_the_exponential_everywhere() -> None:
    z = np.concatenate(([0.0], np.geomspace(1e-12, 1e12, 20001)))
    phi = -2 * (WEIGHTS / (POLES + z[:, None])).sum(axis=1).real  # (1 - exp(-z)) / z
    error = np.abs(1 - z * phi - np.exp(-z))
    # r(-z) is 1 at 0 and 0 at infinity to round-off: heat balances and stiff states leave nothing behind
    assert phi[0] == pytest.approx(1, abs=1e-14)
    assert z[-1] * phi[-1] == pytest.approx(1, abs=1e-10)
    assert np.all(error <= PROPAGATOR_ERROR * np.minimum(1, z) + 2e-16)


@pytest.mark.parametrize("mode", ["T", "O"])
@pytest.mark.parametrize("conductance", [0.0, 1e2, 1e4, 1e6, 1e9])
@pytest.mark.parametrize("dt", [1e-3, 0.1, 10.0])
def test_exact_while_the_conductance_stands_still(mode: str, conductance: float, dt: float) -> None:
    """Against expm of the coupled system with its source as one more state. The error is the propagator's on each of
    the symmetric system's eigenvectors, so on the distance from equilibrium."""
    made = system(mode)
    n, m = made.ports.shape
    weight, difference = np.full(m, conductance * 6e-5), np.eye(m)[0] * 12.0
    matrix = np.zeros((n + 1, n + 1))
    matrix[:n, :n] = -(np.diag(made.rates) + (made.ports * weight) @ made.ports.T)
    matrix[:n, n] = made.ports @ (weight * difference)
    start = np.random.default_rng(0).normal(size=n) * 0.1
    exact = (expm(dt * matrix) @ np.append(start, 1.0))[:n]
    state, _ = step(propagator(made.rates, made.ports, dt), start[None], weight[None], difference[None])
    scale = np.linalg.norm(start) + np.linalg.norm(exact) + 1
    assert np.linalg.norm(state[0] - exact) < 2 * PROPAGATOR_ERROR * scale + 1e-12 * conductance * dt / 1e5


@pytest.mark.parametrize("fingertips", [1, 2])
@pytest.mark.parametrize("mode", ["T", "O"])
def test_compiled_step_is_the_plain_one(mode: str, fingertips: int) -> None:
    made = system(mode, fingertips=fingertips)
    n, m = made.ports.shape
    rng = np.random.default_rng(1)
    for _ in range(40):
        stepper = propagator(made.rates, made.ports, float(np.exp(rng.uniform(-11, 2))))
        arrays = step_arrays(stepper, modes=made.modes, sensor_states=made.orders.sensor)
        state, difference = rng.normal(size=n), rng.normal(size=m)
        weight = np.repeat(np.exp(rng.uniform(-8, 2, fingertips)), made.modes) * rng.integers(0, 2)
        after, flow = step(stepper, state[None], weight[None], difference[None])
        got, compiled = state.copy(), np.zeros(m)
        advance(arrays, got, weight, difference, compiled, workspace(n, m))
        np.testing.assert_allclose(got, after[0], rtol=0, atol=1e-11 * max(1.0, np.abs(state).max()))
        np.testing.assert_allclose(compiled, flow[0], rtol=0, atol=1e-10 * max(1.0, np.abs(flow).max()))


def test_second_order_in_time_for_a_conductance_that_varies() -> None:
    made = system()
    n, m = made.ports.shape
    difference = np.eye(m)[0] * 12.0

    def heat(steps: int) -> float:
        dt = 2.0 / steps
        stepper, state = propagator(made.rates, made.ports, dt), np.zeros((1, n))
        for k in range(steps):
            conductance = 3e3 * (1 + np.sin(2 * (k + 0.5) * dt)) * 6e-5
            state, _ = step(stepper, state, np.full((1, m), conductance), difference[None])
        return float((state @ made.object_heat)[0])

    steps = np.array([40, 80, 160])
    exact = heat(5120)
    error = np.array([abs(heat(int(n)) - exact) for n in steps])
    slope = np.polyfit(np.log(steps), np.log(error), 1)[0]
    assert -slope == pytest.approx(2, abs=0.1)


@njit
def _histories(arrays, rows, room, steps, rng, area, jump, extremes):
    """Largest imbalance of heat, J per J that moved, over histories of random conductance; extremes: (4,) of the two
    surfaces' temperatures."""
    n, m = rows.shape[1], arrays.ports.shape[0]
    state, weight, drive, flow = np.zeros(n), np.zeros(m), np.zeros(m), np.zeros(m)
    drive[0] = jump
    worst = 0.0
    moved = 0.0
    for _ in range(steps):
        kind = int(5 * rng.random())
        level = 0.0 if kind == 0 else (1e9 if kind == 1 else 10.0 ** rng.uniform(1, 7))
        weight[:] = level * area
        before = rows[2] @ state
        advance(arrays, state, weight, drive, flow, room)
        passed = flow[0] * arrays.dt
        moved += abs(passed)
        worst = max(worst, abs(rows[2] @ state - before - passed) / (moved + 1e-3))
        low, high = rows[0] @ state, rows[1] @ state
        extremes[0], extremes[1] = min(extremes[0], low), max(extremes[1], low)
        extremes[2], extremes[3] = min(extremes[2], high), max(extremes[3], high)
    return worst


@pytest.mark.parametrize("mode", ["T", "O"])
@pytest.mark.parametrize("name", ["cotton", "glass", "aluminium"])
def test_heat_balances_and_temperatures_stay_in_range(mode: str, name: str) -> None:
    """Histories of 50 steps, dt from 1e-5 to 10 s, conductances of 0, 1e9 and all between: what flows is what the
    object (in O mode with the element) gains, and no face leaves the range that the bodies started in."""
    made = system(mode, name)
    jump = 12.0
    gained = made.object_heat + (made.element_heat[0] if mode == "O" else 0)
    rows = np.stack((made.sensor_surface[0], made.object_surface[0], gained))
    room = workspace(*made.ports.shape)
    extremes = np.zeros(4)
    rng = np.random.default_rng(2)
    for _ in range(HISTORIES):
        dt = float(10 ** rng.uniform(-5, 1))
        stepper = propagator(made.rates, made.ports, dt)
        arrays = step_arrays(stepper, modes=made.modes, sensor_states=made.orders.sensor)
        assert _histories(arrays, rows, room, 50, rng, made.geometry.area, jump, extremes) < 1e-10
    allowed = 0.005  # K, the smallest tolerance that is promised
    assert extremes[0] >= -jump - allowed and extremes[1] <= allowed
    assert extremes[2] >= -allowed and extremes[3] <= jump + allowed
