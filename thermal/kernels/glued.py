"""A sensor's element that is glued on: both its faces are free to take and give heat, its sides are adiabatic.

Along its depth it is one-dimensional, in linear finite elements, since the mean temperature drop follows from the even
pattern alone. Uneven patterns at the bond see what they see under a fingertip: they fade within the element's depth
(lateral ones of a face 9 mm wide by exp(-4.2) there and back over 3 mm), so that its other face does not matter.

n: states, M: patterns.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import eigh

from ..matter import SensorStack
from ..numerics import ThermalNetwork
from .contact import Resolution, Tip, tip
from .element import POLES

_CELLS = 8
"""Of a layer."""
_LEAST = 1e-6  # of the largest port, below which a state of the even pattern is left out


@dataclass(frozen=True, slots=True, eq=False)
class GluedElement:
    """bond: the face on the object's side, outputs as of `tip`; temperatures count from 0. top: (n, M) ports of the
    face that the thermostat touches. uniform: (n,) states of an element that is 1 K warm throughout."""

    bond: Tip
    top: np.ndarray
    uniform: np.ndarray


def glued_element(stack: SensorStack, level: Resolution) -> GluedElement:
    """The whole element, its first layer on the thermostat's side."""
    whole = (0.0, stack.width)
    held = tip(stack, (whole, whole), level)
    rates, modes, heat = _along(stack)
    drop = modes[stack.sensed * _CELLS] - modes[(stack.sensed + 1) * _CELLS]
    uneven = held.side.ports[POLES:] * (np.arange(level.patterns) > 0)
    fading = np.abs(uneven).max(axis=1, initial=0.0) > _LEAST * np.abs(uneven).max(initial=0.0)
    uneven, rest = uneven[fading], np.zeros(fading.sum())
    side = ThermalNetwork(
        np.concatenate((rates, held.side.rates[POLES:][fading])),
        np.concatenate((modes[-1][:, None] * held.even, uneven)),
        outputs={"drop": np.concatenate((drop, rest)), "element": np.concatenate((heat, rest))},
    )
    top = np.concatenate((modes[0][:, None] * held.even, 0 * uneven))
    return GluedElement(replace(held, side=side), top, side.outputs["element"])


def _along(stack: SensorStack) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of the element with adiabatic faces: rates (n,) 1/s, modes (nodes, n) sqrt(K/J) from the thermostat's side to the
    object's, and their heat (n,) sqrt(J K)."""
    nodes = len(stack.layers) * _CELLS + 1
    stores, conducts = np.zeros((nodes, nodes)), np.zeros((nodes, nodes))
    for number, layer in enumerate(stack.layers):
        length = layer.thickness / _CELLS
        capacity = layer.volumetric_heat_capacity * length * stack.face_area
        conductance = layer.conductivity * stack.face_area / length
        for first in range(number * _CELLS, (number + 1) * _CELLS):
            pair = np.ix_((first, first + 1), (first, first + 1))
            stores[pair] += capacity / 6 * np.array([[2, 1], [1, 2]])
            conducts[pair] += conductance * np.array([[1, -1], [-1, 1]])
    rates, modes = eigh(conducts, stores)
    # all at one temperature does not fade, whatever rounding leaves of it
    return np.where(np.arange(nodes) == 0, 0.0, rates), modes, modes.T @ stores.sum(axis=0)
