"""Voltages of touches as a function of a sensor's properties, and their slopes.

n: samples of a touch.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np
from scipy.interpolate import CubicSpline

from ..curves import UnitCurves
from ..matter import SensorStack
from ..plates import Geometry
from ..stack import HeatedCore
from .known_touch import KnownTouch

UNITS: Mapping[str, str] = MappingProxyType(
    {"seebeck": "V/K", "offset": "V", "delay": "s", "conductivity": "W/(m K)", "heat_capacity": "J/(m3 K)"}
)
POSITIVE = ("seebeck", "conductivity", "heat_capacity")  # whose slopes are by the logarithm
MOST_DELAY = (-0.2, 1.0)  # s
_STEP = 1e-4  # of a logarithm, for central differences
_FIRST, _SPACING = 0.03, 0.01  # s^0.5, of the times of curves, which are even in the root of time
_ENDS = ((1, 0.0), "not-a-knot")  # a curve rises from 0 slower than the root of time

Shared = Mapping[str, float]  # a value of every key of UNITS


def shared_of(stack: SensorStack) -> dict[str, float]:
    """What a stack says of UNITS: its Seebeck coefficient and its sensed layer; offset and delay are 0."""
    layer = stack.layers[stack.sensed]
    return {
        "seebeck": stack.seebeck,
        "offset": 0.0,
        "delay": 0.0,
        "conductivity": layer.conductivity,
        "heat_capacity": layer.volumetric_heat_capacity,
    }


def with_shared(stack: SensorStack, shared: Shared) -> SensorStack:
    """The stack with that Seebeck coefficient and sensed layer, whose density is kept."""
    layers = list(stack.layers)
    layer = layers[stack.sensed]
    layers[stack.sensed] = replace(
        layer, conductivity=shared["conductivity"], specific_heat=shared["heat_capacity"] / layer.density
    )
    return replace(stack, layers=tuple(layers), seebeck=shared["seebeck"])


class TouchModel:
    """The voltage of a touch as a function of the fitted quantities. stack: what is not fitted of the sensor.
    bandwidth: Hz of the amplifier's low-pass. core: what is behind a heated sensor's element.

    Voltage of a touch at t: offset + seebeck difference drop(t - delay - late; sensed layer, conductance).
    """

    def __init__(
        self,
        touches: Sequence[KnownTouch],
        stack: SensorStack,
        bandwidth: float,
        core: HeatedCore | None = None,
    ) -> None:
        self.touches, self._stack = tuple(touches), stack
        horizon = max(touch.t[-1] for touch in touches) - 2 * MOST_DELAY[0]
        self._times = np.append(0.0, np.arange(_FIRST, np.sqrt(horizon) + 2 * _SPACING, _SPACING))
        of_each = [_geometry(touch, stack) for touch in touches]
        of_geometry = {
            geometry: UnitCurves(geometry, self._times**2, bandwidth, core).on(geometry.material)
            for geometry in set(of_each)
        }
        self._of_touch = [of_geometry[geometry] for geometry in of_each]

    def voltage(self, touch: int, shared: Shared, conductance: float, late: float) -> np.ndarray:
        """(n,) V of a touch of the list. conductance: W/(m2 K). late: s."""
        curve = self._curve(touch, shared, conductance)
        return shared["offset"] + self._scale(touch, shared) * curve(self._roots(touch, shared, late))

    def slopes(self, touch: int, shared: Shared, conductance: float, late: float) -> dict[str, np.ndarray]:
        """(n,) by each key of UNITS and by "conductance", which is a logarithm like POSITIVE. By late as by delay."""
        curve, roots = self._curve(touch, shared, conductance), self._roots(touch, shared, late)
        scale = self._scale(touch, shared)
        with np.errstate(divide="ignore", invalid="ignore"):
            falling = np.where(roots > 0, -curve(roots, 1) / (2 * roots), 0.0)

        def by_logarithm(name: str) -> np.ndarray:
            ends = []
            for factor in (np.exp(_STEP), np.exp(-_STEP)):
                if name == "conductance":
                    changed = self._curve(touch, shared, conductance * factor)
                else:
                    changed = self._curve(touch, {**shared, name: shared[name] * factor}, conductance)
                ends.append(changed(roots))
            return scale * (ends[0] - ends[1]) / (2 * _STEP)

        return {
            "seebeck": scale * curve(roots),
            "offset": np.ones(len(roots)),
            "delay": scale * falling,
            **{name: by_logarithm(name) for name in ("conductivity", "heat_capacity", "conductance")},
        }

    def _curve(self, touch: int, shared: Shared, conductance: float) -> CubicSpline:
        """K per K of difference over the root of the time after the touch, s^0.5."""
        of_geometry = self._of_touch[touch](np.array([conductance]), with_shared(self._stack, shared))
        return CubicSpline(self._times, of_geometry[0], bc_type=_ENDS)  # pyright: ignore[reportArgumentType]

    def _roots(self, touch: int, shared: Shared, late: float) -> np.ndarray:
        """s^0.5 after the touch, 0 before."""
        return np.sqrt(np.maximum(self.touches[touch].t - shared["delay"] - late, 0.0))

    def _scale(self, touch: int, shared: Shared) -> float:
        return shared["seebeck"] * self.touches[touch].difference


def _geometry(touch: KnownTouch, stack: SensorStack) -> Geometry:
    """Two equal fingertips drive no heat through the middle plane: each has a plate of half the thickness."""
    width, depth, thickness = touch.object_size
    size = (width, depth, thickness / touch.fingertips)
    return Geometry(stack, touch.material, "T", stack.face_area, "square", size)
