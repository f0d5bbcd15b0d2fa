"""From a temperature drop to the voltage that a driver reports, and the thermostat behind the sensor."""

from .kernel import CHAIN_NUMBERS, chain_numbers, compile_measuring, measure_rows
from .signal import (
    ADS1115,
    ADS1115_DIVIDER,
    IDEAL,
    SIGNAL_CHAINS,
    SignalChain,
    SignalState,
    measure,
    measure_sample,
    saturated,
    settled,
)
from .thermostat import (
    TOO_HOT,
    Thermostat,
    ThermostatState,
    ideal_thermostat,
    settled_thermostat,
    thermostat_at,
    thermostat_step,
)

__all__ = [
    "CHAIN_NUMBERS",
    "ADS1115",
    "ADS1115_DIVIDER",
    "IDEAL",
    "SIGNAL_CHAINS",
    "TOO_HOT",
    "SignalChain",
    "SignalState",
    "Thermostat",
    "ThermostatState",
    "chain_numbers",
    "compile_measuring",
    "ideal_thermostat",
    "measure",
    "measure_rows",
    "measure_sample",
    "saturated",
    "settled",
    "settled_thermostat",
    "thermostat_at",
    "thermostat_step",
]
