"""The fingertip's thermostat: a plate with a heater of finite power, its own temperature sensor and a PID controller.

B: rows (fingertips). Everything is elementwise, so a row does not depend on the others.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from thermograsp.errors import InvalidValueError, celsius, non_negative, positive

from ..matter import SensorStack

# The seed's plate, 20 x 20 x 1.74 mm, in aluminium: 2700 kg/m3 x 897 J/(kg K); in copper it is 2.40 J/K.
_PLATE_HEAT_CAPACITY = 0.020 * 0.020 * 1.74e-3 * 2700.0 * 897.0

TOO_HOT = 70.0
"""°C by its own sensor at which the device puts both heaters off (docs/protocol.md)."""


@dataclass(frozen=True, slots=True)
class Thermostat:
    """The heater and controller behind a fingertip. setpoint, ambient: °C. heat_capacity: J/K of the plate; inf is an
    ideal thermostat. power_limit: W of the heater, which cannot cool. proportional: W/K, integral: W/(K s), derivative:
    W s/K, gains. sensor_lag: s, time constant of the temperature sensor. loss: W/K to the air.

    The defaults are estimates: an aluminium plate with a 5 W film heater, 10 W/(m2 K) on two free faces, a thermistor
    of 0.2 s, and gains for a closed loop of 1.9 rad/s with a damping ratio near 1.
    Raises InvalidValueError for a value that no thermostat can have.
    """

    setpoint: float = 36.0
    ambient: float = 24.0
    heat_capacity: float = _PLATE_HEAT_CAPACITY
    power_limit: float = 5.0
    proportional: float = 8.0
    integral: float = 8.0
    derivative: float = 0.5
    sensor_lag: float = 0.2
    loss: float = 0.008

    def __post_init__(self) -> None:
        celsius("thermostat: setpoint (°C)", self.setpoint)
        celsius("thermostat: ambient (°C)", self.ambient)
        if not self.heat_capacity > 0:
            raise InvalidValueError(
                f"thermostat: heat_capacity must be above 0 J/K, got {self.heat_capacity!r}"
            )
        positive("thermostat: power_limit (W)", self.power_limit)
        for name in ("proportional", "integral", "derivative", "sensor_lag", "loss"):
            non_negative(f"thermostat: {name}", getattr(self, name))


def thermostat_at(
    setpoint: float, thermostat: Thermostat, stack: SensorStack | None, dt: float
) -> Thermostat:
    """The thermostat with that setpoint, °C, stepped every dt s, behind that element, or bare.

    Raises InvalidValueError for what is none, such as a temperature, and for a plate that is lighter than what of the
    element follows it within a step: each would push the other further from step to step."""
    if not isinstance(thermostat, Thermostat):
        raise InvalidValueError(
            f"thermostat must be a thermal.Thermostat, or None for an ideal one, got {thermostat!r}"
        )
    if stack is not None and thermostat.heat_capacity < (least := stack.answering(dt)):
        raise InvalidValueError(
            f"thermostat: a plate of {thermostat.heat_capacity:g} J/K is lighter than what of the sensor {stack.name} "
            f"follows it within a step of {dt:g} s, {least:.3g} J/K: give it {least:.3g} J/K or more, or a shorter step"
        )
    return replace(thermostat, setpoint=setpoint)


def ideal_thermostat(setpoint: float = 36.0) -> Thermostat:
    """One whose plate never leaves the setpoint."""
    return Thermostat(setpoint=setpoint, heat_capacity=np.inf)


@dataclass(frozen=True, slots=True)
class ThermostatState:
    """The state of many thermostats. temperature, measured, previous: °C, of the plate, by its sensor, and by its
    sensor a step ago. integral: W, the controller's integral part. power: W, the heater's over the last step. Arrays
    (B,)."""

    temperature: np.ndarray
    measured: np.ndarray
    previous: np.ndarray
    integral: np.ndarray
    power: np.ndarray


def settled_thermostat(thermostat: Thermostat, rows: int) -> ThermostatState:
    """The state of a thermostat that has been at its setpoint for long, nothing drawn; where the heater is too weak for
    that, at what it reaches."""
    wanted = thermostat.loss * (thermostat.setpoint - thermostat.ambient)
    power = min(max(wanted, 0.0), thermostat.power_limit)
    temperature = thermostat.setpoint
    if power != wanted and np.isfinite(thermostat.heat_capacity):
        temperature = thermostat.ambient + power / thermostat.loss
    plate = np.full(rows, temperature)
    return ThermostatState(plate, plate, plate, np.full(rows, power), np.full(rows, power))


def thermostat_step(
    thermostat: Thermostat, state: ThermostatState, drawn: np.ndarray, dt: float
) -> ThermostatState:
    """The state dt (s) later, with `drawn` (B,) W taken from the plate by the fingertip.

    The controller acts once a step, on the sensor's temperature; its derivative acts on the measurement, not on the
    setpoint, and its integral rests while the heater is at a limit that it would push further. Plate and sensor are
    exact for the constant power, up to the sensor's input being taken as linear. The plate's balance is
    heat_capacity x change = dt (power - drawn) - loss, loss the integral to the air. An ideal thermostat's power is
    what is drawn and lost.
    """
    drawn = np.asarray(drawn, dtype=float)
    if np.isinf(thermostat.heat_capacity):
        power = drawn + thermostat.loss * (thermostat.setpoint - thermostat.ambient)
        return ThermostatState(state.temperature, state.measured, state.measured, state.integral, power)
    power, integral = _control(thermostat, state, dt)
    temperature = _plate(thermostat, state.temperature, power - drawn, dt)
    lag = thermostat.sensor_lag
    measured = temperature
    if lag:
        behind = (temperature - state.temperature) * (lag / dt)
        measured = temperature - behind + (state.measured - state.temperature + behind) * np.exp(-dt / lag)
    return ThermostatState(temperature, measured, state.measured, integral, power)


def _control(thermostat: Thermostat, state: ThermostatState, dt: float) -> tuple[np.ndarray, np.ndarray]:
    """(power, integral) W."""
    error = thermostat.setpoint - state.measured
    rate = (state.measured - state.previous) / dt
    integral = state.integral + thermostat.integral * error * dt
    wanted = thermostat.proportional * error + integral - thermostat.derivative * rate
    power = np.clip(wanted, 0.0, thermostat.power_limit)
    winding = (wanted - power) * error > 0
    return power, np.where(winding, state.integral, integral)


def _plate(thermostat: Thermostat, temperature: np.ndarray, heat: np.ndarray, dt: float) -> np.ndarray:
    if thermostat.loss == 0:
        return temperature + heat * (dt / thermostat.heat_capacity)
    final = thermostat.ambient + heat / thermostat.loss
    return temperature + (final - temperature) * -np.expm1(-dt * thermostat.loss / thermostat.heat_capacity)
