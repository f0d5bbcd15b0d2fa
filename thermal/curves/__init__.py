"""What a sensor reads of an object that it touches with a conductance that stays: curves per kelvin of difference, as
functions of the object's material, the conductance and the sensor's layers."""

from .unit_curves import UnitCurves

__all__ = ["UnitCurves"]
