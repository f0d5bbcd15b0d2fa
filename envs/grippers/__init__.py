"""The shipped gripper, and how fingertips are put onto any other gripper."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from .fingertip import FingertipReport, fit_fingertip
    from .load import load_gripper
    from .mounted import Gripper
    from .shipped import SHIPPED_GRIPPER, GripperModel

__all__ = [
    "SHIPPED_GRIPPER",
    "FingertipReport",
    "Gripper",
    "GripperModel",
    "fit_fingertip",
    "load_gripper",
]

__getattr__ = opened(__name__)
