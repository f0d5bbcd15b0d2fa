"""Where a visit gets its grasp from: a simulation, a recording or a real gripper."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.studio.sources.played import PlayedGrasp
    from thermograsp.studio.sources.simulated import SimulatedGrasp
    from thermograsp.studio.sources.source import grasp_of

__all__ = [
    "PlayedGrasp",
    "SimulatedGrasp",
    "grasp_of",
]

__getattr__ = opened(__name__)
