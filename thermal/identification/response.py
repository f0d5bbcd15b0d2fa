"""Curves per kelvin: the temperature drop after a touch at constant conductance, as the amplifier passes it on.

K: states, n: times.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import eigh

from ..matter import Material
from ..network import (
    SHIFTS,
    ContactSystem,
    Orders,
    assemble,
    reduce,
    sample_geometry,
    state_bases,
)
from ..plates import ElementSamples, Geometry, sample_element
from ..stack import ConstantPower, HeatedCore, Held

_MODES = 6  # of the patch
_CUT = (
    3e-5  # weight below which states are left out; within .0006 K of 12 K of the 3-D semi-analytic solution
)
_BAND = 4.0  # ratio of the diffusivities between which one network is scaled


def fine_system(geometry: Geometry, element: ElementSamples | None = None) -> ContactSystem:
    """The contact's network, with all states that show. element: as in sample_geometry."""
    samples = sample_geometry(geometry, element)
    full = samples.networks(_MODES)
    bases = state_bases(full, geometry.area)
    kept = {name: int(np.sum(basis.weights > _CUT)) for name, basis in bases.items()}
    orders = Orders(_MODES, kept.get("sensor", 0), kept["even"], kept.get("odd"))
    return assemble(geometry, reduce(full, bases, orders))


@dataclass(slots=True)
class SystemFamily:
    """Networks of one contact with objects of any conductivity and heat capacity.

    In T mode the object is a body of its own whose impedance is Z(s) = f(s/alpha)/k, f fixed by the geometry: rates
    scale with alpha and ports with (rho c)^-0.5, exactly. So one network per band of diffusivity serves all materials.
    In O mode the element is bonded to the object: every material is sampled, the element once.
    """

    geometry: Geometry
    _by_band: dict[int, ContactSystem]
    _element: ElementSamples | None

    def __init__(self, geometry: Geometry) -> None:
        self.geometry = geometry
        self._by_band = {}
        self._element = sample_element(geometry, SHIFTS) if geometry.mode == "O" else None

    def system(self, conductivity: float, heat_capacity: float) -> ContactSystem:
        """conductivity: W/(m K). heat_capacity: J/(m3 K)."""
        material = Material("object", conductivity, heat_capacity, 1.0)
        geometry = replace(self.geometry, material=material)
        if geometry.mode == "O":
            return fine_system(geometry, self._element)
        band = round(np.log(material.diffusivity) / np.log(_BAND))
        if band not in self._by_band:
            reference = Material("reference", _BAND**band * 2e6, 2e6, 1.0)
            self._by_band[band] = fine_system(replace(geometry, material=reference))
        reference_system = self._by_band[band]
        rates, ports = reference_system.rates.copy(), reference_system.ports.copy()
        rates[: reference_system.orders.even] *= material.diffusivity / _BAND**band
        ports[: reference_system.orders.even] *= np.sqrt(2e6 / heat_capacity)
        return replace(reference_system, geometry=geometry, rates=rates, ports=ports)


@dataclass(frozen=True, slots=True)
class Answer:
    """What a sensor reads of a contact, by modes that a conductance couples. rates: (K,) 1/s. ports: (K, P) sqrt(K/J).
    row: (K,) K of what is read. without: (K,) W per K of difference, that acts whether it conducts or not."""

    rates: np.ndarray
    ports: np.ndarray
    row: np.ndarray
    without: np.ndarray
    area: float

    def curve(self, conductance: float, t: np.ndarray, bandwidth: float = np.inf) -> np.ndarray:
        """See unit_response."""
        weight = conductance * self.area
        rates, turn = np.linalg.eigh(np.diag(self.rates) + weight * self.ports @ self.ports.T)
        share = (self.row @ turn) * (turn.T @ (weight * self.ports[:, 0] + self.without))
        rates = np.maximum(rates, 1e-12)
        time = np.maximum(t, 0.0)
        decayed = np.expm1(-rates * time[:, None])  # what takes long; each mode's exponential less 1
        if not np.isfinite(bandwidth):
            return decayed @ (-share / rates)
        corner = 2 * np.pi * bandwidth
        gap = corner - rates
        late = share / np.where(np.abs(gap) < 1e-6 * corner, 1e-6 * corner, gap)
        return decayed @ (-share / rates - late) + np.expm1(-corner * time) * late.sum()


def answer(system: ContactSystem, core: HeatedCore | None = None) -> Answer:
    """The temperature drop of a network on an ideal thermostat; on a core, the fall of the reading."""
    ports, area = system.ports[:, : system.modes], system.geometry.area
    if core is None or isinstance(core.sensor.law, Held):
        return Answer(system.rates, ports, system.drop[0], np.zeros(len(system.rates)), area)
    return _with_core(system, core)


def unit_response(
    system: ContactSystem,
    conductance: float,
    t: np.ndarray,
    bandwidth: float = np.inf,
    core: HeatedCore | None = None,
) -> np.ndarray:
    """K of drop per K between sensor and object at t (n,) s after a touch, behind a first-order low-pass of `bandwidth`
    Hz; with a core in place of an ideal thermostat, K of the reading's fall. conductance: W/(m2 K). Exact for the
    network: a sum of exponentials; 0 before the touch."""
    return answer(system, core).curve(conductance, t, bandwidth)


def _with_core(system: ContactSystem, core: HeatedCore) -> Answer:
    """The modes of network and core together, K + N.

    The network's states hold temperatures above the heater's place, whose own temperature is a state of the core. With
    w the heat of the network's states, C its element's and D the core's capacity, heat is balanced where
    x' + w v' = -rates x + B q and w x' + (C + D) v' = -q + what the rest of the core sends: a symmetric pencil."""
    area, k, n = core.element.face_area, len(system.rates), len(core.chain.capacity)
    mass, stiff = np.eye(k + n), np.zeros((k + n, k + n))
    heater, back = k + n - 1, k + core.chain.back
    mass[range(k, k + n), range(k, k + n)] = core.chain.capacity * area
    mass[heater, heater] += system.geometry.element_capacity
    mass[heater, :k] = mass[:k, heater] = system.element_heat[0]
    stiff[range(k), range(k)] = system.rates
    for i, link in enumerate(core.chain.links * area, k):
        stiff[i : i + 2, i : i + 2] += link * np.array([[1.0, -1.0], [-1.0, 1.0]])
    stiff[back, back] += core.chain.loss * area
    ports, row, without = np.zeros((k + n, system.modes)), np.zeros(k + n), np.zeros(k + n)
    ports[:k] = system.ports[:, : system.modes]
    ports[heater, 0] = -1.0
    if not isinstance(core.sensor.law, ConstantPower):
        without[heater] = -core.leak  # the power that kept it warm in air as cold as the object is gone
    row[heater if core.readout is None else k + core.readout] = -1.0
    if core.readout is None:
        row[:k] = system.drop[0]
    rates, turn = eigh(stiff, mass)
    return Answer(np.maximum(rates, 0.0), turn.T @ ports, row @ turn, turn.T @ without, system.geometry.area)
