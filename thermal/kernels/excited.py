"""The patterns of flow that contacts excite, from the bodies on their sides at a few moments and conductances.

P: patterns known (patterns.py), M: kept, N: contacts, S: moments.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from thermograsp.compiled import njit
from thermograsp.lanes import LANES, put_sum

from ..numerics import dot, solve_many
from .alone import each_alone
from .axis import MODES, SWITCH
from .box import Patches, box_kernel
from .element import Element, Rectangle, along_face, face_impedance
from .patterns import ALONG, EACH_FUNCTION, EVENNESS, GRAM, JUMPS
from .samples import MOMENTS, MOST_ROUGH, ROUGH_SPACING, SHOWN, at_moments, rough_rule

CONDUCTANCES = (3e3, 3e4)  # W/(m2 K)
_CONDUCTANCES = np.array(CONDUCTANCES)
_MOMENTS = MOMENTS[SHOWN].copy()
_ORTHONORMAL = np.ascontiguousarray(np.linalg.inv(EVENNESS.T))
_GRAM, _EVENNESS = GRAM.copy(), EVENNESS.copy()  # arrays of one kind, for which code is compiled once
_STEPS = np.exp(ROUGH_SPACING * np.arange(MOST_ROUGH))
_NO_SUMS = np.zeros((MODES, 0))
_NOTHING = 40.0  # exp(-40) counts for nothing
_EACH_JUMPS, _EACH_TERM = np.tile(JUMPS, (2, 2, 1, 1)), ALONG[:, None].copy()
_AT_ONCE = 4  # steps in which a patch's kernel by itself is told for few times or many
_DOUBLED = 6  # powers of a matrix, to the 64th
_LEAST_UNEVEN = 1e-12  # beside flows of size 1, what counts as none, squared


class Face(NamedTuple):
    """A rectangle on a face of a box. sides: m of the face, and depth: m of the box behind it. centre, half: m along
    the sides, from the face's corner."""

    sides: tuple[float, float]
    depth: float
    centre: tuple[float, float]
    half: tuple[float, float]


def excited(box: np.ndarray, elements: np.ndarray, areas: np.ndarray, kept: int) -> np.ndarray:
    """(N, P, M) orthonormal combinations of the patterns, the even one first, of each of the contacts, that hold most
    of what flows. box: (S, N P, N P) K/W and elements: (N, S, P, P) K/W at SHOWN. areas: (N,) m2."""
    return _excited(box, elements, areas, _CONDUCTANCES, _GRAM, _EVENNESS, _ORTHONORMAL, kept)


def excited_alone(
    touched: Face, conductivity: float, heat_capacity: float, element: np.ndarray, kept: int
) -> np.ndarray:
    """(P, M) of one contact on a box that nothing else touches. element: (S, P, P) K/W at SHOWN."""
    seen, (half_x, half_y) = _seen_face(touched, conductivity, heat_capacity), touched.half
    known = _CONDUCTANCES, _GRAM, _EVENNESS, _ORTHONORMAL
    return _excited_alone(element, 4 * half_x * half_y, *known, kept, *seen)


@lru_cache(maxsize=1024)
def shown_element(known: Element, covered: Rectangle) -> np.ndarray:
    """(S, P, P) K/W of an element at SHOWN."""
    return face_impedance(known, covered, EACH_FUNCTION, _EACH_TERM, _GRAM, shown=True)


def _seen_face(touched: Face, conductivity: float, heat_capacity: float) -> tuple[Any, ...]:
    """What _of_face takes. What the air takes changes no pattern to speak of."""
    rule = rough_rule(conductivity / heat_capacity)
    (first, second), (x, y), (half_x, half_y) = touched.sides, touched.centre, touched.half
    return (
        _along(first, x, half_x, rule.begun),
        _along(second, y, half_y, rule.begun),
        4 * half_x * half_y,
        first * second,
        touched.depth,
        heat_capacity,
        conductivity / heat_capacity,
        _GRAM,
        ALONG,
        *rule,
        _MOMENTS,
    )


@lru_cache(maxsize=2048)
def _along(side: float, centre: float, half: float, begun: float) -> np.ndarray:
    """(F, F, T) m along a face's axis, at rough_rule's times for any material, from begun m2 on. In steps, as patterns
    are asked for, there are few of these, which boxes of all sizes and materials share."""
    return along_face(side, centre, half, begun * _STEPS, _NO_SUMS)[0]


def shown_box(
    size: tuple[float, float, float], conductivity: float, heat_capacity: float, patches: Patches
) -> np.ndarray:
    """The same (S, N P, N P) under several patches."""
    diffusivity, count = conductivity / heat_capacity, len(patches.face)
    rule = rough_rule(diffusivity)
    images = int((diffusivity * rule.times).searchsorted(SWITCH * max(size) ** 2, "right"))
    many = _AT_ONCE * (images // _AT_ONCE + 1)  # times at which these serve
    free = np.empty((count, 2, len(JUMPS), len(JUMPS), many))
    for n, half in enumerate(patches.half.tolist()):
        for axis, side in enumerate(half):
            free[n, axis] = each_alone(side, rule.begun, ROUGH_SPACING, many)
    kernel, rate, port, _, _ = box_kernel(
        size,
        conductivity,
        heat_capacity,
        0.0,
        patches,
        _EACH_JUMPS[:count],
        _EACH_TERM,
        count,
        rule.times,
        free=free,
    )
    first = 1 / (heat_capacity * math.sqrt(math.pi * rule.begun) * patches.areas)
    found, _ = at_moments(kernel, kernel[:, 0].copy(), port, first, _GRAM, rule.to_moments, rule.early)
    return found + np.outer(port, port) / (_MOMENTS[:, None, None] + rate)


@njit(cache=True, inner=True, error_model="numpy")
def _of_face(
    first,
    second,
    area,
    face,
    depth,
    heat_capacity,
    diffusivity,
    gram,
    along,
    begun,
    times,
    to_moments,
    early,
    moments,
):
    """(S, P, P) K/W of a box under one patch at SHOWN, area m2 of a face of m2. first, second: (F, F, T) m along its
    axes. along: (P, 2), as ALONG. depth: m of the box. The rest as in excited_alone and Rule."""
    known, count = len(gram), len(times)
    # of pairs of patterns; zeros fill the last lanes
    pairs = -(-known * (known + 1) // 2 // LANES) * LANES
    deep, kernel, summed = np.empty(count), np.zeros((count, pairs)), np.empty(pairs)
    slowest, found = np.empty(pairs), np.empty((len(moments), known, known))
    for t in range(count):
        # of the heat at the face that it flows into, by images of it or by eigenfunctions of the depth
        tau, n, total = diffusivity * times[t], 1, 0.0
        soon = tau < depth * depth / math.pi
        step = depth * depth / tau if soon else math.pi * math.pi * tau / (depth * depth)
        while n * n * step < _NOTHING:
            total += 2 * math.exp(-n * n * step)
            n += 1
        deep[t] = (1 + total) / (math.sqrt(math.pi * tau) if soon else depth) / (heat_capacity * area * area)
    falling, pair = 1 / (heat_capacity * math.sqrt(math.pi * begun) * area), 0
    for i in range(known):
        for j in range(i + 1):
            # all of the box as warm
            slowest[pair] = gram[0, i] * gram[0, j] / (heat_capacity * face * depth)
            one, other = first[along[i, 0], along[j, 0]], second[along[i, 1], along[j, 1]]
            for t in range(count):
                kernel[t, pair] = one[t] * other[t] * deep[t] - slowest[pair]
            pair += 1
    for s in range(len(moments)):
        for n in range(0, pairs, LANES):
            put_sum(summed, n, kernel, n, pairs, to_moments, s * count, count)
        pair = 0
        for i in range(known):
            for j in range(i + 1):
                value = early[s] * falling * gram[i, j] + slowest[pair] / moments[s]
                found[s, i, j] = found[s, j, i] = value + summed[pair]
                pair += 1
    return found


@njit(cache=True, error_model="numpy")
def _excited_alone(element, area, conductances, gram, evenness, orthonormal, kept, *face):
    """_excited of one contact of m2 on a face, which is told as to _of_face."""
    box, areas = _of_face(*face), np.empty(1)
    areas[0] = area
    elements = element.reshape(1, len(box), len(gram), len(gram))
    return _excited(box, elements, areas, conductances, gram, evenness, orthonormal, kept)[0]


@njit(cache=True, error_model="numpy")
def _excited(box, elements, areas, conductances, gram, evenness, orthonormal, kept):
    """The same. orthonormal: (P, P), from orthonormal patterns' coefficients to those of the patterns."""
    count, known = elements.shape[0], len(gram)
    cases = len(box) * len(conductances)
    flows = np.empty((count, cases * (2 if count > 1 else 1), known))
    for n in range(count):
        flow = _flows(box, elements, areas, conductances, gram, n, 1)
        for case in range(cases):
            for i in range(known):
                flows[n, case, i] = flow[i, case]
    if count > 1:
        flow = _flows(box, elements, areas, conductances, gram, 0, count)
        for case in range(cases):
            for i in range(count * known):
                flows[i // known, cases + case, i % known] = flow[i, case]
    found = np.zeros((count, known, kept))
    for n in range(count):
        _most_of(flows[n], evenness, orthonormal, found[n])
    return found


@njit(cache=True, inner=True, error_model="numpy")
def _flows(box, elements, areas, conductances, gram, first, count):
    """(n P, cases) through contacts first .. first + count - 1 together, at each moment and conductance; some cases
    more, which fill the last lanes, are like the last."""
    known, cases = len(gram), len(box) * len(conductances)
    size, lanes = count * known, -(-cases // LANES) * LANES
    both, flow = np.empty((size, size, lanes)), np.empty((size, lanes))
    for i in range(size):
        n, own = first + i // known, i % known
        for j in range(i + 1):
            other, meet = j % known, first + j // known == n
            for s in range(len(box)):
                value, shared = box[s, first * known + i, first * known + j], 0.0
                if meet:
                    value, shared = value + elements[n, s, own, other], gram[own, other] / areas[n]
                for k in range(len(conductances)):
                    both[i, j, s * len(conductances) + k] = value + shared / conductances[k]
            for c in range(cases, lanes):
                both[i, j, c] = both[i, j, cases - 1]
        for c in range(lanes):
            flow[i, c] = gram[0, own]
    solve_many(both, flow)
    return flow


@njit(cache=True, inner=True, error_model="numpy")
def _most_of(flows, evenness, orthonormal, out):
    """Fills out (P, M) with what says most of flows (n, P), whatever their size."""
    known, kept = out.shape
    shown, matrix = np.empty(known), np.zeros((known - 1, known - 1))
    power, square = np.empty((known - 1, known - 1)), np.empty((known - 1, known - 1))
    vectors = np.zeros((kept - 1, known - 1))
    for flow in flows:
        size = 0.0
        for j in range(known):
            shown[j] = 0.0
            for i in range(j, known):
                shown[j] += flow[i] * evenness[i, j]
            size += shown[j] * shown[j]
        for i in range(known - 1):
            for j in range(known - 1):
                matrix[i, j] += shown[1 + i] * shown[1 + j] / size
    # what has no uneven flow at all has some patterns all the same
    for i in range(known - 1):
        matrix[i, i] += _LEAST_UNEVEN * (1 + i)
    for m in range(kept - 1):
        _leading_vector(matrix, power, square, vectors, m)
        for i in range(known):
            for j in range(known - 1):
                out[i, 1 + m] += orthonormal[i, 1 + j] * vectors[m, j]
    out[0, 0] = 1.0


@njit(cache=True, inner=True, error_model="numpy")
def _leading_vector(matrix, power, square, vectors, m):
    """Fills vectors[m] with the leading eigenvector of a symmetric matrix, by its 2^_DOUBLED-th power, orthonormal to
    the m before, which are taken from the matrix."""
    count = len(matrix)
    for i in range(count):
        for j in range(count):
            power[i, j] = matrix[i, j]
    for _ in range(_DOUBLED):
        largest = 0.0
        for i in range(count):
            largest = max(largest, power[i, i])
        scale = 1 / (largest * largest)
        for i in range(count):
            for j in range(i + 1):
                square[i, j] = scale * dot(power[i], power[j])
        for i in range(count):
            for j in range(i + 1):
                power[i, j] = power[j, i] = square[i, j]
    best = 0
    for i in range(count):
        if power[i, i] > power[best, best]:
            best = i
    vector = vectors[m]
    for j in range(count):
        vector[j] = power[best, j]
    for _ in range(2):  # the second time from what rounding has left
        for before in range(m):
            along = 0.0
            for j in range(count):
                along += vectors[before, j] * vector[j]
            for j in range(count):
                vector[j] -= along * vectors[before, j]
        size, total = 0.0, 0.0
        for j in range(count):
            size += vector[j] * vector[j]
            total += vector[j]
        scale = (-1.0 if total < 0 else 1.0) / math.sqrt(size)
        for j in range(count):
            vector[j] *= scale
    value = 0.0
    for i in range(count):
        for j in range(count):
            value += vector[i] * matrix[i, j] * vector[j]
    for i in range(count):
        for j in range(count):
            matrix[i, j] -= value * vector[i] * vector[j]
