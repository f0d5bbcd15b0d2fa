"""Curves per kelvin: the temperature drop after a touch at constant conductance, as the amplifier passes it on.

K: states, n: times.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .bodies import ElementSamples, Geometry, sample_element
from .materials import Material
from .states import Orders, reduce, state_bases
from .system import SHIFTS, ContactSystem, assemble, sample_geometry

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
    _known: dict[int, ContactSystem]
    _element: ElementSamples | None

    def __init__(self, geometry: Geometry) -> None:
        self.geometry = geometry
        self._known = {}
        self._element = sample_element(geometry, SHIFTS) if geometry.mode == "O" else None

    def system(self, conductivity: float, heat_capacity: float) -> ContactSystem:
        """conductivity: W/(m K). heat_capacity: J/(m3 K)."""
        material = Material("object", conductivity, heat_capacity, 1.0)
        geometry = replace(self.geometry, material=material)
        if geometry.mode == "O":
            return fine_system(geometry, self._element)
        band = round(np.log(material.diffusivity) / np.log(_BAND))
        if band not in self._known:
            reference = Material("reference", _BAND**band * 2e6, 2e6, 1.0)
            self._known[band] = fine_system(replace(geometry, material=reference))
        known = self._known[band]
        rates, ports = known.rates.copy(), known.ports.copy()
        rates[: known.orders.even] *= material.diffusivity / _BAND**band
        ports[: known.orders.even] *= np.sqrt(2e6 / heat_capacity)
        return replace(known, geometry=geometry, rates=rates, ports=ports)


def unit_response(
    system: ContactSystem, conductance: float, t: np.ndarray, bandwidth: float = np.inf
) -> np.ndarray:
    """K of drop per K between sensor and object at t (n,) s after a touch, behind a first-order low-pass of `bandwidth`
    Hz. conductance: W/(m2 K). Exact for the network: a sum of exponentials; 0 before the touch."""
    weight = conductance * system.geometry.area
    modes = system.modes
    rates, turn = np.linalg.eigh(
        np.diag(system.rates) + weight * system.ports[:, :modes] @ system.ports[:, :modes].T
    )
    rates = np.maximum(rates, 1e-12)
    share = (system.drop[0] @ turn) * (turn.T @ system.ports[:, 0]) * weight
    time = np.maximum(t, 0.0)[:, None]
    settling = -np.expm1(-rates * time) / rates
    if np.isfinite(bandwidth):
        corner = 2 * np.pi * bandwidth
        apart = corner - rates
        apart = np.where(np.abs(apart) < 1e-6 * corner, 1e-6 * corner, apart)
        settling = settling - (np.exp(-rates * time) - np.exp(-corner * time)) / apart
    return settling @ share
