"""What keeps an object hot or cold from inside: water in a mug, a heater, melting ice."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermograsp.compiled import njit
from thermograsp.errors import InvalidValueError, celsius, non_negative, positive

WATER_SPECIFIC_HEAT = (
    4182.0  # J/(kg K) at 20 °C (Incropera et al., Fundamentals of Heat and Mass Transfer, table A.6)
)
WATER_MELTING_HEAT = 333.6e3  # J/kg (CRC Handbook of Chemistry and Physics, enthalpy of fusion 6.01 kJ/mol)
LEAST_TIME_CONSTANT = (
    0.2  # s, ten control steps, through each of which a reservoir's temperature stands still
)

# temperature: °C, of one that is held, or where its enthalpy is 0. capacity J/K, conductance W/K, power W, setpoint °C
# (inf: always on), latent J, melting °C.
RESERVOIR_ROW = np.dtype(
    [
        ("temperature", "f8"),
        ("capacity", "f8"),
        ("conductance", "f8"),
        ("power", "f8"),
        ("setpoint", "f8"),
        ("latent", "f8"),
        ("melting", "f8"),
    ]
)


@dataclass(frozen=True, slots=True)
class Reservoir:
    """A well mixed body of one temperature in exchange with an object. heat_capacity: J/K; inf holds it at its
    temperature. conductance: W/K between the two, film coefficient times wetted area. temperature: °C at first, None
    for the object's. power: W of a heater in it. setpoint: °C above which the heater rests, None for always on.
    latent_heat: J that it takes up at `melting` °C; one that starts there is all ice, one that starts above all water,
    and both have its heat capacity.

    A mesh with a hollow is met at the walls of that; any other object at its mean temperature.
    Raises InvalidValueError for values that no such body has, and for one that follows the object within .2 s.
    """

    heat_capacity: float
    conductance: float
    temperature: float | None = None
    power: float = 0.0
    setpoint: float | None = None
    latent_heat: float = 0.0
    melting: float = 0.0

    def __post_init__(self) -> None:
        if not self.heat_capacity > 0:
            raise InvalidValueError(
                f"reservoir: heat_capacity must be above 0 J/K, got {self.heat_capacity!r}"
            )
        positive("reservoir: conductance (W/K)", self.conductance)
        for name in ("power", "latent_heat"):
            non_negative(f"reservoir: {name}", getattr(self, name))
        for name in ("temperature", "setpoint", "melting"):
            if getattr(self, name) is not None:
                celsius(f"reservoir: {name} (°C)", getattr(self, name))
        if self.setpoint is not None and self.power == 0:
            raise InvalidValueError(
                f"reservoir: a setpoint of {self.setpoint:g} °C is where a heater rests, and there is none: give its "
                "power in W, or leave setpoint out; one of infinite heat_capacity is held at its temperature"
            )
        if np.isinf(self.heat_capacity) and (self.power or self.latent_heat):
            raise InvalidValueError(
                "reservoir: one of infinite heat_capacity is held at its temperature and takes no power or latent_heat"
            )
        if self.heat_capacity < LEAST_TIME_CONSTANT * self.conductance:
            raise InvalidValueError(
                f"reservoir: {self.heat_capacity:g} J/K behind {self.conductance:g} W/K follows the object in "
                f"{self.heat_capacity / self.conductance:.2g} s: give {LEAST_TIME_CONSTANT:g} s at least"
            )

    def extremes(self, object_temperature: float) -> tuple[float, float]:
        """°C between which it stays by itself, in an object of that temperature at first."""
        start = object_temperature if self.temperature is None else self.temperature
        if self.power == 0:
            return start, start
        return start, np.inf if self.setpoint is None else max(start, self.setpoint)

    def row(self, object_temperature: float) -> tuple[np.void, float]:
        """(RESERVOIR_ROW record, J of enthalpy at first) in an object of that temperature, °C."""
        start = object_temperature if self.temperature is None else self.temperature
        record = np.zeros(1, RESERVOIR_ROW)[0]
        record["temperature"], record["capacity"] = start, self.heat_capacity
        record["conductance"], record["power"] = self.conductance, self.power
        record["setpoint"] = np.inf if self.setpoint is None else self.setpoint
        record["latent"], record["melting"] = self.latent_heat, self.melting
        if np.isinf(self.heat_capacity):
            return record, 0.0
        enthalpy = self.heat_capacity * (start - self.melting)
        return record, enthalpy + (self.latent_heat if enthalpy > 0 else 0.0)


@njit(cache=True, error_model="numpy", inline="always")
def reservoir_temperature(reservoir, enthalpy):
    """°C of a RESERVOIR_ROW at that enthalpy J, which is 0 where all is ice at its melting point."""
    if reservoir.capacity == np.inf:
        return reservoir.temperature
    if enthalpy <= 0.0:
        return reservoir.melting + enthalpy / reservoir.capacity
    return reservoir.melting + max(enthalpy - reservoir.latent, 0.0) / reservoir.capacity


@njit(cache=True, error_model="numpy", inline="always")
def reservoir_step(reservoir, enthalpy, flow, duration):
    """Enthalpy J after `duration` s in which `flow` W left it. The heater gives what keeps the setpoint, as far as its
    power goes."""
    if reservoir.capacity == np.inf:
        return enthalpy - flow * duration
    power = reservoir.power
    if power > 0.0 and reservoir.setpoint < np.inf:
        wanted = reservoir.latent * (reservoir.setpoint > reservoir.melting)
        wanted += reservoir.capacity * (reservoir.setpoint - reservoir.melting)
        power = min(max((wanted - enthalpy) / duration + flow, 0.0), power)
    return enthalpy + (power - flow) * duration


def water(mass: float, conductance: float, temperature: float | None = None) -> Reservoir:
    """Water, kg, behind a film of `conductance` W/K. Free convection in hot water gives some 500 W/(m2 K) on the wetted
    wall: Nu = .59 Ra^(1/4) over 5 cm with 10 K between them (Incropera et al., equation 9.24). Raises InvalidValueError
    for a temperature at which it is ice or steam."""
    if temperature is not None and not 0.0 <= celsius("temperature (°C)", temperature) <= 100.0:
        raise InvalidValueError(
            f"water is liquid from 0 to 100 °C, got a temperature of {temperature:g}: for ice use ice(mass, "
            "conductance), for what is colder or hotter a Reservoir of its own heat_capacity"
        )
    return Reservoir(positive("mass (kg)", mass) * WATER_SPECIFIC_HEAT, conductance, temperature)


def ice(mass: float, conductance: float) -> Reservoir:
    """Melting ice at 0 °C, kg, behind a film of `conductance` W/K; when it has melted its water warms."""
    capacity = positive("mass (kg)", mass) * WATER_SPECIFIC_HEAT
    return Reservoir(capacity, conductance, 0.0, latent_heat=mass * WATER_MELTING_HEAT)
