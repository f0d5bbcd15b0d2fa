"""A system of contacts whose object gives heat to what is around it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..plates import Geometry
from .system import ContactSystem


def free_area(geometry: Geometry) -> float:
    """m2 of the object that no element covers."""
    touched = geometry.stack.face_area if geometry.mode == "O" else geometry.area
    return geometry.surface - geometry.fingertips * touched


def with_air(system: ContactSystem, air: float) -> tuple[ContactSystem, np.ndarray]:
    """The system in air of `air` W/(m2 K) at the object's first temperature, and the row (K,) W of its heat loss.

    A network that has the air in it already is returned as it is. Else the object's free faces are taken at its mean
    temperature and lose heat evenly (lumped: small errors where the object's own Biot number is small). The loss adds a
    symmetric non-negative rank-one term to the rates, so what is passive stays so; in T mode the mean is a state of its
    own and only its rate grows.
    """
    if system.air_loss is not None:
        return system, system.air_loss
    geometry = system.geometry
    free, capacity = free_area(geometry), geometry.whole_capacity
    mean = system.object_heat / capacity
    if air == 0:
        return system, np.zeros_like(mean)
    if geometry.mode == "T":
        rates = system.rates.copy()
        rates[system.mean] += air * free / capacity
        return replace(system, rates=rates), air * free * mean
    rates, turn = np.linalg.eigh(np.diag(system.rates) + air * free * np.outer(mean, mean))
    turned = replace(
        system,
        rates=np.maximum(rates, 0.0),
        ports=turn.T @ system.ports,
        drop=system.drop @ turn,
        element_heat=system.element_heat @ turn,
        object_heat=system.object_heat @ turn,
        sensor_surface=system.sensor_surface @ turn,
        object_surface=system.object_surface @ turn,
    )
    return turned, air * free * mean @ turn
