"""Both fingertips, the object and the two contacts between them as one diagonal system with contact ports.

P: modes of one contact, M = 2 P: ports, left contact first. K: states.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermograsp.errors import InvalidValueError

from ..numerics import Sampled, ThermalNetwork, interpolate
from ..plates import (
    BodySamples,
    ElementSamples,
    Geometry,
    sample_bodies,
)
from .modes import patch_modes
from .states import Orders, reduce, state_bases

SHIFTS = np.geomspace(1 / 400, 4000, 18)  # 1/s: moments from under a millisecond to minutes
MOST_MODES = 6
NODE = 100.0
"""J/K of the node that stands for what fills an object: in 20 ms 10 W change it by 2 mK. The larger it is, the more of
its heat is lost to rounding."""


@dataclass(frozen=True, slots=True)
class ContactSystem:
    """Fingertips and an object as one system of decaying states, joined by contacts. rates: (K,) 1/s. ports: (K, M)
    sqrt(K/J): heat flow from sensor to object in, temperature of the object less the sensor's out, above what each
    started from. Rows on the state: drop (F, K) K, element_heat (F, K) J, object_heat (K,) J, sensor_surface and
    object_surface (F, K) K above the start. mean: index of the state that holds the object's mean temperature (in O
    mode with the elements'). F = 1 or 2 fingertips. air_loss: (K,) W, where the rates include the air's; reservoir:
    (K,) J above the start of a node that the object's walls feed, see FilledBody."""

    geometry: Geometry
    orders: Orders
    rates: np.ndarray
    ports: np.ndarray
    drop: np.ndarray
    element_heat: np.ndarray
    object_heat: np.ndarray
    sensor_surface: np.ndarray
    object_surface: np.ndarray
    mean: int
    air_loss: np.ndarray | None = None
    reservoir: np.ndarray | None = None

    @property
    def modes(self) -> int:
        """Ports of one contact."""
        return self.orders.modes


@dataclass(frozen=True, slots=True)
class GeometrySamples:
    """A geometry's bodies sampled at SHIFTS and projected on MOST_MODES nested patch modes: K/W per port in W."""

    geometry: Geometry
    bodies: dict[str, BodySamples]

    def network(self, name: str, modes: int) -> ThermalNetwork:
        """A body's network of full order with that many patch modes."""
        body = self.bodies[name]
        samples = Sampled(body.impedance.value[:, :modes, :modes], body.impedance.slope[:, :modes, :modes])
        outputs = {key: row[:, :modes] for key, row in body.outputs.items()}
        rates, ports, rows = interpolate(SHIFTS, samples, outputs)
        if np.isfinite(body.capacity):
            # the body's uniform temperature, taken out of the samples, as a state of its own
            kelvin = 1 / np.sqrt(body.capacity)
            rates = np.append(0.0, rates)
            ports = np.vstack((kelvin * np.eye(modes)[0], ports))
            rows = {key: np.append(kelvin * body.uniform_outputs[key], row) for key, row in rows.items()}
        return ThermalNetwork(np.maximum(rates, 0.0), ports, outputs=rows)

    def networks(self, modes: int) -> dict[str, ThermalNetwork]:
        """All bodies' networks of full order."""
        return {name: self.network(name, modes) for name in self.bodies}


def sample_geometry(geometry: Geometry, element: ElementSamples | None = None) -> GeometrySamples:
    """Samples a geometry's bodies and learns its patch modes. element: in O mode, of sample_element at SHIFTS, where it
    is there already."""
    bodies = sample_bodies(geometry, SHIFTS, element)
    basis = patch_modes(geometry, bodies, SHIFTS, MOST_MODES)
    area = geometry.patch.area
    projected = {}
    for name, body in bodies.items():
        impedance = Sampled(
            np.einsum("cp,scd,dq->spq", basis, body.impedance.value, basis, optimize=True) / area,
            np.einsum("cp,scd,dq->spq", basis, body.impedance.slope, basis, optimize=True) / area,
        )
        outputs = {key: row @ basis for key, row in body.outputs.items()}
        projected[name] = BodySamples(impedance, body.capacity, outputs, body.uniform_outputs)
    return GeometrySamples(geometry, projected)


def assemble(geometry: Geometry, networks: dict[str, ThermalNetwork]) -> ContactSystem:
    """Joins the bodies' networks, each with the same modes, into the system of all contacts."""
    even, odd = networks["even"], networks.get("odd")
    modes = even.ports.shape[1]
    # T_left = (T_even + T_odd) / sqrt 2, T_right = (T_even - T_odd) / sqrt 2, and the same for heat flows and outputs
    parts = [even] if odd is None else [even, odd]
    signs = np.array([[1.0]]) if odd is None else np.array([[1.0, 1.0], [1.0, -1.0]]) * np.sqrt(0.5)

    def per_fingertip(values: list[np.ndarray]) -> np.ndarray:
        return np.stack(
            [np.concatenate([sign * v for sign, v in zip(row, values, strict=True)]) for row in signs]
        )

    touched = per_fingertip([part.ports for part in parts])  # (F, K, P)
    fingertips, count = len(touched), touched.shape[1]
    rates = np.concatenate([part.rates for part in parts])
    heat = np.zeros(count)
    heat[: even.order] = even.outputs["object"] * np.sqrt(fingertips)
    mean = int(np.argmin(rates))
    if geometry.mode == "O":
        return ContactSystem(
            geometry,
            Orders(modes, 0, even.order, None if odd is None else odd.order),
            rates,
            np.hstack(list(touched)),
            drop=per_fingertip([part.outputs["drop"] for part in parts]),
            element_heat=per_fingertip([part.outputs["element"] for part in parts]),
            object_heat=heat,
            sensor_surface=np.zeros((fingertips, count)),
            object_surface=touched[:, :, 0],
            mean=mean,
        )

    return with_sensors(
        geometry, networks["sensor"], rates, touched, heat, (even.order, None if odd is None else odd.order)
    )


def with_sensors(
    geometry: Geometry,
    sensor: ThermalNetwork,
    rates: np.ndarray,
    touched: np.ndarray,
    heat: np.ndarray,
    orders: tuple[int, int | None],
) -> ContactSystem:
    """An object between fingertips of mode T. sensor: the network of one fingertip. rates: (K,) 1/s of the object and
    touched: (F, K, P) its ports at each fingertip. heat: (K,) J. orders: of its even and odd part (None: one body)."""
    (fingertips, count, modes), k = touched.shape, sensor.order
    total = count + fingertips * k
    of_tip = [slice(count + f * k, count + (f + 1) * k) for f in range(fingertips)]
    ports = np.zeros((total, fingertips * modes))
    ports[:count] = np.hstack(list(touched))
    for f in range(fingertips):
        ports[of_tip[f], f * modes : (f + 1) * modes] = -sensor.ports

    def on_sensors(row: np.ndarray) -> np.ndarray:
        placed = np.zeros((fingertips, total))
        for f in range(fingertips):
            placed[f, of_tip[f]] = row
        return placed

    def on_object(rows: np.ndarray) -> np.ndarray:
        return np.concatenate((rows, np.zeros((*rows.shape[:-1], total - count))), axis=-1)

    return ContactSystem(
        geometry,
        Orders(modes, k, *orders),
        np.concatenate((rates, np.tile(sensor.rates, fingertips))),
        ports,
        drop=on_sensors(sensor.outputs["drop"]),
        element_heat=on_sensors(sensor.outputs["element"]),
        object_heat=on_object(heat),
        sensor_surface=on_sensors(sensor.ports[:, 0]),
        object_surface=on_object(touched[:, :, 0]),
        mean=int(np.argmin(rates)),
    )


def contact_system(samples: GeometrySamples, orders: Orders) -> ContactSystem:
    """The system of those orders. Raises InvalidValueError where an order is larger than its body's samples fill, or
    does not belong to the geometry's fingertips."""
    geometry = samples.geometry
    if not 1 <= orders.modes <= MOST_MODES:
        raise InvalidValueError(f"modes must be 1 .. {MOST_MODES}, got {orders.modes}")
    if orders.fingertips != geometry.fingertips or (orders.sensor == 0) != (geometry.mode == "O"):
        raise InvalidValueError(
            f"orders {orders} do not fit {geometry.fingertips} fingertip(s) in mode {geometry.mode}: give "
            "modes/sensor/object for one, modes/sensor/even/odd for two, sensor 0 in O mode and only there"
        )
    full = samples.networks(orders.modes)
    bases = state_bases(full, geometry.area)
    return assemble(geometry, reduce(full, bases, orders))
