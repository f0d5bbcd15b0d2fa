"""What things are made of: materials of objects, sensor stacks, and how a sensor is mounted."""

from .layers import Layer
from .materials import SEED_MATERIALS, Material, load_materials, material, materials
from .mounting import Mode, Shape
from .sensors import SensorStack, load_sensors, sensor, sensors, write_sensor

__all__ = [
    "SEED_MATERIALS",
    "Layer",
    "Material",
    "Mode",
    "SensorStack",
    "Shape",
    "load_materials",
    "load_sensors",
    "material",
    "materials",
    "sensor",
    "sensors",
    "write_sensor",
]
