"""What a sensor reads of an object that it touches with a conductance that stays: curves per kelvin of difference, as
functions of the object's material, the conductance and the sensor's layers. And what a contact that is narrower than
the sensor's face meets on both sides."""

from .narrow import CONFORMING, LAPPED, equal_square, plate_impedance, stack_impedance
from .unit_curves import UnitCurves

__all__ = [
    "CONFORMING",
    "LAPPED",
    "UnitCurves",
    "equal_square",
    "plate_impedance",
    "stack_impedance",
]
