"""The step of boxes between fingertips on rates that all share, against the same networks joined state by state."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermograsp.compiled import njit
from thermograsp.thermal import HeatReading, material, sensor
from thermograsp.thermal.batch import (
    FIXED_LEVEL,
    HELD,
    RATES,
    SHARED,
    WHERE,
    FixedTables,
    advance_fixed,
    fixed_heat,
    fixed_room,
    fixed_tables,
    set_body,
    set_gram,
    tip_residues,
)
from thermograsp.thermal.kernels import Patches, Resolution, TouchedBox, box_side, tip, touched_box
from thermograsp.thermal.network import POLES, WEIGHTS

DT = 0.01
LEVEL = replace(FIXED_LEVEL, patterns=2)
STACK = sensor("seed")
SIZE = (0.03, 0.024, 0.012)
WHOLE, HALF = ((0.0, 0.009), (0.0, 0.009)), ((0.0, 0.009), (0.0, 0.0055))


@njit(cache=True)
def _advance(
    x, conductance, difference, around, drop, heat, held, sensor_rise, object_rise, flow, loss, *numbers
):
    tables = FixedTables(*numbers)
    room = fixed_room(tables.gram.shape[1])
    reading = HeatReading(drop, heat, held, sensor_rise, object_rise, flow, loss)
    advance_fixed(tables, 0, x, conductance, difference, around, room, reading, 0, 0)


def scene(name: str, film: float) -> FixedTables:
    """A box that two fingertips touch, one with a part of its face."""
    tips = tuple(tip(STACK, covered, LEVEL) for covered in (WHOLE, HALF))
    centre, half = (
        np.array([[0.01, 0.006], [0.014, 0.00925]]),
        np.array([[0.0045, 0.0045], [0.0045, 0.00275]]),
    )
    patches = Patches(np.array([0, 1]), centre, half)
    box = touched_box(TouchedBox(material(name), SIZE, film, patches, tips, 2), LEVEL)
    tables = fixed_tables(1, 2, 3, LEVEL.patterns, tips[0].side, DT)
    set_body(tables, 0, box, [0, 1])
    tables.tips[2] = tip_residues(tips[1].side)
    tables.links[0, WHERE:] = 0, 1, 0, 2
    set_gram(tables, 0)
    return tables


def whole_state(tables: FixedTables, x: np.ndarray, conductance, difference, around: float):
    """(rate of change of a state, flows (F, P) W), written down body by body."""
    p, f = tables.patterns, 2
    rates, ports = tables.rates[0], tables.places * tables.patterns
    residues = tables.body[0, : ports * ports].reshape(ports, ports, RATES)[: f * p, : f * p]
    heat, slow = tables.body[0, ports * ports :][: f * p], tables.slow[0]
    at = 1 + RATES
    field = x[at : at + f * p * RATES].reshape(f * p, RATES)
    air = x[1:at]
    warm = np.einsum("ijk,jk->i", residues, field) + heat @ air + slow[HELD + 1 :][: f * p] * x[0]
    change, first = np.zeros(len(x)), 1 + RATES * (1 + ports)
    flow = np.zeros((f, p))
    for number in range(f):
        element = tables.tips[tables.links[0, WHERE + f + number]]
        start = first + number * tables.of_tip
        poles, body_field = x[start : start + 8], x[start + 8 : start + tables.of_tip].reshape(1 + p, RATES)
        square = element[: p * p].reshape(p, p, RATES)
        surface = np.einsum("ijk,jk->i", square, body_field[1:]) + element[p * p + p :][:p] @ body_field[0]
        surface[0] += tables.poles[14] @ poles
        drive = np.zeros(p)
        drive[0] = difference[number]
        flow[number] = conductance[number] * (drive - warm[number * p : (number + 1) * p] + surface)
        rest = change[start + 8 : start + tables.of_tip].reshape(1 + p, RATES)
        rest[:] = -rates * body_field
        rest[1:] -= flow[number][:, None]
        change[start : start + 8] = -tables.poles[0] * poles - tables.poles[14] * flow[number, 0]
    fields = change[at : at + f * p * RATES].reshape(f * p, RATES)
    fields[:] = -rates * field
    fields += flow.reshape(-1)[:, None]
    change[1:at] = rates * (around - air)
    change[0] = -slow[0] * (x[0] - slow[HELD] * around) + slow[HELD + 1 :][: f * p] @ flow.reshape(-1)
    return change, flow


def whole_matrices(tables: FixedTables) -> np.ndarray:
    """(1 + F, states, states): what changes the state without conductances, and more by each of them."""

    def matrix(conductance: np.ndarray) -> np.ndarray:
        every = [whole_state(tables, one, conductance, np.zeros(2), 0.0)[0] for one in np.eye(tables.states)]
        return np.stack(every, axis=1)

    without, much = matrix(np.zeros(2)), 1e9  # beside which what is taken away again rounds nothing off
    return np.stack([without, *((matrix(much * one) - without) / much for one in np.eye(2))])


@pytest.mark.parametrize("film", [0.0, 30.0])
@pytest.mark.parametrize("name", ["aluminium", "cotton"])
def test_it_is_the_step_of_all_states_together(name, film):
    """Conductances from 0 to 1e9 that jump, air that is warmer than the box; books of heat."""
    tables = scene(name, film)
    around = 3.0 if film else 0.0
    rng, difference = np.random.default_rng(0), np.array([12.0, -5.0])
    x, books = np.zeros(tables.states), 0.0
    drop, heat, sensor_rise, object_rise, flow = (np.zeros((1, 1, 2)) for _ in range(5))
    held, loss = np.zeros((1, 1)), np.zeros((1, 1))
    eye, matrices = np.eye(len(x)), whole_matrices(tables)
    for _ in range(40):
        conductance = np.where(rng.random(2) < 0.2, 0.0, 10 ** rng.uniform(-3, 9, 2))
        constant, _ = whole_state(tables, 0 * x, conductance, difference, around)
        matrix = np.einsum("k,kij->ij", np.append(1.0, conductance), matrices)
        slope = matrix @ x + constant
        expected = x.copy()
        for pole, weight in zip(POLES, WEIGHTS, strict=True):
            expected -= 2 * DT * np.real(weight * np.linalg.solve(pole * eye - DT * matrix, slope))
        _advance(
            *(x, conductance, difference, around, drop, heat, held, sensor_rise, object_rise, flow, loss),
            *tables,
        )
        assert np.abs(x - expected).max() < 1e-6 * max(np.abs(x).max(), 1.0)
        books += DT * (flow.sum() - loss[0, 0])
        assert held[0, 0] == pytest.approx(books, abs=1e-9)
        assert held[0, 0] == pytest.approx(fixed_heat(tables, 0, x), abs=1e-12)
    assert abs(held[0, 0]) > 0.01 and (film == 0) == (loss[0, 0] == 0)


def test_residues_are_the_network_and_keep_its_heat():
    tips = tip(STACK, WHOLE, LEVEL)
    patches = Patches(np.array([0]), np.array([[0.01, 0.006]]), np.full((1, 2), 0.0045))
    box = box_side(material("glass"), SIZE, 0.0, patches, (tips,), LEVEL)
    found = touched_box(TouchedBox(material("glass"), SIZE, 0.0, patches, (tips,), 1), LEVEL)
    s = np.geomspace(0.03, 100, 30)[:, None]
    fitted = np.einsum("sk,ijk->sij", 1 / (s + SHARED), found.residues)
    exact = np.einsum("sn,ni,nj->sij", 1 / (s + box.rates[1:]), box.ports[1:], box.ports[1:])
    # a box under fingertips is told at fewer times
    assert np.abs(fitted - exact).max() < 1e-4 * exact.max()
    assert min(np.linalg.eigvalsh(each).min() for each in found.residues.transpose(2, 0, 1)) > -1e-12
    side, rows = tips.side, tip_residues(tips.side)
    slow = int(np.argmax(side.ports[:, 1] != 0))
    assert rows[6:8].sum(axis=1) == pytest.approx(
        side.outputs["element"][slow:] @ side.ports[slow:], abs=1e-9
    )


def test_other_rates_than_the_shared_ones_are_refused():
    with pytest.raises(ValueError, match="not among the shared"):
        tip_residues(tip(STACK, WHOLE, Resolution(12, 2)).side)


def test_what_is_as_warm_as_the_air_stays():
    tables = scene("glass", 30.0)
    x, nothing = np.zeros(tables.states), np.zeros(2)
    x[0], x[1 : 1 + RATES] = 2.0 * tables.slow[0, HELD], 2.0
    capacity = np.prod(SIZE) * material("glass").volumetric_heat_capacity
    shape = [np.zeros((1, 1, 2)) for _ in range(5)]
    for _ in range(100):
        _advance(
            x, nothing, nothing, 2.0, *shape[:2], np.zeros((1, 1)), *shape[2:], np.zeros((1, 1)), *tables
        )
        assert shape[3][0, 0] == pytest.approx(2.0, abs=1e-9)
        assert fixed_heat(tables, 0, x) == pytest.approx(2.0 * capacity, rel=1e-9)
