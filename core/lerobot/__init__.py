"""LeRobot's robot of our fingertips, with or without a gripper, on serial ports.

lerobot-record --robot.discover_packages_path=thermograsp.lerobot --robot.type=thermograsp_hand \\
    --robot.port=/dev/ttyACM0 --robot.gripper=robotiq:///dev/ttyUSB0 ...
"""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from .hand import ThermograspHand, ThermograspHandConfig

__all__ = ["ThermograspHand", "ThermograspHandConfig"]

__getattr__ = opened(__name__)
