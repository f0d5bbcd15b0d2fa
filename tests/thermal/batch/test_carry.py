"""A fingertip that goes from one object's network to another's: what it shows from then on, and its heat."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermograsp import thermal
from thermograsp.errors import InvalidValueError
from thermograsp.thermal.batch.carry import LEAST_STATES, carry_matrix, tip_rows
from thermograsp.thermal.batch.rows import HeatTables

DT = 0.01
SIZE = (0.04, 0.04, 0.04)


def system(name: str, mode: thermal.Mode = "T") -> thermal.ContactSystem:
    geometry = thermal.Geometry(
        thermal.sensor("seed"), thermal.material(name), mode, 81e-6, "square", SIZE, fingertips=2
    )
    chosen = thermal.network_for(geometry, thermal.Demand(0.05, 12.0, (1e2, 1e3, 1e4, 1e5), 20.0)).system
    if 0 < chosen.orders.sensor < LEAST_STATES:
        return thermal.network_of(geometry, replace(chosen.orders, sensor=LEAST_STATES))
    return chosen


def tip_states(tables: HeatTables, network: int) -> slice:
    """The left fingertip's states."""
    first = tables.object_states[network]
    return slice(first, first + tables.sensor_states[network])


def touched(tables: HeatTables, seconds: float, released: float) -> tuple[np.ndarray, np.ndarray]:
    """State (K,) after the left fingertip touched network 0's object and was apart again, and the flow (n,) W."""
    state, flow = np.zeros((1, tables.rates.shape[1])), []
    for conductance, duration in ((0.4, seconds), (0.0, released)):
        if duration:
            state, heats = thermal.advance_heat(
                *(tables, np.zeros(1, int), state, np.array([[conductance, 0.0]]), np.full((1, 2), 12.0)),
                *(np.ones(1, bool), round(duration / DT)),
            )
            flow.append(heats.flow[0, :, 0])
    return state[0], np.concatenate(flow)


PAIRS = [("copper", "glass"), ("glass", "copper"), ("aluminium", "cotton"), ("cotton", "stainless_steel")]


@pytest.mark.parametrize("released", [0.0, 0.5])
@pytest.mark.parametrize(("first", "second"), PAIRS)
def test_it_shows_what_it_would_have_shown_and_keeps_its_heat(first, second, released):
    systems = [system(first), system(second)]
    tables = thermal.heat_tables(systems, [0.0, 0.0], DT)
    state, _ = touched(tables, 1.5, released)
    before = state[tip_states(tables, 0)]
    after = carry_matrix(*map(tip_rows, systems)) @ before

    def seen(row: np.ndarray, network: int, states: np.ndarray, seconds: float) -> float:
        in_tip = tip_states(tables, network)
        return float(row[network, 0, in_tip] @ (states * np.exp(-tables.rates[network, in_tip] * seconds)))

    heat = tables.element_heat
    assert seen(heat, 1, after, 0.0) == pytest.approx(seen(heat, 0, before, 0.0), rel=1e-12)
    for seconds in (0.0, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0):
        for row in (tables.drop, tables.sensor_surface):
            assert seen(row, 1, after, seconds) == pytest.approx(seen(row, 0, before, seconds), abs=5e-3)


@pytest.mark.parametrize(("first", "second"), [("copper", "glass"), ("aluminium", "cotton")])
def test_it_is_the_field_that_the_same_heat_flow_leaves_in_the_other_network(first, second):
    """Metals' flow is even over the face, so the other network's fingertip can be driven by it alone."""
    systems = [system(first), system(second)]
    tables = thermal.heat_tables(systems, [0.0, 0.0], DT)
    state, flow = touched(tables, 1.5, 0.2)
    carried = carry_matrix(*map(tip_rows, systems)) @ state[tip_states(tables, 0)]
    in_tip = tip_states(tables, 1)
    rates, port = systems[1].rates[in_tip], systems[1].ports[in_tip, 0]
    decay, driven = np.exp(-rates * DT), np.zeros(len(rates))
    for watts in flow:
        driven = decay * driven + (1 - decay) / rates * port * watts
    for row in (systems[1].drop, systems[1].sensor_surface):
        assert row[0, in_tip] @ carried == pytest.approx(row[0, in_tip] @ driven, abs=0.02)
    heat = systems[1].element_heat[0, in_tip]
    assert heat @ carried == pytest.approx(heat @ driven, rel=2e-3)


def test_there_and_back_is_where_it_was():
    systems = [system("copper"), system("glass")]
    tables = thermal.heat_tables(systems, [0.0, 0.0], DT)
    state, _ = touched(tables, 1.0, 0.3)
    before = state[tip_states(tables, 0)]
    rows = [tip_rows(each) for each in systems]
    after = carry_matrix(*rows[::-1]) @ carry_matrix(*rows) @ before
    assert np.linalg.norm(after - before) < 1e-2 * np.linalg.norm(before)


def test_elements_on_objects_carry_nothing():
    with pytest.raises(InvalidValueError, match="O mode"):
        tip_rows(system("glass", "O"))
