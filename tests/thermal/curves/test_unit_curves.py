"""Curves of touches at constant conductance, against solvers that share no code with them."""

from dataclasses import replace

import numpy as np
import pytest

from thermograsp.thermal import material, press, sensor
from thermograsp.thermal.curves import UnitCurves
from thermograsp.thermal.curves.fraction import fraction
from thermograsp.thermal.matter import Layer, Mode, SensorStack
from thermograsp.thermal.plates import Geometry, stack_impedance, stack_profile
from thermograsp.thermal.stack import Backing
from thermograsp.thermal.stack.cells import layers_chain

SEED = sensor("seed")
assert isinstance(SEED, SensorStack)
PLATE = (0.04, 0.04, 0.01)
T = np.array([0.1, 0.5, 2.0])


def expected(name: str, stack: SensorStack, mode: Mode, conductance: float) -> np.ndarray:
    """K of 12 K, by the semi-analytic rung."""
    found = press(
        name,
        sensor=stack,
        mode=mode,
        object_size=PLATE,
        conductance=conductance,
        seconds=2.0,
        dt=0.1,
        rung="semi_analytic",
    )
    return np.interp(T, found.t, found.temperature_drop)


def test_a_continued_fraction_is_the_solution_of_the_equations() -> None:
    rng = np.random.default_rng(0)
    half = rng.standard_normal((3, 9, 9)) + 0.3j * rng.standard_normal((3, 9, 9))
    impedance = half @ half.transpose(0, 2, 1) / 9 + np.eye(9)
    read = rng.standard_normal((3, 9)) + 1j * rng.standard_normal((3, 9))
    resistance = np.array([10.0, 1.0, 0.02])
    flow, output = fraction(impedance, read)(resistance)
    for row, one in enumerate(resistance):
        flows = np.linalg.solve(impedance + one * np.eye(9), np.tile(np.eye(9)[:, :1], (3, 1, 1)))[..., 0]
        np.testing.assert_allclose(flow[row], flows[:, 0], rtol=1e-9)
        np.testing.assert_allclose(output[row], np.sum(read * flows, axis=1), rtol=1e-9)
    alone = np.array([np.diag([2.0 + 1j, 3.0, 4.0])])  # the recursion ends at once
    flow, output = fraction(alone, np.ones((1, 3)))(np.array([0.25]))
    np.testing.assert_allclose([flow, output], [[[1 / (2.25 + 1j)]]] * 2, rtol=1e-12)


@pytest.mark.parametrize(
    ("mode", "name", "conductance", "within"),
    [
        ("T", "wood", 2e4, 1e-4),
        ("T", "stainless_steel", 1e4, 1e-4),
        ("O", "glass", 3e3, 1e-3),
    ],
)
def test_curves_are_those_of_the_semi_analytic_solution(
    mode: Mode, name: str, conductance: float, within: float
) -> None:
    unit = UnitCurves(Geometry(SEED, material("glass"), mode, 81e-6, "square", PLATE), T)
    found = 12 * unit.on(material(name))(np.array([conductance]))[0]
    np.testing.assert_allclose(found, expected(name, SEED, mode, conductance), atol=within)


def test_layers_of_other_properties_are_followed() -> None:
    """Those of a sensed layer between which a fit goes to and fro."""
    layers = list(SEED.layers)
    layer = layers[SEED.sensed]
    layers[SEED.sensed] = replace(
        layer, conductivity=1.25 * layer.conductivity, specific_heat=1.16 * layer.specific_heat
    )
    other = replace(SEED, layers=tuple(layers))
    glass = material("glass")
    unit = UnitCurves(Geometry(SEED, glass, "T", 81e-6, "square", PLATE), T)
    found = 12 * unit.on(glass)(np.array([8e3]), other)[0]
    np.testing.assert_allclose(found, expected("glass", other, "T", 8e3), atol=12 * 3e-5)


def test_before_the_touch_there_is_nothing_and_conductances_do_not_mix() -> None:
    glass, t = material("glass"), np.array([-0.5, 0.0, 0.2, 1.0])
    on = UnitCurves(Geometry(SEED, glass, "T", 81e-6, "square", PLATE), t, 30.0).on(glass)
    both, alone = on(np.array([1e3, 2e4])), on(np.array([2e4]))
    assert (both[:, :2] == 0).all() and (both[:, 2:] > 0).all()
    np.testing.assert_allclose(both[1:], alone, rtol=1e-12)


def test_a_chain_is_seen_as_its_layers_are() -> None:
    """Eight intervals a layer, so within a percent where heat enters a quarter of a layer; exact where it settles."""
    layers = (Layer("block", 2e-3, 0.5, 1500.0, 1200.0), Layer("plate", 1e-3, 20.0, 500.0, 7800.0))
    backing = Backing(capacity=3e3, loss=80.0)
    chain, nodes = layers_chain(layers, backing, ())
    s = np.array([1e-9, 1e-2, 0.1, 1.0], complex)
    seen, arrived = chain.seen(s, chain.back)
    behind = 1 / (s * backing.capacity + backing.loss)
    exact = stack_impedance(layers[::-1], behind[:, None], s[:, None], np.zeros(1))[:, 0]
    profile, _ = stack_profile(layers[::-1], behind[:, None], s[:, None], np.zeros(1))
    np.testing.assert_allclose(seen, exact, rtol=0.01)
    np.testing.assert_allclose(arrived, (profile[-1] / profile[0])[:, 0], atol=0.01)
    resistance = sum(layer.thickness / layer.conductivity for layer in layers)
    assert seen[0].real == pytest.approx(resistance + 1 / backing.loss, rel=1e-4)
    assert chain.seen(s)[1] == pytest.approx(np.ones(4)) and len(nodes) == 4
