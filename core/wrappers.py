"""Heat for environments that others wrote, by the name that the root package lends: thermograsp.touch.wrappers."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.touch.wrappers import (
        AddThermalObservation,
        DmControlThermalWrapper,
        RobosuiteThermalWrapper,
    )

__all__ = ["AddThermalObservation", "DmControlThermalWrapper", "RobosuiteThermalWrapper"]

__getattr__ = opened(__name__)
