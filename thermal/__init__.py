"""Heat physics: arrays in, arrays out."""

from .layers import Layer, SensorStack, sensor, sensors
from .materials import Material, load_materials, material, materials

__all__ = [
    "Layer",
    "Material",
    "SensorStack",
    "load_materials",
    "material",
    "materials",
    "sensor",
    "sensors",
]
