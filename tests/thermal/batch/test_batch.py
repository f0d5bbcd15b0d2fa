"""Many grasps at once: rows do not know of each other, and heat balances in each."""

from functools import cache

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.thermal import (
    ContactSystem,
    Geometry,
    Orders,
    advance_heat,
    forget_field,
    heat_tables,
)
from thermograsp.thermal.matter.materials import material
from thermograsp.thermal.matter.sensors import sensor
from thermograsp.thermal.network.system import contact_system, sample_geometry

DT = 0.01


@cache
def system(name: str, fingertips: int = 2, modes: int = 2) -> ContactSystem:
    geometry = Geometry(sensor("seed"), material(name), "T", 6e-5, "square", (0.04, 0.03, 0.01), fingertips)  # pyright: ignore[reportArgumentType]
    return contact_system(sample_geometry(geometry), Orders(modes, 6, 8, 6 if fingertips == 2 else None))


def rows(count: int):
    tables = heat_tables([system("glass"), system("aluminium", modes=1)], [0.0, 10.0], DT)
    rng = np.random.default_rng(0)
    network = rng.integers(0, 2, count)
    state = np.zeros((count, tables.rates.shape[1]))
    conductance = 10 ** rng.uniform(-3, 1, (count, 2)) * rng.integers(0, 2, (count, 2))
    return tables, network, state, conductance, np.full((count, 2), 12.0), np.ones(count, bool)


def test_a_row_is_the_same_in_any_batch_bit_for_bit() -> None:
    tables, network, state, conductance, difference, active = rows(37)
    together, reading = advance_heat(tables, network, state, conductance, difference, active, 20)
    for some in (slice(0, 1), slice(5, 12), slice(30, 37)):
        alone, read = advance_heat(
            tables, network[some], state[some], conductance[some], difference[some], active[some], 20
        )
        np.testing.assert_array_equal(alone, together[some])
        for one, all_rows in zip(read, reading, strict=True):
            np.testing.assert_array_equal(one, all_rows[some])


def test_inactive_rows_and_the_input_stay() -> None:
    tables, network, state, conductance, difference, active = rows(6)
    state[:] = 0.1
    active[::2] = False
    before = state.copy()
    after, _ = advance_heat(tables, network, state, conductance, difference, active, 3)
    np.testing.assert_array_equal(state, before)
    np.testing.assert_array_equal(after[::2], before[::2])
    assert np.any(after[1::2] != before[1::2])


def test_heat_balances_in_every_row() -> None:
    """What came through both contacts less what the air took is what the object gained, at every sample."""
    tables, network, state, conductance, difference, active = rows(25)
    _, reading = advance_heat(tables, network, state, conductance, difference, active, 200)
    passed = np.cumsum(reading.flow.sum(axis=2) - reading.air_loss, axis=1) * DT
    np.testing.assert_allclose(reading.object_heat, passed, rtol=0, atol=1e-10 * np.abs(passed).max())


def test_a_new_place_finds_the_same_heat() -> None:
    tables, network, state, conductance, difference, active = rows(12)
    state, reading = advance_heat(tables, network, state, conductance, difference, active, 100)
    moved = np.arange(12) % 2 == 0
    fresh = forget_field(tables, network, state, moved)
    np.testing.assert_array_equal(fresh[~moved], state[~moved])
    heat = np.einsum("bk,bk->b", tables.object_heat[network], fresh)
    np.testing.assert_allclose(heat, reading.object_heat[:, -1], rtol=1e-10, atol=1e-12)
    # the object's face is at its mean temperature, the fingertips as they were
    mean = heat / np.array([system(("glass", "aluminium")[n]).geometry.object_capacity * 2 for n in network])
    face = np.einsum("bfk,bk->bf", tables.object_surface[network], fresh)
    np.testing.assert_allclose(face[moved], np.repeat(mean[moved, None], 2, axis=1), rtol=1e-9, atol=1e-12)
    drop = np.einsum("bfk,bk->bf", tables.drop[network], fresh)
    np.testing.assert_allclose(drop, reading.drop[:, -1], rtol=1e-12, atol=1e-14)


def test_fingertips_must_agree() -> None:
    with pytest.raises(InvalidValueError, match="fingertips"):
        heat_tables([system("glass"), system("glass", fingertips=1)], [0.0, 0.0], DT)
