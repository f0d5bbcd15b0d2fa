"""What a sensor does when heat is drawn evenly from its face: in one dimension, exact in its layers.

With a thermostat it reads the drop over its sensed layer. A heated sensor reads a temperature's fall, and where contact
ends its heating, falls without any contact too, by as much as it is warmer than what is around it.

S: samples of s.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..matter import SensorStack
from ..plates import Far, stack_profile
from ..stack import Backing, ConstantPower, HeatedCore, Held

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
    behind, share = _behind(core, column)
    temperatures, _ = stack_profile(layers, behind, column, _UNIFORM)
    falls = [temperature[:, 0] / area for temperature in temperatures]
    read = falls[sensed] if core.readout is None else share * falls[-1]
    if isinstance(core.sensor.law, ConstantPower) or not core.leak or isinstance(behind, str):
        return Front(falls[0], read, nothing, nothing)
    # The power that kept it warm is gone: as much is drawn at the heater's place, the face then adiabatic.
    ahead, _ = stack_profile(element.layers, "adiabatic", column, _UNIFORM)
    heater = core.leak / area / (1 / behind + 1 / ahead[0])[:, 0]
    reached = [heater * (temperature / ahead[0])[:, 0] for temperature in ahead]
    read_lost = reached[len(layers) - sensed] if core.readout is None else share * heater
    return Front(falls[0], read, reached[-1], read_lost)


def _behind(core: HeatedCore, s: np.ndarray) -> tuple[Far | np.ndarray, np.ndarray]:
    """Of what is behind the heater's place, at s (S, 1): its impedance (S, 1) m2 K/W, and the share (S,) of the place's
    temperature that arrives where a readout behind it is."""
    backing = core.sensor.backing
    end: Far | np.ndarray = "adiabatic"
    if backing != Backing():
        end = 1 / (s * backing.capacity + np.sqrt(s) * backing.effusivity + backing.loss)
    if not core.behind:
        return end, np.ones(len(s))
    temperatures, _ = stack_profile(core.behind[::-1], end, s, _UNIFORM)
    return temperatures[0], (temperatures[core.ahead] / temperatures[0])[:, 0]
