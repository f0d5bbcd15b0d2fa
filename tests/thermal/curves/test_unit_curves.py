"""Curves of touches at constant conductance, against solvers that share no code with them."""

from dataclasses import replace

import numpy as np
import pytest

from thermograsp.thermal import material, press, sensor
from thermograsp.thermal.curves import UnitCurves
from thermograsp.thermal.curves.fraction import fraction
from thermograsp.thermal.matter import Layer, Mode, SensorStack
from thermograsp.thermal.plates import Geometry
from thermograsp.thermal.stack import (
    Backing,
    ConstantPower,
    CutAtContact,
    HeatedStack,
    Held,
    Off,
    Place,
    Recorder,
    Sample,
    Touches,
    heated_core,
    heated_stack,
    touch_curves,
)

SEED = sensor("seed")
assert isinstance(SEED, SensorStack)
PLATE = (0.04, 0.04, 0.01)
PLAIN = replace(heated_stack("heated_thermistor"), recorder=Recorder())
BLOCK = (Layer("core", 3e-3, 0.3, 1500.0, 1200.0), *PLAIN.layers)
T = np.array([0.1, 0.5, 2.0])


def expected(
    name: str, stack: SensorStack, mode: Mode, conductance: float, size: tuple[float, float, float] = PLATE
) -> np.ndarray:
    """K of 12 K, by the semi-analytic rung."""
    found = press(
        name,
        sensor=stack,
        mode=mode,
        object_size=size,
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


def test_an_object_as_wide_as_the_sensor_has_no_uneven_flow() -> None:
    size, glass = (SEED.width, SEED.width, 0.01), material("glass")
    unit = UnitCurves(Geometry(SEED, glass, "T", 81e-6, "square", size), T)
    found = 12 * unit.on(glass)(np.array([5e3]))[0]
    np.testing.assert_allclose(found, expected("glass", SEED, "T", 5e3, size), atol=2e-4)


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


@pytest.mark.parametrize(
    "sensor",
    [
        PLAIN,
        replace(PLAIN, law=Held()),
        replace(PLAIN, law=Off(), backing=Backing(capacity=500.0, effusivity=400.0)),
        replace(PLAIN, law=ConstantPower(), backing=Backing()),
        replace(PLAIN, law=CutAtContact(0.1), backing=Backing(capacity=3e3, loss=200.0)),
        replace(PLAIN, layers=BLOCK, heater=Place(0, 0.98), readout=Place(0, 0.94), law=Off()),
        replace(PLAIN, layers=BLOCK, heater=Place(1, 0.0), readout=Place(1, 1.0), law=Off()),
    ],
    ids=["cut", "held", "half-space", "nothing behind", "loss", "read behind", "a block behind"],
)
def test_in_one_dimension_heated_sensors_read_what_a_chain_of_lumps_does(sensor: HeatedStack) -> None:
    """Stepped in 20 ms, which it differs by; the power before is what its loss takes."""
    wood, t = material("wood"), np.arange(0.0, 4.001, 0.02)
    touches = Touches(t, np.full((1, len(t)), 4.0), *(np.array([x]) for x in (32.0, 0.0, 22.0, 22.0)))
    sample = Sample(wood.conductivity, wood.volumetric_heat_capacity, 0.01)
    marched = 32.0 - touch_curves(sensor, [sample], touches).reading[0]
    core = heated_core(sensor, 0.02)
    geometry = Geometry(core.element, wood, "T", core.element.face_area, "square", (0.009, 0.009, 0.01))
    conductance = sensor.contact.at(np.array([4.0]))
    found = 10 * UnitCurves(geometry, t, core=core).on(wood)(conductance)[0]
    assert found[-1] > 0.2
    np.testing.assert_allclose(found, marched, atol=0.01)
