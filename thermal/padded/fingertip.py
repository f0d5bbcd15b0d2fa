"""A fingertip's element in its pad of silicone, seen through the pad's front: impedance between patterns of flow.

What the element is without a pad is known exactly (kernels), and so is the pad cut apart from it, under an even flow.
What the bond between them changes comes from concentric squares (squares.py).

S: moments, P: patterns of the element's face (kernels), Q = P + 1: with the even flow over all of the front that
touches.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ..kernels import ALONG, GRAM, MOMENTS, element, element_samples
from ..matter import Layer, SensorStack, Surround
from ..plates import stack_impedance, stack_profile
from .squares import PORTS, bonded

_TINY = 1e-30


@dataclass(frozen=True, slots=True, eq=False)
class PaddedSamples:
    """impedance: (S, Q, Q) K/W between flows of 1 W in each pattern of the element's face, and evenly into all that
    touches; slope: its derivative by the moment. drop: (S, Q) K/W over the sensed layer. heat: (S, Q) J/W in element
    and pad. face, front: m2 of the element's face and of all that touches."""

    impedance: np.ndarray
    slope: np.ndarray
    drop: np.ndarray
    heat: np.ndarray
    face: float
    front: float

    def orthonormal(self, face_basis: np.ndarray) -> np.ndarray:
        """(Q, M + 1) of combinations that are orthonormal over the front, the even one first, from those of the face
        (P, M), the even one first: a conductance per area is the same number for all of them."""
        kept, share = face_basis.shape[1], self.face / self.front
        basis = np.zeros((len(face_basis) + 1, kept + 1))
        basis[-1, 0] = 1.0
        if share < 1:
            basis[:-1, 1] = face_basis[:, 0]
            basis[-1, 1] = -1.0
            basis[:, 1] /= np.sqrt(1 / share - 1)
        basis[:-1, 2:] = face_basis[:, 1:] * np.sqrt(share)
        return basis


def _means() -> np.ndarray:
    """(PORTS, P + 1): the flows of squares.py that stand for the face's patterns and the even flow beside the face."""
    matrix = np.zeros((PORTS, len(GRAM) + 1))
    matrix[0, 0] = matrix[-1, -1] = 1.0
    for pattern, (first, second) in enumerate(ALONG):
        function = max(first, second)
        if function:
            matrix[1 + (function - 1) // 2, pattern] = 1.0
    return matrix


_STAND_FOR = _means()


@lru_cache(maxsize=64)
def padded_samples(stack: SensorStack, surround: Surround, front: float) -> PaddedSamples:
    """stack: the element with its skin, if it wears one. surround: with its depth. front: m2 of the pad's front that
    touches, the element's whole face in it; what touches beside the face is taken as a square around it."""
    face, count = stack.face_area, len(GRAM)
    change = bonded(stack, surround, float(np.sqrt(front)))
    width, known = stack.width, element(stack)
    alone = element_samples(stack, ((0.0, width), (0.0, width)))
    shape = len(MOMENTS), count + 1
    impedance, slope = np.zeros((*shape, count + 1)), np.zeros((*shape, count + 1))
    drop, heat = np.zeros(shape), np.zeros(shape)
    impedance[:, :count, :count], slope[:, :count, :count] = alone.value, alone.slope
    slow = 1 / (MOMENTS[:, None] + known.rates)
    for row, of_states, rest in (
        (drop, known.drop, known.drop_rest),
        (heat, known.heat, known.heat_rest),
    ):
        row[:, :count] = np.outer(slow @ (of_states * known.ports) + rest, GRAM[0])
    layers, beside = _beside(stack, surround), front - face
    if beside > 0:
        turned = (MOMENTS * (1 + 1j * _TINY))[:, None]
        through = stack_impedance(layers, "isothermal", turned, np.zeros(1))[:, 0] / beside
        impedance[:, -1, -1], slope[:, -1, -1] = through.real, through.imag / (MOMENTS * _TINY)
        _, flows = stack_profile(layers, "isothermal", MOMENTS[:, None], np.zeros(1))
        heat[:, -1] = (flows[0] - flows[-1])[:, 0] / MOMENTS
    impedance += _STAND_FOR.T @ change.impedance @ _STAND_FOR
    slope += _STAND_FOR.T @ change.slope @ _STAND_FOR
    drop, heat = drop + change.drop @ _STAND_FOR, heat + change.heat @ _STAND_FOR
    # the even flow over the whole front in place of that beside the face
    turn = np.eye(count + 1)
    turn[0, -1], turn[-1, -1] = face / front, beside / front
    found = turn.T @ impedance @ turn, turn.T @ slope @ turn, drop @ turn, heat @ turn
    for each in found:
        each.setflags(write=False)
    return PaddedSamples(*found, face, front)


def _beside(stack: SensorStack, surround: Surround) -> tuple[Layer, ...]:
    """The layers beside the element, from the front: those of it that lie over the pad too, and the pad."""
    over, left = [], stack.thickness - surround.layer.thickness
    for layer in reversed(stack.layers):
        if left <= 1e-9 * stack.thickness:
            break
        over.append(replace(layer, thickness=min(layer.thickness, left)))
        left -= layer.thickness
    return (*over, surround.layer)
