"""The few patterns of flow that a contact excites: at its place on a box, or at any that covers so much of a sensor's
face.

Those of a place follow from what lies on its two sides, at a few moments and conductances: how much of the sensor's
face is covered, which edges of it and of the box are near, the box's thickness and material. Those of any place are
found once per coverage, for four materials, sheets and edges together; they serve where a fingertip must keep its
states whatever it touches, at some three times the error (studies/networks/laplace_judge.py).

P: patterns known (patterns.py), M: kept, N: contacts.
"""

from __future__ import annotations

import math
from bisect import bisect
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..matter import SensorStack
from .box import Patches
from .element import Element, Rectangle, element
from .excited import CONDUCTANCES, Face, excited, excited_alone, shown_box, shown_element
from .patterns import EVENNESS, GRAM
from .samples import SHOWN

STEPS = 16  # places along a face's side between which a contact's edges are told apart
_BLOCK = (0.04, 0.04, 0.01)  # m, a box on which they are found, narrower where the contact ends at its edges
_ROOMY = 3.0  # of a sensor's width, that such a box is at least
_SHEET = 5e-4  # m, thickness of another
THIN = 0.5
"""Of the sensor's width, a box's depth from which on opposite fingertips do not shape each other's patterns."""
_MARGIN = 0.08  # of the sensor's width, between a contact and the near edge of others
_GAPS, _BETWEEN = (0.0, 0.05, 0.15, 0.4, 1.0), (0.01, 0.09, 0.25, 0.6)
"""Of the sensor's width: from a contact to the face's end as `alike` has it; and where it goes from one to the next."""
_COVERED = 1 / 9  # of the sensor's width, steps of how much of it is covered
_OPPOSITE_STEP = 0.02  # of the sensor's width, steps of an opposite contact's edges beyond this one's
_STEPS_OF_DEPTH = 5  # a decade, of depths up to the sensor's width
_PROPERTIES = 2  # a decade, of conductivities and heat capacities
_OPPOSITE = np.array([5, 4])  # faces
_MATERIALS = ((237.0, 2.42e6), (16.2, 4.0e6), (1.0, 2.1e6), (0.15, 1.02e6))  # W/(m K), J/(m3 K)


class Footprint(NamedTuple):
    """What a fingertip touches of a face. covered: of its element's face, from that one's corner. centre, half: m along
    the touched face's sides from its corner, the same rectangle's middle and half widths."""

    covered: Rectangle
    centre: tuple[float, float]
    half: tuple[float, float]


class Spot(NamedTuple):
    """Where a fingertip touches a box. conductivity: W/(m K) and heat_capacity: J/(m3 K) of it. sides: m of the face,
    whichever it is, and depth: m of the box behind it. opposite: what such a fingertip touches of the face behind, from
    the same corner; None for nothing."""

    conductivity: float
    heat_capacity: float
    sides: tuple[float, float]
    depth: float
    contact: Footprint
    opposite: Footprint | None = None

    def alike(self, width: float) -> Spot:
        """One of few whose patterns serve this one as well, for a sensor of that width, m: what is near is nearly as
        near, the box as deep, the material as good a conductor, and as much of the sensor's face is covered; exactly as
        much where something touches a thin box from behind."""
        conductivity, heat_capacity, sides, depth, contact, opposite = self
        thin = depth < THIN * width
        exact = thin and opposite is not None
        along = []
        for side, middle, half, part in zip(
            sides, contact.centre, contact.half, contact.covered, strict=True
        ):
            low = width * _GAPS[bisect(_BETWEEN, (middle - half) / width)]
            high = width * _GAPS[bisect(_BETWEEN, (side - middle - half) / width)]
            if not exact:
                part = _nearly_covered(part, width)
                half = (part[1] - part[0]) / 2
            along.append((part, low + half, half, low + high + 2 * half))
        (part_x, x, half_x, first), (part_y, y, half_y, second) = along
        near = Footprint((part_x, part_y), (x, y), (half_x, half_y))
        return Spot(
            _rounded(conductivity, _PROPERTIES),
            _rounded(heat_capacity, _PROPERTIES),
            (first, second),
            _rounded(depth if depth < width else width, _STEPS_OF_DEPTH),
            near,
            self._behind(near, (first, second), width) if exact else None,
        )

    def _behind(self, contact: Footprint, sides: Sequence[float], width: float) -> Footprint | None:
        """The opposite one in steps from this one, which has moved."""
        if self.opposite is None:
            return None
        step, found = _OPPOSITE_STEP * width, []
        for axis, side in enumerate(sides):
            ends = []
            for sign in (-1, 1):
                off = sign * (self.opposite.half[axis] - self.contact.half[axis])
                off += self.opposite.centre[axis] - self.contact.centre[axis]
                end = contact.centre[axis] + sign * contact.half[axis] + step * round(off / step)
                ends.append(min(max(end, 0.0), side))
            low, high = ends[0], min(ends[1], ends[0] + width)
            if high - low < step:
                return None
            begun = step * round(self.opposite.covered[axis][0] / step)
            begun = min(max(begun, 0.0), width - (high - low))
            found.append(((begun, begun + high - low), (low + high) / 2, (high - low) / 2))
        (first, x, half_x), (second, y, half_y) = found
        return Footprint((first, second), (x, y), (half_x, half_y))


def _nearly_covered(part: tuple[float, float], width: float) -> tuple[float, float]:
    """As much of a side of the sensor's face in steps, from where it begins or to where it ends, or in half such steps
    from there."""
    low, high = part
    step = width * _COVERED
    length = round((high - low) / step) * step
    if not step <= length < width:
        length = step if length < width else width
    if low <= 0:
        return 0.0, length
    if high >= width:
        return width - length, width
    begun = step / 2 * round((low + high - length) / step)
    begun = min(max(begun, 0.0), width - length)  # a little longer, it could end beyond the face
    return begun, begun + length


def _rounded(value: float, steps: int) -> float:
    """On the nearest of so many steps a decade."""
    return 10.0 ** (round(steps * math.log10(value)) / steps)


def touch_patterns(
    box: np.ndarray,
    elements: Sequence[np.ndarray],
    areas: np.ndarray,
    kept: int,
    shared: bool,
) -> list[np.ndarray]:
    """(P, M) of each of the contacts: orthonormal combinations of the patterns, the even one first. box: (S, N P, N P)
    K/W of it and elements: (S, P, P) K/W of each, at MOMENTS. areas: (N,) m2. shared: the same ones for all."""
    known, count = len(GRAM), len(elements)
    flows_of: list[list[np.ndarray]] = [[] for _ in elements]
    for n, (across, area) in enumerate(zip(elements, areas, strict=True)):
        pattern_rows = slice(n * known, (n + 1) * known)
        flows_of[n] += _flows(box[SHOWN, pattern_rows, pattern_rows] + across[SHOWN], area)
    if count > 1:
        for conductance in CONDUCTANCES:
            both = box[SHOWN].copy()
            for n, (across, area) in enumerate(zip(elements, areas, strict=True)):
                pattern_rows = slice(n * known, (n + 1) * known)
                both[:, pattern_rows, pattern_rows] += across[SHOWN] + GRAM / (conductance * area)
            flow = np.linalg.solve(both, np.tile(GRAM[0], count)[:, None])[..., 0]
            for n in range(count):
                flows_of[n].append(flow[:, n * known : (n + 1) * known])
    if shared:
        return [_leading(np.concatenate([each for flows in flows_of for each in flows]), kept)] * count
    return [_leading(np.concatenate(flows), kept) for flows in flows_of]


def _flows(both: np.ndarray, area: float) -> list[np.ndarray]:
    """(S, P) of each of CONDUCTANCES, through a contact between bodies that together have (S, P, P) K/W."""
    return [np.linalg.solve(both + GRAM / (h * area), GRAM[0][:, None])[..., 0] for h in CONDUCTANCES]


def _leading(flows: np.ndarray, kept: int) -> np.ndarray:
    """(P, M) that say most of flows (n, P), whatever their size."""
    shown = flows @ EVENNESS
    shown /= np.linalg.norm(shown, axis=1, keepdims=True)
    # the first coefficient is the even pattern's; without it, no combination has any of it, however even the flows are
    uneven = shown[:, 1:]
    others = np.linalg.eigh(uneven.T @ uneven)[1][:, ::-1][:, : kept - 1]
    # from one place to the next they keep their signs, and states on them their meaning
    others *= np.where(others.sum(axis=0) < 0, -1.0, 1.0)
    chosen = np.zeros((len(EVENNESS), kept))
    chosen[0, 0], chosen[1:, 1:] = 1.0, others
    return np.linalg.solve(EVENNESS.T, chosen)


def contact_patterns(stack: SensorStack, covered: Rectangle, kept: int) -> np.ndarray:
    """(P, M) orthonormal combinations of the patterns, the even one first, for any place. covered: of the element's
    face, from its corner."""
    steps = []
    for low, high in covered:
        first = round(low / stack.width * STEPS)
        last = max(round(high / stack.width * STEPS), first + 1)
        shift = max(last - STEPS, 0)
        steps.append((first - shift, last - shift))
    return _patterns(element(stack), (steps[0], steps[1]), kept)


@lru_cache(maxsize=1024)
def spot_patterns(known: Element, spot: Spot, kept: int) -> np.ndarray:
    """(P, M) orthonormal combinations of the patterns, the even one first, of that place on that box. In a thin sheet
    they end where the opposite fingertip does."""
    made, contact = (spot.conductivity, spot.heat_capacity), spot.contact
    if spot.opposite is None or spot.depth >= THIN * known.stack.width:
        face = Face(spot.sides, spot.depth, contact.centre, contact.half)
        return excited_alone(face, *made, shown_element(known, contact.covered), kept)
    # one order for both of them, so that they are found together
    pair = min(contact, spot.opposite), max(contact, spot.opposite)
    return _patterns_of_both(known, made, (*spot.sides, spot.depth), pair, kept)[pair.index(contact)]


@lru_cache(maxsize=256)
def _patterns_of_both(
    known: Element,
    made: tuple[float, float],
    size: tuple[float, float, float],
    touched: tuple[Footprint, Footprint],
    kept: int,
) -> np.ndarray:
    """Of two on opposite faces. made: W/(m K) and J/(m3 K)."""
    centre, half = np.array([each.centre for each in touched]), np.array([each.half for each in touched])
    patches = Patches(_OPPOSITE, centre, half)
    elements = np.array([shown_element(known, each.covered) for each in touched])
    return excited(shown_box(size, *made, patches), elements, patches.areas, kept)


@lru_cache(maxsize=4096)
def _patterns(known: Element, steps: tuple[tuple[int, int], tuple[int, int]], kept: int) -> np.ndarray:
    width = known.stack.width
    half = np.array([(last - first) / STEPS * width / 2 for first, last in steps])
    (x0, x1), (y0, y1) = (((first / STEPS) * width, (last / STEPS) * width) for first, last in steps)
    across = shown_element(known, ((x0, x1), (y0, y1)))
    area = float(4 * half[0] * half[1])
    wide, (*sides, deep) = _ROOMY * width, _BLOCK
    size, middle = [*(max(side, wide) for side in sides), deep], np.zeros(2)
    for axis, (first, last) in enumerate(steps):
        ends = first > 0, last < STEPS
        if all(ends):
            size[axis] = 2 * half[axis]
        middle[axis] = size[axis] / 2
        if ends[0] != ends[1]:
            middle[axis] = half[axis] if ends[0] else size[axis] - half[axis]
    places = [(size[2], middle), (_SHEET, middle)]
    for axis in range(2):
        near = half[axis] + _MARGIN * width
        if 2 * near < size[axis]:
            for end in {near, size[axis] - near} if middle[axis] == size[axis] / 2 else ():
                moved = middle.copy()
                moved[axis] = end
                places.append((size[2], moved))
    flows = []
    for conductivity, heat_capacity in _MATERIALS:
        for thickness, centre in places:
            patch = Patches(np.array([5]), centre[None], half[None])
            box = shown_box((size[0], size[1], thickness), conductivity, heat_capacity, patch)
            flows += _flows(across + box, area)
    found = _leading(np.concatenate(flows), kept)
    found.setflags(write=False)
    return found
