"""The array step is the compiled kernel's to round-off, keeps its digits at any conductance, and balances heat."""

from __future__ import annotations

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.thermal import (
    ArrayTables,
    array_forget,
    array_step,
    array_tables,
    forget_field,
)
from thermograsp.thermal.network.coupling import POLES

from ..heat_cases import CASES, DT, Batch, Case, difference_between, tables_of

FLOAT64, FLOAT32 = np.zeros(0), np.zeros(0, np.float32)


def step(tables: ArrayTables, batch: Batch, state: np.ndarray, conductance: np.ndarray):
    kind = tables.decay.dtype
    return array_step(tables, batch.network, state, conductance.astype(kind), batch.difference.astype(kind))


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize(
    ("largest", "within"),
    # The kernel takes the difference of flows that grow with the conductance; at 1e9 it loses its last four digits.
    [(1e5, 1e-12), pytest.param(1e9, 1e-10, marks=pytest.mark.slow)],
)
def test_equals_the_compiled_kernel(case: Case, largest: float, within: float) -> None:
    batch = Batch(case, 60, largest)
    tables, state = array_tables(batch.tables, FLOAT64), batch.state
    for conductance, expected_state, expected in batch.steps(40):
        state, reading = step(tables, batch, state, conductance)
        assert difference_between(state, reading, expected_state, expected) < within


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("largest", [pytest.param(1e5, marks=pytest.mark.slow), 1e9])
def test_float32_keeps_its_digits_at_any_conductance(case: Case, largest: float) -> None:
    """Within 3e-6 of the largest difference of 20 K, through ten touches and releases."""
    batch = Batch(case, 60, largest)
    exact, coarse = array_tables(batch.tables, FLOAT64), array_tables(batch.tables, FLOAT32)
    state, rounded = batch.state, batch.state.astype(np.float32)
    for _ in range(10):
        conductance = batch.conductance()
        for _ in range(20):
            state, expected = step(exact, batch, state, conductance)
            rounded, reading = step(coarse, batch, rounded, conductance)
            for name in ("drop", "sensor_rise", "object_rise"):
                assert np.max(np.abs(getattr(reading, name) - getattr(expected, name))) < 6e-5  # K
        assert rounded.dtype == np.float32


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("largest", [1e5, 1e9])
def test_heat_balances_in_every_row(case: Case, largest: float) -> None:
    """What the object's side gained is what came through both contacts less what the air took."""
    batch = Batch(case, 60, largest)
    tables, state = array_tables(batch.tables, FLOAT64), batch.state
    gained = np.zeros(60)
    for _ in range(40):
        state, reading = step(tables, batch, state, batch.conductance())
        gained += DT * (reading.flow.sum(axis=1) - reading.air_loss)
        stored = reading.object_heat + (reading.element_heat.sum(axis=1) if case[0] == "O" else 0.0)
        np.testing.assert_allclose(stored, gained, rtol=0, atol=1e-11 * np.abs(gained).max())


@pytest.mark.parametrize("case", CASES)
def test_no_contact_no_flow(case: Case) -> None:
    """Exactly, whatever the other contact does."""
    batch = Batch(case, 30)
    tables, state = array_tables(batch.tables, FLOAT64), batch.state
    for _ in range(5):
        conductance = batch.conductance()
        state, reading = step(tables, batch, state, conductance)
        assert np.all(reading.flow[conductance == 0] == 0)
        assert np.all(reading.flow[conductance > 0] != 0)


@pytest.mark.parametrize("kind", [FLOAT64, FLOAT32])
def test_conductance_may_grow_without_bound(kind: np.ndarray) -> None:
    """The faces are at one temperature then, and nothing overflows."""
    batch = Batch(("T", 2), 30)
    tables = array_tables(batch.tables, kind)
    state = batch.state.astype(kind.dtype)
    for _ in range(20):
        state, reading = step(tables, batch, state, np.full((30, 2), 1e12))
    near, near_reading = step(tables, batch, state, np.full((30, 2), 1e10))
    far, far_reading = step(tables, batch, state, np.full((30, 2), 1e12))
    bound = 1e-9 if kind is FLOAT64 else 1e-4
    assert difference_between(far, far_reading, near, near_reading) < bound


def test_elimination_needs_no_pivots() -> None:
    """The sector that the docstring of array_step.py rests on."""
    assert np.all(np.imag(POLES) > 0)
    assert np.degrees(np.angle(POLES).max()) < 102


def test_a_row_is_the_same_in_any_batch_bit_for_bit() -> None:
    batch = Batch(("T", 2), 37)
    tables, conductance = array_tables(batch.tables, FLOAT64), batch.conductance()
    state, reading = step(tables, batch, batch.state, conductance)
    for some in (slice(0, 1), slice(5, 12), slice(30, 37)):
        alone, read = array_step(
            tables, batch.network[some], batch.state[some], conductance[some], batch.difference[some]
        )
        np.testing.assert_array_equal(alone, state[some])
        for one, all_rows in zip(read, reading, strict=True):
            np.testing.assert_array_equal(one, all_rows[some])


def test_one_network_for_all_and_one_row_alone() -> None:
    batch = Batch(("T", 2), 9)
    tables, conductance = array_tables(batch.tables, FLOAT64), batch.conductance()
    expected, reading = array_step(tables, np.full(9, 1), batch.state, conductance, batch.difference)
    state, same = array_step(tables, 1, batch.state, conductance, batch.difference)
    assert difference_between(state, same, expected, reading) < 1e-14
    row, read = array_step(tables, 1, batch.state[4], conductance[4], batch.difference[4])
    np.testing.assert_allclose(row, expected[4], rtol=1e-13, atol=1e-15)
    assert read.drop.shape == (2,) and read.object_heat.shape == ()


def test_what_is_not_finite_stays_in_its_row() -> None:
    batch = Batch(("T", 2), 6)
    tables, conductance = array_tables(batch.tables, FLOAT64), batch.conductance()
    expected, _ = step(tables, batch, batch.state, conductance)
    conductance[2, 0] = np.nan
    state, reading = step(tables, batch, batch.state, conductance)
    others = np.arange(6) != 2
    np.testing.assert_array_equal(state[others], expected[others])
    assert np.isnan(reading.drop[2]).all()


@pytest.mark.parametrize("case", CASES)
def test_forgetting_is_the_compiled_one(case: Case) -> None:
    batch = Batch(case, 12)
    list(batch.steps(20))
    moved = np.arange(12) % 2 == 0
    expected = forget_field(batch.tables, batch.network, batch.state, moved)
    found = array_forget(array_tables(batch.tables, FLOAT64), batch.network, batch.state, moved)
    np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("wrong", ["conductance", "difference"])
def test_another_number_of_fingertips_is_refused(wrong: str) -> None:
    shapes = {"conductance": (4, 2), "difference": (4, 2), wrong: (4, 1)}
    tables = array_tables(tables_of(("T", 2)), FLOAT64)
    state = np.zeros((4, tables.decay.shape[1]))
    with pytest.raises(InvalidValueError, match=r"2 fingertip\(s\)"):
        array_step(tables, 0, state, np.ones(shapes["conductance"]), np.ones(shapes["difference"]))


def test_integers_are_refused() -> None:
    with pytest.raises(InvalidValueError, match="floating point, got int64"):
        array_tables(tables_of(("T", 1)), np.zeros(0, int))
