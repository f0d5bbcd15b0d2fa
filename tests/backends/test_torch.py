"""torch.compile, torch.func.vmap, autograd and other devices."""

from __future__ import annotations

import shutil
import sysconfig
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermograsp import thermal
from thermograsp.thermal.contact import (
    array_conductance,
    array_contact,
    array_curved_contact,
    array_laws,
    curved_table,
)

from ..thermal.heat_cases import Batch, Case, difference_between
from .conftest import Kind

torch = pytest.importorskip("torch", reason="the extra torch is not installed")


def arguments(kind: Kind, case: Case, rows: int = 8) -> tuple[thermal.ArrayTables, Any, Any, Any, Any]:
    """Of array_step, after some steps."""
    batch = Batch(case, rows)
    list(batch.steps(5))
    tables = thermal.array_tables(batch.tables, kind.float64)
    conductance = batch.conductance()
    conductance[0] = 0.0
    return tables, *map(kind.of, (batch.network, batch.state, conductance, batch.difference))


@pytest.mark.skipif(
    not (shutil.which("g++") and Path(sysconfig.get_path("include"), "Python.h").exists()),
    reason="on the CPU torch.compile needs g++ and Python's headers",
)
def test_compiled(torch_kind: Kind) -> None:
    given = arguments(torch_kind, ("O", 1))
    expected, reading = thermal.array_step(*given)
    state, read = torch.compile(thermal.array_step, fullgraph=True)(*given)
    expected_reading = thermal.HeatReading(*map(np.asarray, reading))
    assert difference_between(state, read, np.asarray(expected), expected_reading) < 1e-13


def test_the_whole_way_is_one_graph(torch_kind: Kind) -> None:
    """Without a break from forces to voltages; compiled to a graph of PyTorch's own operations."""
    tips = thermal.array_fingertips(["glass", "rubber"], dt=0.02, like=torch_kind.float64, tolerance=0.2)
    which, force = torch.arange(6) % 2, torch.linspace(-1.0, 9.0, 12, dtype=torch.float64).reshape(6, 2)

    def step(state: thermal.FingertipState, force: Any, which: Any):
        return tips.step(state, tips.conductance(force, which), which)

    compiled = torch.compile(step, fullgraph=True, backend="aot_eager")
    state = other = tips.start(6)
    for _ in range(3):
        state, voltage, _ = step(state, force, which)
        other, same, _ = compiled(other, force, which)
        torch.testing.assert_close(same, voltage, rtol=0, atol=1e-15)


def test_the_contact_law_is_one_graph(torch_kind: Kind) -> None:
    faces = thermal.joint(thermal.LAPPED_ALUMINA, thermal.Surface.of(thermal.material("wood")))
    records = np.stack([thermal.flat_law(thermal.Pad(), faces, (0.04, 0.04), (1, 2))] * 3)
    laws = array_laws(records, torch_kind.float64)
    force, place = torch.tensor([0.0, 2.0, 20.0], dtype=torch.float64), torch.zeros(3, 3, dtype=torch.float64)

    def conducts(force: Any) -> Any:
        area, pressing = array_contact(laws, force, place)
        pressure = torch.where(area > 0, pressing / area.clamp(min=1e-9), 1.0)
        return area * array_conductance(laws, pressure)

    found = torch.compile(conducts, fullgraph=True, backend="aot_eager")(force)
    torch.testing.assert_close(found, conducts(force), rtol=1e-12, atol=0)
    assert found[0] == 0 < found[1] < found[2]


def test_a_table_of_curved_contacts_is_one_graph(torch_kind: Kind) -> None:
    first = curved_table(thermal.Pad(), None, thermal.material("steel"), 0.02)
    table, force = torch.tensor(first), torch.tensor([0.0, 2.0, 20.0], dtype=torch.float64)
    at, number = torch.full((3,), 0.004, dtype=torch.float64), torch.zeros(3, dtype=torch.int64)

    def conducts(force: Any) -> Any:
        return array_curved_contact(table, number, force, at, at)

    for found, same in zip(
        torch.compile(conducts, fullgraph=True, backend="aot_eager")(force), conducts(force), strict=True
    ):
        torch.testing.assert_close(found, same, rtol=1e-12, atol=0)
    numpys = array_curved_contact(first, number.numpy(), force.numpy(), at.numpy(), at.numpy())
    np.testing.assert_allclose(conducts(force)[0].numpy(), numpys[0], rtol=1e-12)


def test_vmap_over_rows(torch_kind: Kind) -> None:
    tables, _, *rows = arguments(torch_kind, ("T", 2))
    expected, reading = thermal.array_step(tables, 1, *rows)
    state, read = torch.func.vmap(lambda *row: thermal.array_step(tables, 1, *row))(*rows)
    expected_reading = thermal.HeatReading(*map(np.asarray, reading))
    assert difference_between(state, read, np.asarray(expected), expected_reading) < 1e-14


@pytest.mark.parametrize("case", [("T", 2), ("O", 1)])
def test_gradients_are_finite_differences(torch_kind: Kind, case: Case) -> None:
    """By state, conductance, also where nothing touches, and initial difference."""
    tables, network, *inputs = arguments(torch_kind, case, rows=3)

    def outputs(*inputs: Any) -> tuple[Any, ...]:
        state, reading = thermal.array_step(tables, network, *inputs)
        return state, reading.drop, reading.flow

    assert torch.autograd.gradcheck(outputs, [value.requires_grad_() for value in inputs], atol=1e-6)


def test_gradient_of_voltage_by_force(torch_kind: Kind) -> None:
    """Finite everywhere; 0 where nothing touches, above 0 where something does."""
    tips = thermal.array_fingertips(
        ["glass", "rubber"], dt=0.02, like=torch_kind.float64, tolerance=0.2, chain=thermal.IDEAL
    )
    force = torch.tensor([[0.0, 5.0], [-1.0, 5.0]], dtype=torch.float64, requires_grad=True)
    which = torch.tensor([0, 1])
    _, voltage, _ = tips.step(tips.start(2), tips.conductance(force, which), which)
    voltage.sum().backward()
    assert force.grad is not None
    assert torch.all(force.grad[:, 0] == 0) and torch.all(force.grad[:, 1] > 0)


def test_everything_stays_on_its_device() -> None:
    """Shown on PyTorch's device without memory, which takes no tensor of another device."""
    like = torch.zeros(0, device="meta")
    tips = thermal.array_fingertips(["glass", "rubber"], dt=0.02, like=like, tolerance=0.2)
    which = torch.zeros(6, dtype=torch.int64, device="meta")
    force = torch.zeros((6, 10, 2), device="meta")
    state = tips.restart(tips.start(6), which == 0)
    state, voltage, reading = tips.step(state, tips.conductance(force, which).mean(1), which)
    assert {str(value.device) for value in (state.heat, *state.signal, voltage, *reading)} == {"meta"}
    assert voltage.shape == (6, 2) and voltage.dtype == torch.float32
