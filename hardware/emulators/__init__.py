"""Fingertips and grippers in software, and their faults."""

from .feel import Feel, Source, press_source, samples_source, untouched
from .fingers import Fingers, SpringFingers
from .fingertips import DeviceModel, EmulatedFingertips
from .modbus_slave import INSTANT, LinePacing
from .planned_faults import plan_fault
from .planned_gripper_faults import plan_gripper_fault
from .robotiq import EmulatedGripper, GripperModel

__all__ = [
    "INSTANT",
    "DeviceModel",
    "EmulatedFingertips",
    "EmulatedGripper",
    "Feel",
    "Fingers",
    "GripperModel",
    "LinePacing",
    "Source",
    "SpringFingers",
    "plan_fault",
    "plan_gripper_fault",
    "press_source",
    "samples_source",
    "untouched",
]
