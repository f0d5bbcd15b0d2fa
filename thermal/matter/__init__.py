"""What things are made of: materials of objects, sensor stacks, and how a sensor is mounted."""

from .layers import Layer
from .materials import SEED_MATERIALS, Material, load_materials, material, materials
from .mounting import Mode, Shape
from .reservoir import RESERVOIR_ROW, Reservoir, ice, reservoir_step, reservoir_temperature, water
from .sensors import SensorStack, load_sensors, sensor, sensors, write_sensor
from .skins import SKINS, USUAL_SKIN, Skin, skin
from .surrounds import Surround, surround

__all__ = [
    "RESERVOIR_ROW",
    "SEED_MATERIALS",
    "SKINS",
    "USUAL_SKIN",
    "Layer",
    "Material",
    "Mode",
    "Reservoir",
    "SensorStack",
    "Shape",
    "Skin",
    "Surround",
    "ice",
    "load_materials",
    "load_sensors",
    "material",
    "materials",
    "reservoir_step",
    "reservoir_temperature",
    "sensor",
    "sensors",
    "skin",
    "surround",
    "water",
    "write_sensor",
]
