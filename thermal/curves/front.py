"""What a sensor does when heat is drawn evenly from its face: in one dimension, exact in its layers.

With a thermostat it reads the drop over its sensed layer. A heated sensor reads a temperature's fall, and where contact
ends its heating, falls without any contact too, by as much as it is warmer than what is around it.

S: samples of s.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..matter import SensorStack
from ..plates import stack_profile
from ..stack import ConstantPower, HeatedCore, Held

_UNIFORM = np.zeros(1)  # 1/m2, squared wave number


class Front(NamedTuple):
    """(S,) each. impedance, read: K/W, the fall of the face and what is read, per heat flow out of the face. face_lost,
    read_lost: the same that come without contact, per kelvin of first difference and unit of 1/s."""

    impedance: np.ndarray
    read: np.ndarray
    face_lost: np.ndarray
    read_lost: np.ndarray


def front(element: SensorStack, core: HeatedCore | None, s: np.ndarray) -> Front:
    """Of an element on an ideal thermostat, or in front of a heated sensor's core. s: (S,) 1/s."""
    layers, sensed = element.layers[::-1], len(element.layers) - 1 - element.sensed
    column, area, nothing = s[:, None], element.face_area, np.zeros(len(s))
    if core is None or isinstance(core.sensor.law, Held):
        temperatures, _ = stack_profile(layers, "isothermal", column, _UNIFORM)
        drop = temperatures[sensed] - temperatures[sensed + 1]
        return Front(temperatures[0][:, 0] / area, drop[:, 0] / area, nothing, nothing)
    behind, share = core.chain.seen(s, core.readout)
    temperatures, _ = stack_profile(layers, behind[:, None], column, _UNIFORM)
    falls = [temperature[:, 0] / area for temperature in temperatures]
    read = falls[sensed] if core.readout is None else share * falls[-1]
    if isinstance(core.sensor.law, ConstantPower) or not core.leak:
        return Front(falls[0], read, nothing, nothing)
    # The power that kept it warm is gone: as much is drawn at the heater's place, the face then adiabatic.
    ahead, _ = stack_profile(element.layers, "adiabatic", column, _UNIFORM)
    heater = core.leak / area / (1 / behind + 1 / ahead[0][:, 0])
    reached = [heater * (temperature / ahead[0])[:, 0] for temperature in ahead]
    read_lost = reached[len(layers) - sensed] if core.readout is None else share * heater
    return Front(falls[0], read, reached[-1], read_lost)
