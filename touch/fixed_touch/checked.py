"""What a step of many worlds is given, checked. Numbers are looked into where they are NumPy's."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from thermograsp.errors import InvalidValueError

from ...thermal.numerics import Array, as_integers, as_like
from ..contacts import TouchContacts
from .state import FixedTouchState


def check_step(
    state: FixedTouchState, contacts: TouchContacts, *, substeps: int, geoms: int, dt: float
) -> None:
    """Raises InvalidValueError where a step of dt s of so many substeps cannot take them."""
    if not isinstance(state, FixedTouchState):
        raise InvalidValueError(
            f"advance takes a FixedTouchState, got {type(state).__name__}: begin with the one of start()"
        )
    if not isinstance(contacts, TouchContacts):
        raise InvalidValueError(
            f"advance takes TouchContacts, got {type(contacts).__name__}: for recorded sensordata "
            "advance(state, fixed.contacts(record))"
        )
    worlds, tips = state.signal.last.shape
    expected = {
        "force": (worlds, substeps, tips, geoms, "L", 3),
        "place": (worlds, substeps, tips, geoms, "L", 3),
        "tip_position": (worlds, substeps, tips, 3),
        "tip_turn": (worlds, substeps, tips, 3, 3),
        "geom_position": (worlds, substeps, geoms, 3),
        "geom_turn": (worlds, substeps, geoms, 3, 3),
    }
    forces = contacts.force.shape[4] if len(contacts.force.shape) == 6 else 0
    for name, shape in expected.items():
        found = tuple(getattr(contacts, name).shape)
        if found != tuple(forces if side == "L" else side for side in shape) or not forces:
            raise InvalidValueError(
                f"contacts: {name} must have the shape {shape} (worlds, substeps of a step of {dt:g} s, ...), "
                f"got {found}"
            )


def checked_material(material: Array, state: FixedTouchState, choices: Mapping[str, int]) -> Array:
    """(B, O) integers, below the number of materials that each object, by name, may be of."""
    shape = tuple(state.material.shape)
    material = material if hasattr(material, "dtype") else np.asarray(material)
    if tuple(np.shape(material)) != shape:
        raise InvalidValueError(f"material must have the shape {shape}, got {tuple(np.shape(material))}")
    if isinstance(material, np.ndarray):  # tensors are not looked into
        counts = np.array(list(choices.values()))
        if material.dtype.kind not in "iu" or not ((material >= 0) & (material < counts)).all():
            raise InvalidValueError(
                f"material must be whole numbers, of {dict(choices)} "
                f"materials from 0 on, got {material if material.size < 20 else material.dtype}"
            )
        return as_integers(as_like(material, state.heat))
    return as_integers(material)


def checked_temperature(temperature: Array, state: FixedTouchState) -> Array:
    """(B, O) °C."""
    temperature = temperature if hasattr(temperature, "dtype") else np.asarray(temperature)
    if tuple(np.shape(temperature)) != tuple(state.first.shape):
        raise InvalidValueError(
            f"temperature must have the shape {tuple(state.first.shape)} °C, got {tuple(np.shape(temperature))}"
        )
    if isinstance(temperature, np.ndarray):
        if not (np.isfinite(temperature) & (temperature > -273.15)).all():
            raise InvalidValueError(f"temperature must be finite °C above -273.15, got {temperature}")
        return as_like(temperature, state.heat)
    return temperature


def checked_worlds(worlds: Array, state: FixedTouchState) -> Array:
    """(B,) bool."""
    count = state.heat.shape[0]
    worlds = worlds if hasattr(worlds, "dtype") else np.asarray(worlds)
    if tuple(np.shape(worlds)) != (count,) or "bool" not in str(getattr(worlds, "dtype", "")):
        raise InvalidValueError(
            f"worlds must be ({count},) booleans, got {getattr(worlds, 'dtype', type(worlds).__name__)} of shape "
            f"{tuple(np.shape(worlds))}"
        )
    return as_like(worlds, state.heat) > 0 if isinstance(worlds, np.ndarray) else worlds
