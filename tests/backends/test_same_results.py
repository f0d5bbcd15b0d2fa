"""PyTorch and JAX give what NumPy and the compiled kernel give: heat, contact law, electronics, and all of them."""

from __future__ import annotations

import numpy as np
import pytest

from thermograsp import thermal
from thermograsp.thermal.contact.rough_faces import LAPPED_ALUMINA, Joint, Surface
from thermograsp.thermal.numerics.erfc_inverse import FARTHEST, NEAREST, erfc_inverse

from ..thermal.heat_cases import CASES, Batch, Case, difference_between
from .conftest import Kind

OBJECTS = ["glass", "rubber", "aluminium"]  # rubber never yields: its faces are all elastic


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize(("largest", "within"), [(1e5, 1e-12), (1e9, 1e-10)])
def test_heat_is_the_compiled_kernel_s(kind: Kind, case: Case, largest: float, within: float) -> None:
    batch = Batch(case, 40, largest)
    tables, state = thermal.array_tables(batch.tables, kind.float64), kind.of(batch.state)
    network, difference = kind.of(batch.network), kind.of(batch.difference)
    array_step = kind.compiled(thermal.array_step)
    for conductance, expected_state, expected in batch.steps(12):
        state, reading = array_step(tables, network, state, kind.of(conductance), difference)
        assert difference_between(state, reading, expected_state, expected) < within


def test_float32_stays_float32_and_near(kind: Kind) -> None:
    batch = Batch(("T", 2), 40, 1e9)
    exact = thermal.array_tables(batch.tables, np.zeros(0))
    tables, state = thermal.array_tables(batch.tables, kind.float32), kind.of(batch.state.astype(np.float32))
    network, difference = kind.of(batch.network), kind.of(batch.difference.astype(np.float32))
    array_step = kind.compiled(thermal.array_step)
    for _ in range(40):
        conductance = batch.conductance().astype(np.float32)
        batch.state, expected = thermal.array_step(
            exact, batch.network, batch.state, conductance.astype(float), batch.difference
        )
        state, reading = array_step(tables, network, state, kind.of(conductance), difference)
        assert all(values.dtype == kind.float32.dtype for values in (state, *reading))
        np.testing.assert_allclose(np.asarray(reading.drop), expected.drop, rtol=0, atol=5e-5)  # K


def test_forgetting(kind: Kind) -> None:
    batch = Batch(("T", 2), 12)
    list(batch.steps(5))
    moved = np.arange(12) % 2 == 0
    found = thermal.array_forget(
        thermal.array_tables(batch.tables, kind.float64),
        kind.of(batch.network),
        kind.of(batch.state),
        kind.of(moved),
    )
    expected = thermal.forget_field(batch.tables, batch.network, batch.state, moved)
    np.testing.assert_array_equal(np.asarray(found), expected)


def test_inverse_of_erfc(kind: Kind) -> None:
    p = np.geomspace(FARTHEST, NEAREST, 2001)
    np.testing.assert_allclose(np.asarray(erfc_inverse(kind.of(p))), erfc_inverse(p), rtol=3e-14)
    found = erfc_inverse(kind.of(p.astype(np.float32)))
    assert found.dtype == kind.float32.dtype
    np.testing.assert_allclose(np.asarray(found), erfc_inverse(p), rtol=1e-6)


def test_contact_law(kind: Kind) -> None:
    pressure = np.append(0.0, np.geomspace(1e-3, 1e9, 200))[:, None]
    law = thermal.stack_joints(
        [thermal.joint(LAPPED_ALUMINA, Surface.of(thermal.material(name))) for name in OBJECTS]
    )
    tensors = Joint(**{name: kind.of(getattr(law, name)) for name in Joint.__dataclass_fields__})
    found = kind.compiled(lambda pressure: thermal.contact_conductance(tensors, pressure))(kind.of(pressure))
    np.testing.assert_allclose(np.asarray(found), thermal.contact_conductance(law, pressure), rtol=1e-13)


@pytest.mark.parametrize("mode", ["T", "O"])
def test_forces_to_voltages(kind: Kind, mode: thermal.Mode) -> None:
    """Mean of the substeps, heat, electronics with noise and converter, and a start anew of some rows."""
    rng, rows = np.random.default_rng(0), 12
    which, restarted = np.arange(rows) % 3, np.arange(rows) < 4
    numpy_model, array_model = (
        thermal.array_fingertips(OBJECTS, dt=0.02, like=like, mode=mode, tolerance=0.2)
        for like in (np.zeros(0), kind.float64)
    )
    conductance, step = kind.compiled(array_model.conductance), kind.compiled(array_model.step)
    state, other = numpy_model.start(rows), array_model.start(rows)
    force = np.zeros((rows, 10, 2))
    for k in range(20):
        force = rng.uniform(-5.0, 20.0, (rows, 10, 2))
        noise = rng.standard_normal((rows, 2))
        if k == 10:
            state, other = (
                numpy_model.restart(state, restarted),
                array_model.restart(other, kind.of(restarted)),
            )
        if k == 15:  # some rows go on to another object
            which = np.roll(which, 1)
        state, expected, _ = numpy_model.step(
            state, numpy_model.conductance(force, which).mean(1), which, noise
        )
        between = conductance(kind.of(force), kind.of(which)).mean(1)
        other, voltage, _ = step(other, between, kind.of(which), kind.of(noise))
        np.testing.assert_allclose(np.asarray(voltage), expected, rtol=0, atol=1e-12)
    force[3, 0, 1] = np.nan
    between = conductance(kind.of(force), kind.of(which)).mean(1)
    _, voltage, _ = step(other, between, kind.of(which), 0.0)
    spoilt = np.isnan(np.asarray(voltage)).any(axis=1)
    assert np.flatnonzero(spoilt).tolist() == [3]
