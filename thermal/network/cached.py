"""A contact's network for a demand or of given orders, built once and then read from the cache."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np

from thermograsp.errors import InvalidValueError
from thermograsp.files import cached_arrays

from ..plates import Geometry
from .boxes import lumped_air_error
from .choice import Choice, Demand, UnkeptToleranceError, choose, least_error
from .states import Orders
from .system import ContactSystem, contact_system, sample_geometry

_ARRAYS = ("rates", "ports", "drop", "element_heat", "object_heat", "sensor_surface", "object_surface")


def network_for(geometry: Geometry, demand: Demand, *, air: float = 0.0, cache: bool = True) -> Choice:
    """The cheapest network that keeps the demand's tolerance where it is put in air W/(m2 K) (air.py), which its error
    counts. Raises InvalidValueError where none does."""
    lumped = lumped_air_error(geometry, demand, air)
    if lumped >= demand.tolerance:
        raise InvalidValueError(
            f"no network keeps {demand.tolerance:g} K for this contact in air of {air:g} W/(m2 K): taken at the "
            f"object's mean temperature, the air leaves up to {lumped:.2g} K; give a tolerance of "
            f"{1.1 * (lumped + least_error(demand)):.2g} K or more"
        )
    remaining = replace(demand, tolerance=demand.tolerance - lumped)

    def build() -> dict[str, np.ndarray]:
        choice = choose(sample_geometry(geometry), remaining)
        return {**_pack(choice.system), "error": np.array(choice.error)}

    try:
        arrays = cached_arrays({**_key(geometry), "demand": remaining}, build, enabled=cache)
    except UnkeptToleranceError as refusal:
        raise UnkeptToleranceError(demand.tolerance, refusal.kept + lumped) from None
    return Choice(_unpack(geometry, arrays), float(arrays["error"]) + lumped)


def network_of(geometry: Geometry, orders: Orders, *, cache: bool = True) -> ContactSystem:
    """The network of those orders. Raises InvalidValueError where they cannot be filled."""

    def build() -> dict[str, np.ndarray]:
        return _pack(contact_system(sample_geometry(geometry), orders))

    arrays = cached_arrays({**_key(geometry), "orders": str(orders)}, build, enabled=cache)
    return _unpack(geometry, arrays)


def _key(geometry: Geometry) -> dict[str, object]:
    """What heat conduction knows of a geometry: names and sources of materials play no part."""
    stack = geometry.stack
    layers = [
        (each.thickness, each.conductivity, each.volumetric_heat_capacity) for each in geometry.stack.layers
    ]
    known = {"stack", "material"}
    return {
        "layers": layers,
        "width": stack.width,
        "sensed": stack.sensed,
        "object": (geometry.material.conductivity, geometry.material.volumetric_heat_capacity),
        **{f.name: getattr(geometry, f.name) for f in fields(geometry) if f.name not in known},
    }


def _pack(system: ContactSystem) -> dict[str, np.ndarray]:
    return {
        **{name: getattr(system, name) for name in _ARRAYS},
        "orders": np.array(str(system.orders)),
        "mean": np.array(system.mean),
    }


def _unpack(geometry: Geometry, arrays: dict[str, np.ndarray]) -> ContactSystem:
    return ContactSystem(
        geometry,
        Orders.parse(str(arrays["orders"])),
        mean=int(arrays["mean"]),
        **{name: arrays[name] for name in _ARRAYS},
    )
