"""A contact's network for a demand or of given orders, built once and then read from the cache."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
from threadpoolctl import threadpool_limits

from thermograsp.files import cached_arrays

from .bodies import Geometry
from .choice import Choice, Demand, choose
from .states import Orders
from .system import ContactSystem, contact_system, sample_geometry

_VERSION = 2  # of the arrays' meaning and of how they are computed
_ARRAYS = ("rates", "ports", "drop", "element_heat", "object_heat", "sensor_surface", "object_surface")


def network_for(geometry: Geometry, demand: Demand, *, cache: bool = True) -> Choice:
    """The cheapest network that keeps the demand's tolerance. Raises InvalidValueError where none does."""

    def build() -> dict[str, np.ndarray]:
        with _one_thread():
            choice = choose(sample_geometry(geometry), demand)
        return {**_pack(choice.system), "error": np.array(choice.error)}

    arrays = cached_arrays({"version": _VERSION, **_key(geometry), "demand": demand}, build, enabled=cache)
    return Choice(_unpack(geometry, arrays), float(arrays["error"]))


def network_of(geometry: Geometry, orders: Orders, *, cache: bool = True) -> ContactSystem:
    """The network of those orders. Raises InvalidValueError where they cannot be filled."""

    def build() -> dict[str, np.ndarray]:
        with _one_thread():
            return _pack(contact_system(sample_geometry(geometry), orders))

    arrays = cached_arrays(
        {"version": _VERSION, **_key(geometry), "orders": str(orders)}, build, enabled=cache
    )
    return _unpack(geometry, arrays)


def _one_thread() -> threadpool_limits:
    """Linear algebra in one thread: the products are many and small. Two threads took 40 times as long where other
    processes kept both cores busy (42 s against 1 s for three networks), and their number could decide last bits."""
    return threadpool_limits(1, user_api="blas")


def _key(geometry: Geometry) -> dict[str, object]:
    """What heat conduction knows of a geometry: names and sources of materials play no part."""
    stack = geometry.stack
    layers = [(slab.thickness, slab.conductivity, slab.heat_capacity) for slab in geometry.slabs]
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
