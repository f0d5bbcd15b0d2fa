"""The serial plant: a real gripper with real fingertips behind the interface of the simulated one."""

from .serial import OVERRUN, PaceCounts, SerialConfig, SerialPlant

__all__ = [
    "OVERRUN",
    "PaceCounts",
    "SerialConfig",
    "SerialPlant",
]
