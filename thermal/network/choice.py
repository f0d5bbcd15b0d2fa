"""The smallest network that keeps a tolerance: candidates in order of cost, each measured against the full one.

Each candidate is compared with the network of full order (itself within .0015 K of the semi-analytic solution) in the
temperature drop after a touch, at the conductances and times that matter; both are evaluated exactly.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from thermograsp.errors import InvalidValueError

from ..padded import RING_PORTS
from ..plates import Geometry
from .states import (
    Orders,
    StateBasis,
    reduce,
    state_bases,
)
from .system import (
    MOST_MODES,
    ContactSystem,
    GeometrySamples,
    assemble,
)

FIRST = 0.05  # s after a touch from which on a tolerance is kept
FLOOR = 1.5e-3  # K, error of the full network per 12 K of initial difference
_CUTS = np.geomspace(0.3, 1e-8, 40)  # weight below which states are left out


@dataclass(frozen=True, slots=True)
class Demand:
    """What a network is to be good for. tolerance: K of temperature drop from FIRST s on. difference: K between sensor
    and object at the touch. conductances: W/(m2 K) that occur. horizon: s of contact. opposite: W/(m2 K) of the second
    fingertip while the first touches, None where it is the first's. beside: W/(m2 K) of the pads around the faces that
    touch, None where it is the faces'."""

    tolerance: float
    difference: float
    conductances: tuple[float, ...] = (1e2, 1e3, 1e4, 1e5)
    horizon: float = 20.0
    opposite: float | None = None
    beside: float | None = None


@dataclass(frozen=True, slots=True)
class Choice:
    """A network that keeps a demand. system: the network. error: K, bound found for the demand it was chosen for."""

    system: ContactSystem
    error: float


def least_error(demand: Demand) -> float:
    """K, of the full network."""
    return FLOOR * max(abs(demand.difference) / 12, 1e-3)


class UnkeptToleranceError(InvalidValueError):
    """No network keeps a tolerance of `asked` K. kept: K of one that is kept."""

    def __init__(self, asked: float, kept: float) -> None:
        self.asked, self.kept = asked, kept
        super().__init__(
            f"no network keeps {asked:g} K for this contact: give a tolerance of {1.05 * kept:.2g} K or more"
        )

    def __reduce__(self) -> tuple[type[UnkeptToleranceError], tuple[float, float]]:
        """Between processes it goes by its numbers, not by its message."""
        return type(self), (self.asked, self.kept)


def choose(samples: GeometrySamples, demand: Demand) -> Choice:
    """The cheapest system that meets the demand. Raises UnkeptToleranceError where none does."""
    floor = least_error(demand)
    full = {modes: samples.networks(modes) for modes in range(1, MOST_MODES + 1)}
    bases = {modes: state_bases(networks, samples.geometry.area) for modes, networks in full.items()}
    geometry = samples.geometry
    reference = responses(assemble(geometry, full[MOST_MODES]), demand)
    order = list(range(len(reference)))
    cases = _cases(geometry.fingertips, demand)
    system = None
    for orders in candidates(bases):
        networks = reduce(full[orders.modes], bases[orders.modes], orders)
        system = assemble(geometry, networks)
        error = 0.0
        for case in order:
            difference = np.abs(
                _response(system.rates, system.ports, system.drop[0], geometry, demand, *cases[case])
                - reference[case]
            )
            error = max(error, float(np.max(difference)))
            if error + floor > demand.tolerance:
                # what this candidate fails on, the next one is asked first
                order.remove(case)
                order.insert(0, case)
                break
        else:
            return Choice(system, error + floor)
    assert system is not None
    left_over = float(np.max(np.abs(responses(system, demand) - reference)))
    raise UnkeptToleranceError(demand.tolerance, left_over + floor)


def candidates(bases: dict[int, dict[str, StateBasis]]) -> list[Orders]:
    """Orders worth trying, cheapest first. bases: of the bodies, by the number of patch modes."""
    found, cuts = set(), np.repeat(_CUTS, 2)
    finer = np.where(np.arange(len(cuts)) % 2, cuts / 8, cuts)  # of the sensor, for every other one
    for modes, bodies in bases.items():
        counts = {
            name: np.maximum(
                np.sum(basis.weights > (finer if name == "sensor" else cuts)[:, None], axis=1),
                basis.still + 1,
            ).tolist()
            for name, basis in bodies.items()
        }
        none = [None] * len(cuts)
        found |= {
            Orders(modes, sensor or 0, even, odd)
            for sensor, even, odd in zip(
                counts.get("sensor", none), counts["even"], counts.get("odd", none), strict=True
            )
        }
    return sorted(found, key=lambda orders: (orders.multiply_adds, str(orders)))


def responses(system: ContactSystem, demand: Demand) -> np.ndarray:
    """Temperature drops (cases, times) K of the first fingertip at every conductance: it alone touches, and all
    touch."""
    return drops(system.rates, system.ports, system.drop[0], system.geometry, demand)


def drops(
    rates: np.ndarray, ports: np.ndarray, row: np.ndarray, geometry: Geometry, demand: Demand
) -> np.ndarray:
    """The same of a system's rates (K,) 1/s, ports (K, M) sqrt(K/J) and row (K,) of the first fingertip's drop."""
    cases = _cases(geometry.fingertips, demand)
    return np.array([_response(rates, ports, row, geometry, demand, *case) for case in cases])


def port_weights(geometry: Geometry, modes: int, face: float, beside: float | None) -> np.ndarray:
    """(modes,) W/K of the ports of one contact. face, beside: W/(m2 K), see Demand; a fingertip whose face is apart is
    apart with its pad."""
    if geometry.surround is None:
        return np.full(modes, face * geometry.area)
    weights = np.full(modes, face * geometry.stack.face_area)
    around = max(geometry.area - geometry.stack.face_area, 0.0)
    weights[RING_PORTS] = (face if beside is None or face == 0 else beside) * around
    return weights


def even_ports(geometry: Geometry, modes: int) -> np.ndarray:
    """(modes,) 1 at the ports of one contact that a difference of temperature drives, whose flows are all heat."""
    even = np.eye(modes)[0]
    if geometry.surround is not None:
        even[: RING_PORTS.start + 1] = 1.0
    return even


def _cases(fingertips: int, demand: Demand) -> list[tuple[float, float]]:
    """(conductance of the first fingertip, of the second)."""
    alone = [(conductance, 0.0) for conductance in demand.conductances]
    if fingertips == 1:
        return alone
    both = [(c, c if demand.opposite is None else demand.opposite) for c in demand.conductances]
    return [case for pair in zip(alone, both, strict=True) for case in pair]


@lru_cache(maxsize=64)
def _times(horizon: float) -> np.ndarray:
    times = np.geomspace(FIRST, max(horizon, 2 * FIRST), 40)
    times.setflags(write=False)
    return times


def _response(
    rates: np.ndarray,
    ports: np.ndarray,
    row: np.ndarray,
    geometry: Geometry,
    demand: Demand,
    first: float,
    second: float,
) -> np.ndarray:
    times = _times(demand.horizon)
    modes = ports.shape[1] // geometry.fingertips
    weights = np.zeros(ports.shape[1])
    drive = np.zeros_like(weights)
    for tip, conductance in enumerate((first, second)[: geometry.fingertips]):
        of_tip = slice(tip * modes, (tip + 1) * modes)
        weights[of_tip] = port_weights(geometry, modes, conductance, demand.beside)
        drive[of_tip] = demand.difference * even_ports(geometry, modes)
    scaled = ports * np.sqrt(weights)
    decay, vectors = np.linalg.eigh(np.diag(rates) + scaled @ scaled.T)
    source = vectors.T @ (ports @ (weights * drive))
    product = np.outer(times, np.maximum(decay, 0.0))
    grown = times[:, None] * np.where(product > 1e-12, -np.expm1(-product) / np.maximum(product, 1e-300), 1.0)
    return grown @ (source * (vectors.T @ row))
