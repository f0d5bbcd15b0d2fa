"""The serial plant: a real gripper with real fingertips behind the interface of the simulated one."""

from .config import PaceCounts, SerialConfig
from .pacing import VirtualTime
from .serial import OVERRUN, SerialPlant, without_maps

__all__ = [
    "OVERRUN",
    "PaceCounts",
    "SerialConfig",
    "SerialPlant",
    "VirtualTime",
    "without_maps",
]
