"""A stack and a sample as a chain of lumps: nodes at the ends of intervals, so that interfaces are nodes.

Every interval's heat capacity goes half to each of its ends, which is of second order in its length. N: nodes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..matter import Layer
from .design import Backing, HeatedStack, Place

_INTERVALS = 8  # of a layer
_GRADED = 24  # intervals of a half-space
_GROWTH = 1.25  # of one to the next
_FIRST = 0.05  # s^0.5, depth of the first over the root of the diffusivity


@dataclass(frozen=True, slots=True)
class Sample:
    """What is touched. conductivity: W/(m K). heat_capacity: J/(m3 K). thickness: m, its back adiabatic; inf for a
    half-space."""

    conductivity: float
    heat_capacity: float
    thickness: float = np.inf

    @property
    def effusivity(self) -> float:
        """W s^0.5/(m2 K)."""
        return float(np.sqrt(self.conductivity * self.heat_capacity))


@dataclass(frozen=True, slots=True)
class Chain:
    """A stack as a chain of heat capacities and conductances, per area. capacity: (N,) J/(m2 K). links: (N - 1,) W/(m2
    K) between neighbours. readout, heater: nodes. loss: W/(m2 K) to the surroundings, at node `back`."""

    capacity: np.ndarray
    links: np.ndarray
    readout: int
    heater: int
    back: int
    loss: float

    @property
    def face(self) -> int:
        """The last node of the stack alone."""
        return len(self.capacity) - 1

    def modes(self, area: float, beside: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of the chain over area m2, with `beside` J/K more at its face: rates (N,) 1/s, eigenvectors (N, N) of its
        conductances between unit capacities, and (N,) the root of 1/capacity, (K/J)^0.5. Surroundings are at 0."""
        capacity = self.capacity * area
        capacity[-1] += beside
        matrix = np.zeros((len(capacity), len(capacity)))
        for i, link in enumerate(self.links * area):
            matrix[i : i + 2, i : i + 2] += link * np.array([[1.0, -1.0], [-1.0, 1.0]])
        matrix[self.back, self.back] += self.loss * area
        root = 1 / np.sqrt(capacity)
        rates, turn = np.linalg.eigh(matrix * np.outer(root, root))
        return np.maximum(rates, 0.0), turn, root


def stack_chain(stack: HeatedStack, intervals: int = _INTERVALS) -> Chain:
    """The stack alone, from the depth of its backing to its face. intervals: of each layer's pieces between places."""
    places = (stack.readout, stack.heater)
    chain, nodes = layers_chain(stack.layers, stack.backing, places, intervals)
    return replace(chain, readout=nodes[stack.readout], heater=nodes[stack.heater])


def layers_chain(
    layers: Sequence[Layer], backing: Backing, places: Sequence[Place], intervals: int = _INTERVALS
) -> tuple[Chain, dict[Place, int]]:
    """(chain, node of each place and of each interface) of layers before a backing; none for the backing alone. The
    chain is read and heated at its face."""
    widths, conductivities, heats, nodes = [], [], [], {}
    if backing.effusivity:
        depth = _graded(np.inf)[::-1]
        widths += list(depth)
        conductivities += [backing.effusivity] * len(depth)
        heats += [backing.effusivity] * len(depth)
    back = len(widths)
    for index, layer in enumerate(layers):
        cuts = sorted({0.0, 1.0, *(p.depth for p in places if p.layer == index)})
        for low, high in zip(cuts, cuts[1:], strict=False):
            nodes[Place(index, low)] = len(widths)
            widths += [(high - low) * layer.thickness / intervals] * intervals
            conductivities += [layer.conductivity] * intervals
            heats += [layer.volumetric_heat_capacity] * intervals
            nodes[Place(index, high)] = len(widths)
    capacity = _at_ends(np.array(widths) * heats)
    capacity[back] += backing.capacity
    face = len(capacity) - 1
    links = np.array(conductivities) / np.array(widths)
    return Chain(capacity, links, face, face, back, backing.loss), nodes


def sample_chain(sample: Sample) -> tuple[np.ndarray, np.ndarray]:
    """(capacity, links) of a sample from its surface on, always of as many nodes."""
    root = np.sqrt(sample.conductivity / sample.heat_capacity)
    widths = root * _graded(sample.thickness / root)
    return _at_ends(widths * sample.heat_capacity), sample.conductivity / widths


def _graded(depth: float) -> np.ndarray:
    """Intervals in s^0.5, near ones first, that end at `depth` where that is nearer than the last of them."""
    widths = _FIRST * _GROWTH ** np.arange(_GRADED)
    return widths * min(1.0, depth / widths.sum())


def _at_ends(heat: np.ndarray) -> np.ndarray:
    return (np.append(heat, 0.0) + np.append(0.0, heat)) / 2
