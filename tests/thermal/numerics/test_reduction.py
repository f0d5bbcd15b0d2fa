"""Interpolating networks and balanced truncation: exact where they must be, within the bound elsewhere."""

import numpy as np
import pytest

from thermograsp.thermal import ThermalNetwork
from thermograsp.thermal.numerics import Sampled, hankel_values, interpolate


def random_network(rng: np.random.Generator, order: int = 30, ports: int = 3) -> ThermalNetwork:
    rates = np.exp(rng.uniform(np.log(1e-2), np.log(1e3), order))
    return ThermalNetwork(
        rates, rng.normal(size=(order, ports)) * rates[:, None] ** 0.3, np.zeros((ports, ports))
    )


def sampled(network: ThermalNetwork, s: np.ndarray) -> Sampled:
    slope = -np.einsum("kp,sk,kr->spr", network.ports, (s[:, None] + network.rates) ** -2.0, network.ports)
    return Sampled(network.impedance(s), slope)


@pytest.mark.parametrize("seed", range(3))
def test_interpolates_every_sample(seed: int) -> None:
    rng = np.random.default_rng(seed)
    network, s = random_network(rng), np.geomspace(1e-2, 1e3, 7)
    row = rng.normal(size=network.order)
    outputs = {"row": np.einsum("k,sk,kp->sp", row, 1 / (s[:, None] + network.rates), network.ports)}
    rates, ports, rows = interpolate(s, sampled(network, s), outputs)
    made = ThermalNetwork(rates, ports, np.zeros((3, 3)), rows)
    np.testing.assert_allclose(made.impedance(s), network.impedance(s), rtol=1e-6, atol=1e-6)
    seen = np.einsum("k,sk,kp->sp", made.outputs["row"], 1 / (s[:, None] + rates), ports)
    np.testing.assert_allclose(seen, outputs["row"], rtol=1e-5, atol=1e-5)
    assert rates.min() >= network.rates.min() * (1 - 1e-9) and rates.max() <= network.rates.max() * (1 + 1e-6)


def test_recovers_a_network_with_fewer_states_than_samples() -> None:
    network = ThermalNetwork(np.array([0.1, 2.0, 30.0]), np.array([[1.0], [2.0], [3.0]]), np.zeros((1, 1)))
    rates, ports, _ = interpolate(
        np.geomspace(0.05, 100, 6), sampled(network, np.geomspace(0.05, 100, 6)), {}
    )
    strong = np.abs(ports[:, 0]) > 1e-3
    np.testing.assert_allclose(rates[strong], network.rates, rtol=1e-5)
    np.testing.assert_allclose(np.abs(ports[strong, 0]), network.ports[:, 0], rtol=1e-5)


@pytest.mark.parametrize("seed", range(5))
def test_truncation_keeps_its_bound_at_random_frequencies(seed: int) -> None:
    rng = np.random.default_rng(seed)
    network = random_network(rng)
    values, _ = hankel_values(network.rates, network.ports)
    s = np.concatenate((1j * np.exp(rng.uniform(-8, 10, 100)), np.exp(rng.uniform(-8, 10, 50))))
    for order in (2, 6, 15):
        small = network.reduced(order=order)
        error = np.linalg.norm(small.impedance(s) - network.impedance(s), 2, axis=(1, 2)).max()
        bound = 2 * values[order:].sum()
        assert error <= bound * (1 + 1e-9) + 1e-12
        assert np.all(small.rates >= 0)
        chosen = network.reduced(tolerance=bound * 1.0001)
        assert chosen.order <= order


def test_reduction_keeps_the_mean_temperature() -> None:
    rng = np.random.default_rng(9)
    moving = random_network(rng)
    network = ThermalNetwork(
        np.append(0.0, moving.rates), np.vstack((np.full((1, 3), 0.4), moving.ports)), np.zeros((3, 3))
    )
    small = network.reduced(order=4)
    assert small.order == 4 and small.rates[0] == 0
    np.testing.assert_array_equal(small.ports[0], network.ports[0])
