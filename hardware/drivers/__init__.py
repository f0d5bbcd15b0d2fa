"""Drivers of fingertips and grippers."""

from .axis import Axis
from .fingertips import Fingertips, LinkStatistics
from .gripper import Contact, Gripper, GripperStatus, open_gripper
from .link import OPENED, LinkSettings, Tap
from .modbus_line import ModbusSettings
from .robotiq import RobotiqGripper
from .robotiq_registers import (
    COMMAND,
    COUNT,
    FIRST_MAJOR,
    SLAVE,
    STATUS,
    Action,
    Activation,
    Fault,
    ObjectSeen,
    State,
    action,
)
from .robotiq_units import CURRENT_STEP, TOP, RobotiqUnits

__all__ = [
    "COMMAND",
    "COUNT",
    "CURRENT_STEP",
    "FIRST_MAJOR",
    "OPENED",
    "SLAVE",
    "STATUS",
    "TOP",
    "Action",
    "Activation",
    "Axis",
    "Contact",
    "Fault",
    "Fingertips",
    "Gripper",
    "GripperStatus",
    "LinkSettings",
    "LinkStatistics",
    "ModbusSettings",
    "ObjectSeen",
    "RobotiqGripper",
    "RobotiqUnits",
    "State",
    "Tap",
    "action",
    "open_gripper",
]
