"""The few patterns of flow that a contact excites: of one touch, or of any that covers so much of a sensor's face.

Those of one touch follow from what lies on its two sides, at a few moments and conductances. Those of any touch are
found once per coverage, for four materials, sheets and edges together, so that a fingertip keeps the same states
whatever it touches. That is what most of the error of fixed rates comes from: over 150 drawn overlaps of a face with a
box (12 rates, 3 patterns) 22 were more than .05 K of 12 off, at most .15; on each touch's own patterns 5, at most .06.
The judge was studies/laplace_judge.py at its coarse resolution, which is itself up to .016 K off.

P: patterns known (patterns.py), M: kept, N: contacts.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from ..matter import SensorStack
from .box import Patches, box_samples
from .element import Rectangle, element_samples
from .patterns import EVENNESS, GRAM

STEPS = 16  # places along a face's side between which a contact's edges are told apart
CONDUCTANCES = (3e3, 3e4)  # W/(m2 K)
_SHOWN = slice(6, 20, 3)  # of MOMENTS
_BLOCK = (0.04, 0.04, 0.01)  # m, a box on which they are found, narrower where the contact ends at its edges
_SHEET = 5e-4  # m, thickness of another
_MARGIN = 0.08  # of the sensor's width, between a contact and the near edge of others
_MATERIALS = ((237.0, 2.42e6), (16.2, 4.0e6), (1.0, 2.1e6), (0.15, 1.02e6))  # W/(m K), J/(m3 K)


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
    told: list[list[np.ndarray]] = [[] for _ in elements]
    for n, (across, area) in enumerate(zip(elements, areas, strict=True)):
        own = slice(n * known, (n + 1) * known)
        told[n] += _flows(box[_SHOWN, own, own] + across[_SHOWN], area)
    if count > 1:
        both = box[_SHOWN].copy()
        for n, (across, area) in enumerate(zip(elements, areas, strict=True)):
            own = slice(n * known, (n + 1) * known)
            both[:, own, own] += across[_SHOWN] + GRAM / (max(CONDUCTANCES) * area)
        flow = np.linalg.solve(both, np.tile(GRAM[0], count)[:, None])[..., 0]
        for n in range(count):
            told[n].append(flow[:, n * known : (n + 1) * known])
    if shared:
        return [_leading(np.concatenate([each for flows in told for each in flows]), kept)] * count
    return [_leading(np.concatenate(flows), kept) for flows in told]


def _flows(both: np.ndarray, area: float) -> list[np.ndarray]:
    """(S, P) of each of CONDUCTANCES, through a contact between bodies that together have (S, P, P) K/W."""
    return [np.linalg.solve(both + GRAM / (h * area), GRAM[0][:, None])[..., 0] for h in CONDUCTANCES]


def _leading(flows: np.ndarray, kept: int) -> np.ndarray:
    """(P, M) that say most of flows (n, P), whatever their size."""
    shown = flows @ EVENNESS
    shown /= np.linalg.norm(shown, axis=1, keepdims=True)
    even = EVENNESS[0]
    shown -= np.outer(shown @ even, even)
    others = np.linalg.eigh(shown.T @ shown)[1][:, ::-1][:, : kept - 1]
    return np.linalg.solve(EVENNESS.T, np.column_stack((even, others)))


def contact_patterns(stack: SensorStack, covered: Rectangle, kept: int) -> np.ndarray:
    """(P, M) orthonormal combinations of the patterns, the even one first. covered: of the element's face, from its
    corner."""
    steps = []
    for low, high in covered:
        first = round(low / stack.width * STEPS)
        last = max(round(high / stack.width * STEPS), first + 1)
        shift = max(last - STEPS, 0)
        steps.append((first - shift, last - shift))
    return _patterns(stack, (steps[0], steps[1]), kept)


@lru_cache(maxsize=4096)
def _patterns(stack: SensorStack, steps: tuple[tuple[int, int], tuple[int, int]], kept: int) -> np.ndarray:
    width = stack.width
    half = np.array([(last - first) / STEPS * width / 2 for first, last in steps])
    (x0, x1), (y0, y1) = (((first / STEPS) * width, (last / STEPS) * width) for first, last in steps)
    across = element_samples(stack, ((x0, x1), (y0, y1))).value
    area = float(4 * half[0] * half[1])
    size, middle = list(_BLOCK), np.zeros(2)
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
            box = box_samples((size[0], size[1], thickness), conductivity, heat_capacity, 0.0, patch)
            flows += _flows((across + box.whole())[_SHOWN], area)
    found = _leading(np.concatenate(flows), kept)
    found.setflags(write=False)
    return found
