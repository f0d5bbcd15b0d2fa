"""A fingertip's element in its pad of silicone, seen through the pad's front: impedance between patterns of flow.

What the element is without a pad is known exactly (kernels), and so is the pad cut apart from it, under an even flow.
What the bond between them changes comes from concentric squares (squares.py).

S: moments, P: patterns of the element's face (kernels), R: rings of the front around it, M: patterns kept.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ..kernels import ALONG, GRAM, MOMENTS, element, element_samples
from ..matter import Layer, SensorStack, Surround
from ..plates import stack_impedance, stack_profile
from .squares import FACE, bonded

_TINY = 1e-30


@dataclass(frozen=True, slots=True, eq=False)
class RingedSamples:
    """impedance: (S, P + R, P + R) K/W between flows of 1 W in each pattern of the element's face, and evenly into each
    of R rings around it; slope: its derivative by the moment. drop: (S, P + R) K/W over the sensed layer. heat: (S, P +
    R) J/W in element and pad. face: m2 of the element's face, and areas: (R,) m2 of the rings."""

    impedance: np.ndarray
    slope: np.ndarray
    drop: np.ndarray
    heat: np.ndarray
    face: float
    areas: np.ndarray

    @property
    def front(self) -> float:
        """m2 of all that touches."""
        return self.face + float(self.areas.sum())

    def orthonormal(self, face_basis: np.ndarray) -> np.ndarray:
        """(P + R, M + R) of combinations that are orthonormal over the front, the even one first, then what sets face
        and rings against one another, from those of the face (P, M), the even one first: a conductance per area is the
        same number for all of them."""
        kept, count, rings = face_basis.shape[1], len(face_basis), len(self.areas)
        regions = np.sqrt(self._shares)[:, None] * _orthonormal(self._shares)
        basis = np.zeros((count + rings, kept + rings))
        basis[:count, : rings + 1] = np.outer(face_basis[:, 0], regions[0])
        basis[count:, : rings + 1] = regions[1:]
        basis[:count, rings + 1 :] = face_basis[:, 1:] * np.sqrt(self._shares[0])
        return basis

    def separated(self, ports: int) -> np.ndarray:
        """(ports, ports), what makes of orthonormal's combinations such that are orthonormal over the face alone and
        over the rings alone (RING_PORTS), so that each of the two has a conductance of its own."""
        shares, rings = self._shares, len(self.areas)
        around = shares[1:].sum()
        regions = np.eye(rings + 1) / np.sqrt(shares[0])
        if around > 0:
            regions[1:, 1:] = _orthonormal(shares[1:] / around) / np.sqrt(around)
        turn, of_regions = np.eye(ports) / np.sqrt(shares[0]), slice(rings + 1)
        turn[of_regions, of_regions] = _orthonormal(shares).T @ regions
        return turn

    @property
    def _shares(self) -> np.ndarray:
        """(1 + R,) of the front, the face's and the rings'."""
        return np.array([self.face, *self.areas]) / self.front


def _orthonormal(shares: np.ndarray) -> np.ndarray:
    """Orthonormal columns, the first of them the roots of these shares of a whole."""
    columns = np.linalg.qr(np.column_stack((np.sqrt(shares), np.eye(len(shares))[:, 1:])))[0]
    return np.sign(columns[0, 0]) * columns


def _means(rings: int) -> np.ndarray:
    """(Q, P + R): the flows of squares.py that stand for the face's patterns and the even flows into rings."""
    matrix = np.zeros((FACE + rings, len(GRAM) + rings))
    matrix[0, 0] = 1.0
    matrix[FACE:, len(GRAM) :] = np.eye(rings)
    for pattern, (first, second) in enumerate(ALONG):
        function = max(first, second)
        if function:
            matrix[1 + (function - 1) // 2, pattern] = 1.0
    return matrix


@lru_cache(maxsize=64)
def ringed_samples(stack: SensorStack, surround: Surround, rings: tuple[float, ...]) -> RingedSamples:
    """stack: the element with its skin, if it wears one. surround: with its depth. rings: m, the outer sides of the
    squares of the pad's front that touch, ascending, the element's whole face in them."""
    count, width = len(GRAM), stack.width
    change, stand_for = bonded(stack, surround, rings), _means(len(rings))
    known, alone = element(stack), element_samples(stack, ((0.0, width), (0.0, width)))
    shape = len(MOMENTS), count + len(rings)
    impedance, slope = np.zeros((*shape, shape[1])), np.zeros((*shape, shape[1]))
    drop, heat = np.zeros(shape), np.zeros(shape)
    impedance[:, :count, :count], slope[:, :count, :count] = alone.value, alone.slope
    slow = 1 / (MOMENTS[:, None] + known.rates)
    for row, of_states, rest in (
        (drop, known.drop, known.drop_rest),
        (heat, known.heat, known.heat_rest),
    ):
        row[:, :count] = np.outer(slow @ (of_states * known.ports) + rest, GRAM[0])
    layers, areas = _beside(stack, surround), np.diff((width**2, *(side**2 for side in rings)))
    value, rate = _column(layers)
    _, flows = stack_profile(layers, "isothermal", MOMENTS[:, None], np.zeros(1))
    for ring, area in enumerate(areas.tolist(), count):
        if area > 0:
            impedance[:, ring, ring] = value / area
            slope[:, ring, ring] = rate / area
            heat[:, ring] = (flows[0] - flows[-1])[:, 0] / MOMENTS
    impedance += stand_for.T @ change.impedance @ stand_for
    slope += stand_for.T @ change.slope @ stand_for
    found = RingedSamples(
        impedance, slope, drop + change.drop @ stand_for, heat + change.heat @ stand_for, width**2, areas
    )
    for each in (found.impedance, found.slope, found.drop, found.heat):
        each.setflags(write=False)
    return found


def covered_samples(
    stack: SensorStack, surround: Surround, rings: tuple[float, ...], areas: np.ndarray
) -> RingedSamples:
    """The same of rings of which only (R,) m2 touch: what the pad alone is to a ring is as much more as the part is
    smaller."""
    whole = ringed_samples(stack, surround, rings)
    value, rate = _column(_beside(stack, surround))
    impedance, slope, count = whole.impedance.copy(), whole.slope.copy(), len(GRAM)
    for ring, (area, of) in enumerate(zip(areas.tolist(), whole.areas.tolist(), strict=True), count):
        if 0 < area < of * (1 - 1e-9):
            impedance[:, ring, ring] += (1 / area - 1 / of) * value
            slope[:, ring, ring] += (1 / area - 1 / of) * rate
    return replace(whole, impedance=impedance, slope=slope, areas=areas)


def _column(layers: tuple[Layer, ...]) -> tuple[np.ndarray, np.ndarray]:
    """(S,) m2 K/W of the pad cut apart from the element under an even flow, and its derivative by the moment."""
    turned = (MOMENTS * (1 + 1j * _TINY))[:, None]
    through = stack_impedance(layers, "isothermal", turned, np.zeros(1))[:, 0]
    return np.real(through), np.imag(through) / (MOMENTS * _TINY)


def _beside(stack: SensorStack, surround: Surround) -> tuple[Layer, ...]:
    """The layers beside the element, from the front: those of it that lie over the pad too, and the pad."""
    over, left = [], stack.thickness - surround.layer.thickness
    for layer in reversed(stack.layers):
        if left <= 1e-9 * stack.thickness:
            break
        over.append(replace(layer, thickness=min(layer.thickness, left)))
        left -= layer.thickness
    return (*over, surround.layer)
