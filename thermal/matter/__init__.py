"""What things are made of: materials of objects, sensor stacks, and how a sensor is mounted."""

from .layers import Layer
from .materials import SEED_MATERIALS, Material, load_materials, material, materials
from .mounting import Mode, Shape
from .sensors import SensorStack, load_sensors, sensor, sensors, write_sensor
from .skins import SKINS, USUAL_SKIN, Skin, skin
from .surrounds import Surround, surround

__all__ = [
    "SEED_MATERIALS",
    "SKINS",
    "USUAL_SKIN",
    "Layer",
    "Material",
    "Mode",
    "SensorStack",
    "Shape",
    "Skin",
    "Surround",
    "load_materials",
    "load_sensors",
    "material",
    "materials",
    "sensor",
    "sensors",
    "skin",
    "surround",
    "write_sensor",
]
