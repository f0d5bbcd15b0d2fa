"""Heat for environments that others wrote, unmodified: Gymnasium's, robosuite's and dm_control's."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from .dm_control import DmControlThermalWrapper
    from .gymnasium import AddThermalObservation
    from .robosuite import RobosuiteThermalWrapper

__all__ = ["AddThermalObservation", "DmControlThermalWrapper", "RobosuiteThermalWrapper"]

__getattr__ = opened(__name__)
