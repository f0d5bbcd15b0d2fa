"""Identification: curves against other solvers, posteriors against brute force, intervals against fresh objects."""

from dataclasses import replace

import numpy as np
import pytest

from thermograsp import thermal
from thermograsp.bench.identify.bayes_limit import exact_posterior
from thermograsp.bench.identify.touches import (
    SETUP,
    Touches,
    draw,
    draw_objects,
    pressed,
    times,
)
from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.thermal.curves import UnitCurves
from thermograsp.thermal.identification import prior as identify_prior
from thermograsp.thermal.identification.climb import _interpolate
from thermograsp.thermal.identification.library import CurveLibrary

NAMES = ("wood", "plastic", "rubber", "glass")
T = times()


@pytest.fixture(scope="module")
def identifier() -> thermal.Identifier:
    return thermal.Identifier(SETUP, NAMES, touch=0.0)


@pytest.fixture(scope="module")
def touches() -> tuple[Touches, np.ndarray]:
    curves = np.array([pressed(SETUP, name) for name in NAMES])
    return draw(np.random.default_rng(7), SETUP, 60, NAMES, curves), curves


def volts(material: str, difference: float, rng: np.random.Generator, conductance: float = 5e3) -> np.ndarray:
    """(400,) V of a touch, as a converter reports them."""
    one = thermal.material(material)
    unit = UnitCurves(SETUP.geometry(one), T, SETUP.chain.bandwidth).on(one)
    drop = difference * unit(np.array([conductance]))[0]
    chain = replace(SETUP.chain, bandwidth=np.inf)
    noise = rng.standard_normal((1, len(T)))
    return thermal.measure(chain, thermal.settled(np.zeros(1), 1e-3), drop[None], 1e-3, 0.01, noise)[1][0]


def test_between_its_nodes_the_library_is_exact_enough(identifier: thermal.Identifier) -> None:
    """Half a millikelvin of 12 K is a 16th of a sample's noise."""
    library: CurveLibrary = identifier.library
    table, rng = library.objects, np.random.default_rng(1)
    unit = UnitCurves(SETUP.geometry(thermal.material("glass")), T, 30.0)
    basis, seen = library.basis(T), np.zeros((3, library.functions.shape[1]))
    distance = []
    for _ in range(40):
        conductivity, capacity = identify_prior.draw_object(rng)
        effusivity = np.sqrt(conductivity * capacity)
        resistance = np.exp(rng.uniform(*np.log(SETUP.resistance)))
        deviation = np.log(capacity / identify_prior.heat_capacity(effusivity)) / identify_prior.SPREAD
        axis = library.log_effusivity
        _interpolate(
            table.coefficients,
            (np.log(effusivity) - axis[0]) / (axis[1] - axis[0]),
            (table.coefficients.shape[1] - 1) / 2 + deviation / table.capacity_step,
            (np.log(resistance) - table.log_resistance[0]) / table.log_resistance[1],
            seen,
        )
        one = thermal.Material("object", conductivity, capacity, 1.0)
        exact = unit.on(one)(np.array([1 / resistance]))[0]
        distance.append(12 * np.abs(basis @ seen[0] - exact).max())
    assert np.quantile(distance, 0.95) < 5e-4


@pytest.mark.parametrize("seconds", [0.5, 4.0])
def test_materials_are_those_of_brute_force(
    identifier: thermal.Identifier, touches: tuple[Touches, np.ndarray], seconds: float
) -> None:
    """Against every sample's likelihood at 3000 conductances; curves there were stepped by thermal.press."""
    drawn, curves = touches
    exact = exact_posterior(drawn, seconds, curves)
    count = len(times(seconds))
    found = []
    for voltage in drawn.voltage[:, :count]:
        identifier.reset()
        found.append(identifier.update(T[:count], voltage).probability)
    distance = np.abs(np.array(found) - exact).sum(axis=1) / 2
    assert distance.mean() < 0.02
    assert np.quantile(distance, 0.9) < 0.06


@pytest.mark.slow
def test_intervals_hold_nine_of_ten_fresh_objects(identifier: thermal.Identifier) -> None:
    drawn = draw_objects(np.random.default_rng(3), SETUP, 200)
    held = []
    for voltage, effusivity in zip(drawn.voltage, drawn.effusivity, strict=True):
        identifier.reset()
        low, high = identifier.update(T, voltage).effusivity.interval()
        held.append(low <= effusivity <= high)
    assert 0.83 < np.mean(held) < 0.97  # 3 standard deviations of 200 draws


def test_samples_in_parts_are_samples_at_once(identifier: thermal.Identifier) -> None:
    voltage = volts("plastic", 11.0, np.random.default_rng(0))
    identifier.reset()
    whole = identifier.update(T, voltage)
    identifier.reset()
    parts = [identifier.update(T[part], voltage[part]) for part in np.array_split(np.arange(len(T)), 8)]
    entropies = [-(one.probability * np.log(one.probability + 1e-300)).sum() for one in parts]
    now = parts[-1]
    np.testing.assert_allclose(now.probability, whole.probability, rtol=1e-9)
    np.testing.assert_allclose(now.effusivity.interval(), whole.effusivity.interval(), rtol=1e-9)
    assert entropies[-1] < 0.5 * entropies[0]
    assert whole.best == "plastic" and whole.samples == 400
    assert 5e-6 < whole.noise < 1.2e-5


def test_a_touch_is_found_in_the_voltage() -> None:
    rng = np.random.default_rng(2)
    voltage = volts("glass", 12.0, rng)
    before = SETUP.chain.offset + 7.8e-6 * rng.standard_normal(60)
    t = np.arange(1, 461) * 0.01
    setup = replace(SETUP, object_temperature=(24.0, 3.0))
    found = thermal.identify(t, np.concatenate((before, voltage)), setup=setup, candidates=NAMES)
    assert found.touch[0] == pytest.approx(0.6, abs=3e-3)
    assert found.best == "glass" and found.verdict is thermal.Verdict.MATERIAL
    nothing = thermal.identify(t[:60], before, setup=setup, candidates=NAMES)
    assert nothing.verdict is thermal.Verdict.NO_TOUCH and np.isnan(nothing.touch[0])
    np.testing.assert_allclose(nothing.probability, 0.25)


def test_two_fingertips_tell_more_than_one(identifier: thermal.Identifier) -> None:
    rng = np.random.default_rng(4)
    one, other = (volts("rubber", 12.0, rng) for _ in range(2))
    identifier.reset()
    alone = identifier.update(T, one).effusivity.interval()
    identifier.reset()
    both = identifier.update(T, np.stack((one, other), axis=1)).effusivity.interval()
    shrunk = np.log(both[1] / both[0]) / np.log(alone[1] / alone[0])
    assert 0.5 < shrunk < 0.95  # the square root of a half, were the posterior normal


def test_says_when_temperatures_were_too_close(identifier: thermal.Identifier) -> None:
    rng = np.random.default_rng(5)
    for name in NAMES:
        for difference, close in ((0.0, True), (0.02, True), (12.0, False)):
            identifier.reset()
            found = identifier.update(T, volts(name, difference, rng))
            assert (found.verdict is thermal.Verdict.TOO_CLOSE) == close
            assert ("too close" in found.message) == close


def test_says_when_nothing_it_knows_explains_the_curve(identifier: thermal.Identifier) -> None:
    rng = np.random.default_rng(6)
    identifier.reset()
    metal = identifier.update(T, volts("aluminium", 12.0, rng))
    assert metal.verdict is thermal.Verdict.NOT_LISTED
    assert metal.effusivity.interval()[0] > 1e4
    late = volts("glass", 12.0, rng)
    late[200:] *= 0.8  # the contact got worse
    identifier.reset()
    assert identifier.update(T, late).verdict is thermal.Verdict.UNEXPLAINED


@pytest.mark.parametrize(
    ("field", "values"), [("model_error", (0.0, 0.002, 0.01)), ("tolerance", (0.0, 0.02, 0.1))]
)
def test_what_the_model_lacks_widens_the_posterior(field: str, values: tuple[float, ...]) -> None:
    rng = np.random.default_rng(8)
    voltage = volts("glass", 12.0, rng)
    widths = []
    for value in values:
        setup = replace(SETUP, **{field: value})
        low, high = thermal.identify(
            T, voltage, setup=setup, candidates=NAMES, touch=0.0
        ).effusivity.interval()
        widths.append(np.log(high / low))
    assert widths[0] < widths[1] < widths[2]


def test_how_a_contact_opens_does_not_count_where_its_touch_is_found() -> None:
    """Pressed up within 40 ms, as fingers do: a tenth of the conductance at first."""
    drop = volts("stainless_steel", 12.0, np.random.default_rng(10))
    early = T < 0.04
    drop[early] *= 0.1 + 0.9 * T[early] / 0.04
    still = 1e-5 * np.random.default_rng(11).standard_normal(100)
    voltage = np.concatenate((still, drop))
    t = np.concatenate((np.arange(-99, 1) / 100, T))
    found = thermal.identify(t, voltage, setup=SETUP, candidates=(*NAMES, "stainless_steel"))
    assert found.verdict is thermal.Verdict.MATERIAL and found.best == "stainless_steel"
    assert found.conductance == pytest.approx(5e3, rel=0.03)


def test_the_prior_of_objects_is_that_of_the_table() -> None:
    deviations = [
        np.log(one.volumetric_heat_capacity / identify_prior.heat_capacity(one.effusivity))
        for one in thermal.materials().values()
    ]
    assert abs(np.mean(deviations)) < 0.05
    assert np.std(deviations) == pytest.approx(identify_prior.SPREAD, abs=0.03)
    low, high = identify_prior.RANGE
    assert all(low < one.effusivity < high for one in thermal.materials().values())


def test_bad_input_is_refused(identifier: thermal.Identifier) -> None:
    identifier.reset()
    identifier.update([0.01, 0.02], [0.0, 0.0])
    for t, voltage, words in (
        ([0.02], [0.0], "must increase"),
        ([0.03, 0.04], [0.0], "t must be"),
        ([0.03], [np.nan], "finite"),
        ([0.03], [[0.0, 0.0]], "1 columns before"),
        ([0.03], [4.2], "would send at 4.2e\\+03 K: give it in V, not in mV"),
    ):
        with pytest.raises(InvalidValueError, match=words):
            identifier.update(np.array(t), np.array(voltage))
    with pytest.raises(UnknownNameError, match="glass"):
        thermal.Identifier(SETUP, ["glas"])
    with pytest.raises(InvalidValueError, match="no candidates"):
        thermal.Identifier(SETUP, [])
    for wrong in (
        {"conductance": (2e4, 1e3)},
        {"fingertips": 3},
        {"mode": "X"},
        {"object_temperature": (24.0, 0.0)},
        {"chain": thermal.IDEAL},
        {"model_error": -1.0},
        {"tolerance": -1.0},
    ):
        with pytest.raises(InvalidValueError):
            replace(SETUP, **wrong)
