"""What a step of many worlds takes and gives.

B: worlds, F: fingertips, O: objects, N = F O: pairs, K: states of all fields, R: states of a narrow contact.
"""

from __future__ import annotations

from typing import NamedTuple

from ...thermal import SignalState
from ...thermal.numerics import Array


class FixedTouchState(NamedTuple):
    """The state of heat and electronics in every world. heat: (B, K) of all fields. narrow: (B, N, R). signal: of the
    electronics, (B, F) each, and voltage: (B, F, samples) V as reported, oldest first. material: (B, O) integers, and
    first: (B, O) °C of the objects at a reset."""

    heat: Array
    narrow: Array
    signal: SignalState
    voltage: Array
    material: Array
    first: Array


class FixedTouchReading(NamedTuple):
    """After a step. voltage: (B, F, samples) V as the driver reports it, oldest first. temperature_drop: (B, F) K over
    the sensed layer. force (B, F) N normal on the pads, beside (B, F) N on the fingertips off their pads, and
    conductance (B, F, O) W/K: means over the step. touching: (B, F) number of the object that presses most, -1 for
    none. object_temperature: (B, O) °C, the objects' means. Of a world with a number that is not finite, these are not
    numbers until it is reset."""

    voltage: Array
    temperature_drop: Array
    force: Array
    beside: Array
    conductance: Array
    touching: Array
    object_temperature: Array
