"""From forces to voltages: the same as contact law, compiled heat and electronics one after the other."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError, UnknownNameError
from thermograsp.thermal import (
    ADS1115,
    IDEAL,
    LAPPED_ALUMINA,
    THERMOSTAT_FACE,
    Demand,
    Geometry,
    Mode,
    Pad,
    SignalState,
    Surface,
    advance_heat,
    array_fingertips,
    contact_conductance,
    flat_contact,
    heat_tables,
    joint,
    measure,
    network_for,
)
from thermograsp.thermal.batch.fingertips import MOST_FORCE
from thermograsp.thermal.matter.materials import material
from thermograsp.thermal.matter.sensors import sensor

DT, SIZE = 0.02, (0.04, 0.03, 0.02)
NAMES = ("glass", "rubber", "aluminium")
LIKE = np.zeros(0)


def tips(materials: Any = NAMES, **others: Any):
    return array_fingertips(materials, dt=DT, like=LIKE, object_size=SIZE, tolerance=0.2, **others)


@pytest.mark.parametrize("mode", ["T", "O"])
def test_is_law_heat_and_electronics(mode: Mode) -> None:
    rng, rows = np.random.default_rng(0), 12
    fingertips = tips(mode=mode, chain=ADS1115, air=10.0)
    which = np.arange(rows) % 3
    state = fingertips.start(rows, np.linspace(10.0, 40.0, rows))

    stack = sensor("seed")
    geometries = [Geometry(stack, material(name), mode, stack.face_area, "square", SIZE, 2) for name in NAMES]
    systems = [network_for(geometry, Demand(0.2, 12.0), air=10.0).system for geometry in geometries]
    tables = heat_tables(systems, [10.0] * 3, DT)
    faces = [
        joint(LAPPED_ALUMINA, Surface.of(material(n)) if mode == "T" else THERMOSTAT_FACE) for n in NAMES
    ]
    face = (0.009, 0.009) if mode == "O" else SIZE[:2]
    heat = np.zeros((rows, tables.rates.shape[1]))
    difference = np.repeat(36.0 - np.linspace(10.0, 40.0, rows)[:, None], 2, axis=1)
    signal = SignalState(np.zeros(2 * rows), np.zeros(2 * rows))
    for _ in range(40):
        force = rng.uniform(0.0, 20.0, (rows, 2)) * rng.integers(0, 2, (rows, 2))
        noise = rng.standard_normal((rows, 2))
        state, voltage, reading = fingertips.step(state, fingertips.conductance(force, which), which, noise)

        contact = flat_contact(Pad(), force, face)
        conductances = np.array(
            [
                contact_conductance(faces[k], p) * a
                for k, p, a in zip(which, contact.face_pressure, contact.face, strict=True)
            ]
        )
        heat, expected = advance_heat(tables, which, heat, conductances, difference, np.ones(rows, bool), 1)
        drop = expected.drop[:, 0].reshape(-1, 1)
        signal, volts = measure(ADS1115, signal, drop, stack.seebeck, DT, noise.reshape(-1, 1))
        np.testing.assert_allclose(reading.drop, expected.drop[:, 0], rtol=0, atol=1e-11)
        np.testing.assert_allclose(voltage, volts.reshape(rows, 2), rtol=0, atol=1e-14)


def test_conductance_of_substeps() -> None:
    """Their mean is what a step takes; a step of one substep is the plain one."""
    fingertips = tips()
    which = np.array([0, 1, 2])
    force = np.linspace(-2.0, 10.0, 3 * 5 * 2).reshape(3, 5, 2)
    each = fingertips.conductance(force, which)
    assert each.shape == force.shape
    for k in range(5):
        np.testing.assert_array_equal(each[:, k], fingertips.conductance(force[:, k], which))
    assert np.all(each[force <= 0] == 0) and np.all(each[force > 0] > 0)


def test_what_is_not_finite_spoils_its_own_row() -> None:
    """A force, and what has come of it, until the row starts anew."""
    fingertips = tips()
    which = np.array([0, 1, 2, 0])
    force = np.full((4, 2), 5.0)
    force[1, 0], force[2, 1], good = np.nan, np.inf, np.array([True, False, False, True])
    conductances = fingertips.conductance(force, which)
    assert np.isnan(conductances).tolist() == [[False, False], [True, False], [False, True], [False, False]]
    state, voltage, _ = fingertips.step(fingertips.start(4), conductances, which)
    still = fingertips.conductance(np.full((4, 2), 5.0), which)
    state, voltage, reading = fingertips.step(state, still, which[::-1])
    alone = fingertips.start(2)
    alone, _, _ = fingertips.step(alone, conductances[good], which[good])
    alone, expected, _ = fingertips.step(alone, still[good], which[::-1][good])
    assert np.array_equal(voltage[good], expected) and np.isfinite(voltage[good]).all()
    assert np.isnan(reading.drop[~good]).all()
    again = fingertips.restart(state, ~good)
    assert np.isfinite(fingertips.step(again, still, which)[1]).all()


@pytest.mark.parametrize("name", NAMES)
def test_an_absurd_force_counts_as_the_largest_that_the_law_takes(name: str) -> None:
    conductances = tips(name).conductance(np.array([[1.0, 500.0], [MOST_FORCE, 1e6]]))
    assert np.all(np.diff(conductances.ravel())[:2] > 0) and conductances[1, 0] == conductances[1, 1]


@pytest.mark.parametrize("elsewhere", NAMES)
@pytest.mark.parametrize("here", NAMES)
def test_a_fingertip_takes_its_warmth_to_another_object(here: str, elsewhere: str) -> None:
    """It shows what it would have shown beside the first one, to the tolerance, with the same heat; the second object
    is at its first temperature."""
    fingertips = tips()
    at, to = NAMES.index(here), NAMES.index(elsewhere)
    held = fingertips.conductance(np.array([[10.0, 5.0]]), at)
    state = fingertips.start(1)
    for _ in range(100):
        state, _, _ = fingertips.step(state, held, at)
    kept, _, one = fingertips.step(state, 0 * held, at)
    gone, _, other = fingertips.step(state, 0 * held, to)
    assert gone.which.tolist() == [to] and np.all(one.drop > 0.1)
    assert other.element_heat == pytest.approx(
        one.element_heat, rel=0.01
    )  # what has left within 20 ms differs a little
    for _ in range(100):
        assert np.abs(one.drop - other.drop).max() < 0.2
        assert abs(other.object_heat[0]) < 1e-9 or here == elsewhere
        kept, _, one = fingertips.step(kept, 0 * held, at)
        gone, _, other = fingertips.step(gone, 0 * held, to)


def test_elements_on_objects_stay_there() -> None:
    """In O mode another object is another element, at its first temperature."""
    fingertips = tips(mode="O")
    state = fingertips.start(2)
    for _ in range(50):
        state, _, _ = fingertips.step(state, np.full((2, 2), 0.5), 0)
    state, _, reading = fingertips.step(state, np.zeros((2, 2)), np.array([0, 1]))
    assert np.all(reading.drop[0] > 1.0) and np.all(reading.drop[1] == 0.0)


def test_the_air_is_in_the_tolerance() -> None:
    """Still air costs no kelvin, moving air takes of what the network may be off, or is too much."""
    keywords = {"dt": DT, "like": LIKE, "object_size": SIZE, "tolerance": 0.05}
    still, moving = (array_fingertips("cotton", air=air, **keywords) for air in (0.0, 15.0))
    states = [int(tips.rungs[0].rpartition("/")[2]) for tips in (still, moving)]
    assert states[1] > states[0]
    with pytest.raises(InvalidValueError, match="in air of 50 W"):
        array_fingertips("cotton", air=50.0, **keywords)


@pytest.mark.parametrize("which", [3, -1, np.array([0, 3]), np.array([0.0, 1.0]), np.array([True, False])])
def test_an_object_that_is_none_is_refused(which: Any) -> None:
    with pytest.raises(InvalidValueError, match="which must be whole numbers from 0 to 2"):
        tips().conductance(np.ones((2, 2)), which)


def test_restart_is_a_start() -> None:
    fingertips = tips("glass", chain=IDEAL)
    state = fingertips.start(4)
    for _ in range(3):
        state, _, _ = fingertips.step(state, np.full((4, 2), 0.5))
    rows, celsius = np.array([False, True, False, True]), np.array([5.0, 6.0, 7.0, 8.0])
    again, fresh = fingertips.restart(state, rows, celsius), fingertips.start(4, celsius)
    for new, first, old in zip(
        (again.heat, again.difference, *again.signal),
        (fresh.heat, fresh.difference, *fresh.signal),
        (state.heat, state.difference, *state.signal),
        strict=True,
    ):
        np.testing.assert_array_equal(new[rows], first[rows])
        np.testing.assert_array_equal(new[~rows], old[~rows])


@pytest.mark.parametrize("which", [np.array([0, 1, 2]), np.array([0]), np.array([[0, 1]])])
def test_a_choice_that_is_not_one_of_each_row_is_refused(which: np.ndarray) -> None:
    with pytest.raises(InvalidValueError, match="one for each of the 2 rows"):
        tips().conductance(np.ones((2, 2)), which)
    with pytest.raises(InvalidValueError, match="one for each of the 2 rows"):
        tips().step(tips().start(2), np.ones((2, 2)), which)


def test_one_object_needs_no_choice_and_several_do() -> None:
    state = tips("glass").start(2)
    tips("glass").step(state, np.ones((2, 2)))
    with pytest.raises(InvalidValueError, match="which of the 3 objects"):
        tips().conductance(np.ones((2, 2)))


@pytest.mark.parametrize(
    ("wrong", "match"),
    [
        ({"materials": "glas"}, "did you mean 'glass'"),
        ({"materials": []}, "one object_size or a list"),
        ({"object_size": [(0.04, 0.04, 0.04)]}, "one object_size or a list"),
        ({"object_size": (0.005, 0.04, 0.04)}, "no narrower than the sensor's face"),
        ({"object_size": 0.04}, r"a cube of 0.04 m is \(0.04, 0.04, 0.04\)"),
        ({"object_size": [0.04] * 3}, "width, depth, thickness"),
        ({"object_size": (0.04, 0.04)}, "width, depth, thickness"),
        ({"object_size": (0.04, 0.04, -0.04)}, "above 0"),
        ({"mode": "X"}, "mode must be 'T' or 'O'"),
        ({"fingertips": 3}, "fingertips 1 or 2"),
        ({"dt": 0.0}, "dt"),
        ({"air": -1.0}, "air"),
        ({"tolerance": 0.0}, "tolerance"),
        ({"like": np.zeros(0, int)}, "floating point"),
        ({"like": [0.0]}, "floating point, got list"),
    ],
)
def test_wrong_values_are_refused(wrong: dict[str, Any], match: str) -> None:
    keywords: dict[str, Any] = {
        "materials": NAMES,
        "dt": DT,
        "like": LIKE,
        "object_size": SIZE,
        "tolerance": 0.2,
    }
    with pytest.raises((InvalidValueError, UnknownNameError), match=match):
        array_fingertips(**(keywords | wrong))
