"""The two sides of a contact as networks of full order, for objects of any conductivity and heat capacity.

In T mode the object is a body of its own whose impedance is Z(s) = f(s/alpha)/k, f fixed by the geometry: rates scale
with alpha and ports with (rho c)^-0.5, exactly. So one network per band of diffusivity serves all materials. In O mode
the element is bonded to the object: every material is sampled, the element once.

S: samples of s, P: patterns of the patch.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..matter import Material
from ..network import MOST_MODES, SHIFTS, sample_geometry
from ..numerics import ThermalNetwork
from ..plates import ElementSamples, Geometry, sample_element

_BAND = 4.0  # ratio of the diffusivities between which one network is scaled
_CAPACITY = 2e6  # J/(m3 K), of a band's own material


@dataclass(frozen=True, slots=True)
class Bodies:
    """The networks of one contact. material: of the object. sensor: None in O mode, where the object's side has it."""

    material: Material
    sensor: ThermalNetwork | None
    object: ThermalNetwork


class Sides:
    """The sides of one contact at s (S,) 1/s, its object of any material in place of the geometry's."""

    def __init__(self, geometry: Geometry, s: np.ndarray) -> None:
        self._geometry, self._s = geometry, s
        self._element: ElementSamples | None = None
        self._by_band: dict[int, tuple[Bodies, np.ndarray, np.ndarray]] = {}

    def impedance(self, material: Material) -> tuple[np.ndarray, np.ndarray | None]:
        """(S, P, P) K/W of both sides together, and in O mode (S, P) K/W, the drop per heat flow in each pattern."""
        if self._geometry.mode == "O":
            return self._bonded(material)
        band = round(np.log(material.diffusivity) / np.log(_BAND))
        if band not in self._by_band:
            reference = Material("reference", _BAND**band * _CAPACITY, _CAPACITY, 1.0)
            bodies = self._bodies(reference)
            assert bodies.sensor is not None
            ports = bodies.object.ports
            products = (ports[:, :, None] * ports[:, None]).reshape(len(ports), -1)
            self._by_band[band] = bodies, bodies.sensor.impedance(self._s), products
        bodies, sensor, products = self._by_band[band]
        faster = material.diffusivity / bodies.material.diffusivity
        weights = (
            _CAPACITY / material.volumetric_heat_capacity / (self._s[:, None] + faster * bodies.object.rates)
        )
        return sensor + (weights @ products).reshape(sensor.shape), None

    def _bonded(self, material: Material) -> tuple[np.ndarray, np.ndarray]:
        if self._element is None:
            self._element = sample_element(self._geometry, SHIFTS)
        network = self._bodies(material).object
        weights = 1 / (self._s[:, None] + network.rates)
        return network.impedance(self._s), (weights * network.outputs["drop"]) @ network.ports

    def _bodies(self, material: Material) -> Bodies:
        samples = sample_geometry(replace(self._geometry, material=material), self._element)
        networks = samples.networks(MOST_MODES)
        return Bodies(material, networks.get("sensor"), networks["even"])
