"""Thermal networks: what they refuse, and that they conduct."""

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.thermal import ThermalNetwork
from thermograsp.thermal.matter.materials import material
from thermograsp.thermal.matter.sensors import sensor
from thermograsp.thermal.network.system import sample_geometry
from thermograsp.thermal.numerics.laplace import invert
from thermograsp.thermal.plates.samples import Geometry


def geometry(mode: str = "T", name: str = "glass", fingertips: int = 1) -> Geometry:
    return Geometry(sensor("seed"), material(name), mode, 6e-5, "square", (0.04, 0.04, 0.01), fingertips)  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize(
    ("rates", "ports", "direct", "outputs", "message"),
    [
        ([1.0], [[1.0], [2.0]], [[0.0]], {}, "do not fit"),
        ([1.0], [[1.0]], [[0.0, 0.0]], {}, "direct must be"),
        ([np.nan], [[1.0]], [[0.0]], {}, "finite"),
        ([-1.0], [[1.0]], [[0.0]], {}, "rates must be >= 0"),
        ([1.0], [[1.0]], [[-1.0]], {}, "non-negative"),
        ([1.0], [[1.0, 1.0]], [[1.0, 2.0], [0.0, 1.0]], {}, "symmetric"),
        ([1.0], [[1.0]], [[0.0]], {"drop": [1.0, 2.0]}, "'drop'"),
    ],
)
def test_refuses_what_is_no_network(rates, ports, direct, outputs, message: str) -> None:
    with pytest.raises(InvalidValueError, match=message):
        ThermalNetwork(np.array(rates), np.array(ports), np.array(direct), outputs)


@pytest.mark.parametrize(
    "keywords", [{}, {"order": 2, "tolerance": 1.0}, {"order": -1}, {"order": 9}, {"tolerance": 0.0}]
)
def test_reduced_refuses(keywords) -> None:
    network = ThermalNetwork(np.array([0.0, 1.0, 2.0]), np.ones((3, 1)), np.zeros((1, 1)))
    with pytest.raises(InvalidValueError):
        network.reduced(**keywords)


@pytest.mark.parametrize("mode", ["T", "O"])
@pytest.mark.parametrize("fingertips", [1, 2])
def test_bodies_are_passive(mode: str, fingertips: int) -> None:
    samples = sample_geometry(geometry(mode, fingertips=fingertips))
    rng = np.random.default_rng(0)
    for name, network in samples.networks(4).items():
        assert np.all(network.rates >= 0), name
        if name == "even":  # adiabatic: one uniform temperature, and no other state, never decays
            assert np.sum(network.rates < 1e-9) == 1
        s = 1j * np.geomspace(1e-4, 1e4, 60)
        z = network.impedance(s)
        np.testing.assert_allclose(z, np.swapaxes(z, 1, 2), rtol=0, atol=1e-12 * np.abs(z).max())
        direction = rng.normal(size=4)
        assert np.all(np.einsum("p,spr,r->s", direction, z, direction).real > 0), name


@pytest.mark.parametrize("mode", ["T", "O"])
def test_uniform_pole_is_the_heat_capacity(mode: str) -> None:
    body = geometry(mode)
    even = sample_geometry(body).network("even", 3)
    capacity = body.object_capacity + (body.element_capacity if mode == "O" else 0)
    s = 1e-11
    assert (s * even.impedance(s)[0, 0]).real == pytest.approx(1 / capacity, rel=1e-7)
    still = np.argmin(even.rates)
    assert even.ports[still, 0] ** 2 == pytest.approx(1 / capacity, rel=1e-12)
    # one kelvin everywhere stores each body's capacity
    warm = np.zeros(even.order)
    warm[still] = np.sqrt(capacity)
    assert even.outputs["object"] @ warm == pytest.approx(body.object_capacity, rel=1e-12)


def test_step_response_is_the_inverse_transform() -> None:
    network = sample_geometry(geometry()).network("even", 2)
    t = np.array([0.01, 0.3, 5.0, 100.0])
    inverted = invert(lambda s: network.impedance(s) / s[..., None, None], t)
    np.testing.assert_allclose(network.step_response(t), inverted, rtol=1e-9, atol=1e-10)


def test_projection_stays_passive_and_interpolates_its_span() -> None:
    network = sample_geometry(geometry()).network("sensor", 2)
    s = np.array([0.1, 3.0])
    states = np.concatenate([network.ports / (at + network.rates)[:, None] for at in s], axis=1)
    small = network.projected(np.linalg.qr(states)[0])
    assert np.all(small.rates >= 0) and small.order == 4
    np.testing.assert_allclose(small.impedance(s), network.impedance(s), rtol=1e-8, atol=1e-9)
