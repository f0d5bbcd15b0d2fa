"""Where a session's grasp comes from: a simulation, a recording or a real gripper."""

from __future__ import annotations

from thermograsp.studio.control import Choices, Stock
from thermograsp.studio.sources.measured import MeasuredGrasp
from thermograsp.studio.sources.played import PlayedGrasp
from thermograsp.studio.sources.simulated import SimulatedGrasp

Grasp = SimulatedGrasp | PlayedGrasp | MeasuredGrasp


def grasp_of(choices: Choices, stock: Stock) -> Grasp:
    """What the stock holds, of these choices."""
    if stock.recording is not None:
        return PlayedGrasp(choices, stock)
    if stock.plant is not None:
        return MeasuredGrasp(choices, stock)
    return SimulatedGrasp(choices, stock)
