"""What a sensor sends, and how it is taken: the converter's range, and the voltage as kelvins of fall."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thermograsp.errors import InvalidValueError

from ..matter import SensorStack
from ..readout import ADS1115, ADS1115_DIVIDER, SignalChain
from .design import HeatedStack
from .laws import ConstantPower, Pid

_HOTTEST = 60.0  # °C


def converter(sensor: SensorStack | HeatedStack, chain: SignalChain) -> SignalChain:
    """The chain as it takes this sensor: an ADS1115 in the range that holds a divider's voltage, behind a low-pass of
    the recorder's corner. The recorder's smoothing looks ahead, so that no converter does it."""
    if isinstance(sensor, SensorStack):
        return chain
    most = highest_voltage(sensor)
    fitting = ADS1115_DIVIDER if chain == ADS1115 and chain.limits[1] < most else chain
    if fitting.limits[1] < most:
        raise InvalidValueError(
            f"the signal chain ends at {fitting.limits[1]:.3g} V, the divider of sensor {sensor.name!r} sends up to "
            f"{most:.3g} V at {_HOTTEST:g} °C: give a chain of a larger span or a smaller gain"
        )
    corner = sensor.recorder.corner
    return replace(fitting, bandwidth=min(fitting.bandwidth, corner)) if corner else fitting


def highest_voltage(sensor: HeatedStack) -> float:
    """V of the divider at the hottest that a fingertip is."""
    return float(sensor.divider.voltage(np.array(_HOTTEST)))


def fallen(sensor: HeatedStack, voltage: np.ndarray, start: float) -> np.ndarray:
    """K below start °C, of a divider's voltages. Raises InvalidValueError for voltages that no divider sends."""
    wrong = voltage[(voltage <= 0) | (voltage >= sensor.divider.supply)]
    if wrong.size:
        raise InvalidValueError(
            f"a voltage of {wrong.flat[0]:g} V is not between 0 and the {sensor.divider.supply:g} V that divides in "
            f"sensor {sensor.name!r}: is it the sensor that made these samples?"
        )
    return start - sensor.divider.temperature(voltage)


def require_linear(sensor: HeatedStack, task: str) -> None:
    """Raises InvalidValueError where a curve is not in proportion to the difference of temperature, so that nothing
    that takes curves per kelvin serves the sensor."""
    if isinstance(sensor.law, Pid):
        raise InvalidValueError(
            f"sensor {sensor.name!r}: {task} takes curves in proportion to the difference of temperature, and a "
            "controller that cannot cool makes none; cut it at contact (law 'cut_at_contact'), or use touch_curves"
        )
    if isinstance(sensor.law, ConstantPower) and sensor.law.power is not None:
        raise InvalidValueError(
            f"sensor {sensor.name!r}: {task} takes curves in proportion to the difference of temperature; a power of "
            f"{sensor.law.power:g} W/m2 does not follow it; leave the law's power out for the one that keeps it warm"
        )
