"""Hardware and simulation together: devices that a simulation moves, and a real grasp beside a simulated one."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.twin.beside import Beside, grasp_beside, measured_columns
    from thermograsp.twin.plant import TwinPlant
    from thermograsp.twin.simulated_hand import SimulatedHand

__all__ = ["Beside", "SimulatedHand", "TwinPlant", "grasp_beside", "measured_columns"]

__getattr__ = opened(__name__)
