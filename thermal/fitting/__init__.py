"""The properties of a sensor, from recorded touches of known objects."""

from .fit import Estimate, SensorFit, fit_sensor
from .known_touch import KnownTouch
from .model import UNITS

__all__ = [
    "UNITS",
    "Estimate",
    "KnownTouch",
    "SensorFit",
    "fit_sensor",
]
