from dataclasses import replace

import numpy as np
import pytest

from thermograsp.errors import InvalidValueError
from thermograsp.thermal.readout.thermostat import (
    Thermostat,
    ThermostatState,
    ideal_thermostat,
    settled_thermostat,
    thermostat_step,
)

DT = 0.02
REAL = Thermostat()


def hold(thermostat: Thermostat, drawn: float, seconds: float) -> list[ThermostatState]:
    states = [settled_thermostat(thermostat, 1)]
    for _ in range(round(seconds / DT)):
        states.append(thermostat_step(thermostat, states[-1], np.array([drawn]), DT))
    return states


def temperatures(states: list[ThermostatState]) -> np.ndarray:
    return np.array([state.temperature[0] for state in states])


def test_rest_stays_at_rest() -> None:
    states = hold(REAL, 0.0, 5.0)
    np.testing.assert_allclose(temperatures(states), 36.0, atol=1e-12)
    assert states[-1].power[0] == pytest.approx(REAL.loss * 12)


def test_no_steady_error_under_a_constant_draw() -> None:
    states = hold(REAL, 2.0, 30.0)
    assert temperatures(states)[-1] == pytest.approx(36.0, abs=1e-6)
    assert states[-1].power[0] == pytest.approx(2.0 + REAL.loss * 12, abs=1e-5)
    dip = 36 - temperatures(states).min()
    assert 0.05 < dip < 0.5  # the first moments are the plate's own capacity
    assert temperatures(states).max() < 36 + dip / 10


def test_too_weak_a_heater_droops_to_its_balance() -> None:
    """Plate at ambient + (limit - drawn)/loss, the heater at its limit."""
    weak = replace(REAL, power_limit=1.0, loss=0.2)
    states = hold(weak, 0.8, 120.0)
    assert states[-1].power[0] == 1.0
    assert temperatures(states)[-1] == pytest.approx(24 + 0.2 / 0.2, abs=1e-3)
    start = settled_thermostat(weak, 2)
    assert start.temperature.tolist() == [29.0, 29.0]


def test_the_integral_does_not_wind_up_at_the_limit() -> None:
    """After a long overload the plate comes back without the overshoot that a wound-up integral would cause."""
    states = hold(REAL, 8.0, 10.0)
    assert temperatures(states)[-1] < 30
    assert all(state.integral[0] <= REAL.power_limit for state in states)
    state = states[-1]
    back = []
    for _ in range(2000):
        state = thermostat_step(REAL, state, np.zeros(1), DT)
        back.append(state.temperature[0])
    assert max(back) < 36.5
    assert back[-1] == pytest.approx(36, abs=1e-3)


def test_energy_balance_of_the_plate() -> None:
    """Heater less draw less loss is what the plate stores; the loss summed from its temperature by Simpson's rule."""
    rng = np.random.default_rng(4)
    state, supplied, lost = settled_thermostat(REAL, 1), 0.0, 0.0
    for _ in range(500):
        drawn, before = rng.uniform(-1, 4, 1), state.temperature
        state = thermostat_step(REAL, state, drawn, DT)
        # constant power: half-way through the step by the same exponential law
        heat = state.power - drawn
        middle = before + (heat - REAL.loss * (before - 24)) / REAL.loss * -np.expm1(
            -DT / 2 * REAL.loss / REAL.heat_capacity
        )
        lost += float(DT / 6 * REAL.loss * (before + 4 * middle + state.temperature - 6 * 24)[0])
        supplied += float(DT * heat[0])
    assert supplied - lost == pytest.approx(REAL.heat_capacity * (state.temperature[0] - 36), abs=1e-9)


def test_sensor_lag_is_first_order() -> None:
    """A step of the plate (no heater, no loss, an impulse of heat) seen through the sensor."""
    passive = Thermostat(proportional=0.0, integral=0.0, derivative=0.0, loss=0.0, sensor_lag=0.2)
    state = settled_thermostat(passive, 1)
    state = thermostat_step(passive, state, np.array([-passive.heat_capacity / 1e-9]), 1e-9)
    for _ in range(10):
        state = thermostat_step(passive, state, np.zeros(1), DT)
    assert state.temperature[0] == pytest.approx(37)
    assert state.measured[0] == pytest.approx(37 - np.exp(-1), abs=1e-6)


def test_ideal_thermostat_never_moves() -> None:
    ideal = ideal_thermostat()
    state = settled_thermostat(ideal, 3)
    state = thermostat_step(ideal, state, np.array([0.0, 3.0, 1e6]), DT)
    assert state.temperature.tolist() == state.measured.tolist() == [36.0] * 3
    np.testing.assert_allclose(state.power, np.array([0.0, 3.0, 1e6]) + ideal.loss * 12)


def test_rows_do_not_matter() -> None:
    drawn = np.random.default_rng(5).uniform(-2, 6, (40, 21))
    batch = settled_thermostat(REAL, 21)
    rows = [settled_thermostat(REAL, 1) for _ in range(21)]
    for step in drawn:
        batch = thermostat_step(REAL, batch, step, DT)
        rows = [thermostat_step(REAL, row, step[i : i + 1], DT) for i, row in enumerate(rows)]
    assert batch.temperature.tolist() == [row.temperature[0] for row in rows]
    assert batch.integral.tolist() == [row.integral[0] for row in rows]


@pytest.mark.parametrize("wrong", [{"heat_capacity": 0.0}, {"power_limit": -1.0}, {"sensor_lag": np.nan}])
def test_refuses_impossible_thermostats(wrong: dict[str, float]) -> None:
    with pytest.raises(InvalidValueError, match="thermostat"):
        Thermostat(**wrong)
