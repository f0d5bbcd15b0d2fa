"""The impedance of a contact's two sides where it is narrower than the sensor's face.

Even flow over a rectangle meets the element by its heat kernels (thermal/kernels/element.py) and the object as a plate
without sides, on which a rectangle's kernel is a product of two strips' and the depth's. How even the flow is depends
on the contact: the better it conducts, the more of the flow crowds to the rectangle's edges and the less impedance it
meets.

J: widths, S: moments.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from scipy.optimize import brentq
from scipy.special import erf

from ..kernels import GRAM, GRASP, OF_GRASP, TIMES, TO_MOMENTS, before, element_samples
from ..matter import Material, SensorStack

CONFORMING, LAPPED = 1e5, 1e4
"""W/(m2 K) of contacts with a skin and without, roughly: the more, the less even is the flow through a narrow one."""

_EVEN_TEMPERATURE = 0.08
"""By which a square source of even temperature has less resistance than one of even flow has on the mean: .433 and .473
over k times its side (Yovanovich & Marotta, Thermal spreading and contact resistances, in Bejan & Kraus, Heat Transfer
Handbook, 2003)."""

_TOUCH_RATE = 1.0  # 1/s, of a touch of about a second
_ALIKE = 1e-3  # of a square's side
_IMAGES, _LEAST = 4, 1e-9  # of a plate's back, to round-off; of depths, below which they tell nothing


@lru_cache(maxsize=256)
def equal_square(stack: SensorStack, skinned: bool, body: Material, area: float, length: float) -> float:
    """m2 of the square contact in the middle of a sensor's face that impedes heat on both sides as a strip of that area
    m2 and length m does, a second after a touch; no larger than the face. skinned: whether the stack ends with a
    skin."""
    conducts, moment = CONFORMING if skinned else LAPPED, int(np.argmin(np.abs(np.log(GRASP / _TOUCH_RATE))))
    whole, long = stack.width, min(length, stack.width)
    if area >= stack.face_area:
        return stack.face_area

    def impedance(first: float, second: float) -> float:
        spans = tuple(((whole - side) / 2, (whole + side) / 2) for side in (first, second))
        under_contact = _under_contact(stack, conducts, *spans)
        return float(
            (
                under_contact
                + plate_impedance(body, math.inf, conducts, np.array([first, second]))[0, 0, 0, 1]
            )[moment]
        )

    strip = impedance(min(area / long, whole), long)

    def more(side: float) -> float:
        """Of a square, over the strip's, by its logarithm."""
        return float(np.log(impedance(side, side) / strip))

    least = area**0.5
    if more(least) <= 0.0:
        return area
    if more(whole) >= 0.0:
        return stack.face_area
    side = float(brentq(more, least, whole, xtol=_ALIKE * least))  # pyright: ignore[reportArgumentType]
    return side**2


def stack_impedance(stack: SensorStack, conducts: float, widths: np.ndarray) -> np.ndarray:
    """(2, 2, J, J, S) K/W at GRASP: mean temperature of contacts of these widths m along either axis of the element's
    face, in its middle or at its end, per flow through them, beside a contact that conducts so many W/(m2 K)."""
    whole, count = stack.width, len(widths)
    ends = [[((whole - p) / 2, (whole + p) / 2), (0.0, p)] for p in np.minimum(widths, whole).tolist()]
    known = np.empty((2, 2, count, count, len(range(*OF_GRASP.indices(len(TO_MOMENTS))))))
    for first, second, i, j in np.ndindex(known.shape[:-1]):
        if (first, i) <= (second, j):  # the face is square
            each = _under_contact(stack, conducts, ends[i][first], ends[j][second])
            known[first, second, i, j] = known[second, first, j, i] = each
    return known


def _under_contact(stack: SensorStack, conducts: float, *spans: tuple[float, float]) -> np.ndarray:
    """(S,) K/W at GRASP of a contact that goes from and to so many m along either axis of the element's face."""
    value = element_samples(stack, spans).value[OF_GRASP]
    # of all flows the one that loses the least power in the element and the contact
    loose = 1 / (conducts * np.prod(np.diff(spans)))
    flow = np.linalg.solve(value + loose * GRAM, GRAM[0])
    return 1 / (flow @ GRAM[0]) - loose


def plate_impedance(material: Material, thickness: float, conducts: float, widths: np.ndarray) -> np.ndarray:
    """As stack_impedance, on a plate of that thickness m whose back is insulated, inf for a half-space, or beside where
    it ends: a mirror image stands for the end. It is known of even flow; under an even temperature it ends lower."""
    capacity = material.volumetric_heat_capacity
    diffusivity = material.conductivity / capacity
    reached = np.sqrt(np.pi * diffusivity * TIMES) / _kept_by_back(thickness, diffusivity)
    shared = np.stack([_shared(factor * widths[:, None], diffusivity) for factor in (1, 2)])
    kernel = shared[:, None, :, None] * shared[None, :, None, :] / reached
    area = np.outer(widths, widths)[..., None]
    even = (kernel @ TO_MOMENTS[OF_GRASP].T + before(diffusivity)) / (capacity * area)
    back = np.tanh(thickness * np.sqrt(GRASP / diffusivity))
    deep = 1 / (material.effusivity * np.sqrt(GRASP) * back * area)  # while heat has not spread at all
    loose = material.conductivity / (conducts * np.sqrt(area))
    return even * (1 - _EVEN_TEMPERATURE / (1 + loose) * (1 - even / deep))


def _kept_by_back(thickness: float, diffusivity: float) -> np.ndarray:
    """How much hotter the face of a plate is at TIMES after a pulse than a half-space's, as its insulated back keeps
    the heat: by images, and once they are many by waves (Carslaw & Jaeger, sections 10.10 and 14.3)."""
    ends = np.arange(1, _IMAGES + 1)[:, None]
    depth = np.pi * diffusivity * TIMES / thickness**2
    soon = 1 + 2 * np.exp(-np.pi * ends**2 / np.maximum(depth, _LEAST)).sum(axis=0)
    late = np.sqrt(depth) * (1 + 2 * np.exp(-np.pi * ends**2 * depth).sum(axis=0))
    return np.where(depth < 1.0, soon, late)


def _shared(length: np.ndarray, diffusivity: float) -> np.ndarray:
    """Share of the heat on a line of that length m that is still on it at TIMES (Carslaw & Jaeger, section 10.3)."""
    u = length / (2 * np.sqrt(diffusivity * TIMES))
    return erf(u) + np.expm1(-(u**2)) / (u * np.sqrt(np.pi))
