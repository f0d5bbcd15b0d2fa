"""A homogeneous box seen through patches anywhere on its six faces: its impedance between the patches' patterns.

The box starts uniform; its faces are adiabatic or lose heat through one film to air at that temperature. Its heat
kernel is a product of three one-dimensional ones (axis.py), taken at TIMES and transformed to MOMENTS (samples.py). The
slowest eigenfunction, an adiabatic box's uniform temperature, is a state of its own and left out of the samples.

N: patches, P: patterns of each (patterns.py), T: times, S: moments.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from thermograsp.compiled import njit

from .axis import (
    MODES,
    SWITCH,
    add_images,
    add_projected,
    ends_reached,
    free_kernels,
    images,
    left_inside,
    overlaps,
    wave_numbers,
)
from .patterns import ALONG, GRAM, JUMPS, NODES, along_axes
from .samples import MOMENTS, TIMES, TO_MOMENTS, TO_SLOPES, before

_FADED = 1e-12  # of an eigenfunction, from which on it counts for nothing
_UNREACHED = 160.0  # squared distance over diffusion length squared: exp(-40)


class Patches(NamedTuple):
    """face: (N,) 2 axis + side, side 0 at the coordinate's 0 and 1 at the far end. centre, half: (N, 2) m along the
    other two axes in their order, from the box's corner: middle and half width of each rectangle."""

    face: np.ndarray
    centre: np.ndarray
    half: np.ndarray

    @property
    def areas(self) -> np.ndarray:
        """(N,) m2."""
        return 4 * self.half[:, 0] * self.half[:, 1]


_STEP = np.array([[-1.0, 1.0]])  # how an even function jumps, at its ends


class BoxSamples(NamedTuple):
    """impedance: (S, N P, N P) K/W between patterns of unit heat flow, less the slowest eigenfunction's part, and slope
    of it by the moment. rate: 1/s of that and port: (N P,) sqrt(K/J) of it at each pattern; held: sqrt(J K) of heat in
    it. heat: (S, N P) J/W of heat in the box, likewise without it; None where no film takes any (held holds it all)."""

    impedance: np.ndarray
    slope: np.ndarray
    rate: float
    port: np.ndarray
    held: float
    heat: np.ndarray | None

    def whole(self) -> np.ndarray:
        """(S, N P, N P) K/W with the slowest."""
        return self.impedance + np.outer(self.port, self.port) / (MOMENTS[:, None, None] + self.rate)


def box_samples(
    size: tuple[float, float, float],
    conductivity: float,
    heat_capacity: float,
    film: float,
    patches: Patches,
    bases: Sequence[np.ndarray] | None = None,
    even: Sequence[bool] | np.ndarray | None = None,
) -> BoxSamples:
    """size: m. conductivity: W/(m K). heat_capacity: J/(m3 K). film: W/(m2 K), 0 for adiabatic faces. bases: (P, M) of
    each patch, the orthonormal combinations of patterns to tell instead of all P, the even pattern first. even: (N,) of
    which patches that one alone is told, as one port.

    The film covers the patches too: what lies under a fingertip loses no heat to the air, see `shielded`."""
    if bases is None:
        gram = GRAM
        jumps, terms = np.tile(JUMPS, (len(patches.face), 2, 1, 1)), ALONG[:, None]
    else:
        gram = np.eye(bases[0].shape[1])
        jumps, terms = along_axes(bases)
    known = box_kernel(
        *(size, conductivity, heat_capacity, film, patches),
        *(jumps, terms, len(patches.face), TIMES),
        even=even,
    )
    kernel, rate, port, held, whole = known
    diffusivity = conductivity / heat_capacity
    impedance = np.tensordot(TO_MOMENTS, kernel, axes=1)
    slope = np.tensordot(TO_SLOPES, kernel, axes=1)
    early = before(diffusivity) / heat_capacity
    first = 0
    for n, area in enumerate(patches.areas.tolist()):
        told = 1 if even is not None and even[n] else len(gram)
        block = slice(first, first + told)
        impedance[:, block, block] += early / area * gram[:told, :told]
        first += told
    if whole is None:
        return BoxSamples(impedance, slope, rate, port, held, None)
    return BoxSamples(impedance, slope, rate, port, held, TO_MOMENTS @ whole)


def box_kernel(
    size: tuple[float, float, float],
    conductivity: float,
    heat_capacity: float,
    film: float,
    patches: Patches,
    jumps: np.ndarray,
    terms: np.ndarray,
    wanted: int,
    times: np.ndarray,
    first: int = 0,
    free: np.ndarray | None = None,
    even: Sequence[bool] | np.ndarray | None = None,
) -> tuple[np.ndarray, float, np.ndarray, float, np.ndarray | None]:
    """Kernel (T, wanted P, L P) K/J at times (T,) s, ascending, of the temperatures of the first `wanted` patches by
    the L from number `first` on, less the slowest eigenfunction's part; rate, port and held as in BoxSamples; kernel
    (T, L P) of the heat in the box, likewise without it, None where no film takes any. jumps, terms: along_axes's.
    first: 0, or wanted where these are known. free: free_kernels's of these patches
    at the times up to SWITCH, or more, where they are known. even: (N,) patches of which the first pattern alone is
    told, which is even; None for none of them."""
    diffusivity, alone = conductivity / heat_capacity, np.zeros(len(patches.face), bool)
    if even is not None:
        alone[:] = even
    if free is None:
        taus = diffusivity * times
        early = taus[taus <= SWITCH * max(size) ** 2]
        free = _free(patches.half[: 0 if first else None], jumps, alone, early)
    kernel, slowest, port, held, whole = _kernel(
        np.asarray(size, float),
        film / conductivity,
        heat_capacity,
        diffusivity * times,
        np.asarray(patches.face),
        patches.centre,
        patches.half,
        alone,
        NODES,
        jumps,
        free,
        terms,
        wanted,
        first,
    )
    return kernel, float(slowest * diffusivity), port, float(held), whole if film > 0 else None


def _free(half: np.ndarray, jumps: np.ndarray, even: np.ndarray, taus: np.ndarray) -> np.ndarray:
    """free_kernels of patches of which few differ, in half widths (N, 2) m and jumps. even: (N,), those whose first
    function is told."""
    found = np.zeros((len(half), 2, jumps.shape[2], jumps.shape[2], len(taus)))
    for alone in (False, True):
        same: dict[bytes, list[int]] = {}
        for n in np.flatnonzero(even[: len(half)] == alone).tolist():
            same.setdefault(half[n].tobytes() + (b"" if alone else jumps[n].tobytes()), []).append(n)
        firsts = [numbers[0] for numbers in same.values()]
        if not firsts:
            continue
        told = free_kernels(
            half[firsts],
            np.tile(_STEP, (len(firsts), 2, 1, 1)) if alone else jumps[firsts],
            NODES[[0, -1]] if alone else NODES,
            taus,
        )
        for numbers, each in zip(same.values(), told, strict=True):
            found[numbers, :, : each.shape[1], : each.shape[2]] = each
    return found


@njit(cache=True, error_model="numpy")
def _kernel(*told):
    return compiled_kernel(*told)


@njit(cache=True, inner=True, error_model="numpy")
def compiled_kernel(
    size, film, heat_capacity, taus, face, centre, half, even, nodes, jumps, free, terms, wanted, start
):
    """What box_kernel tells, but of the slowest eigenfunction its squared wave number 1/m2, and kernel (T, L P) of the
    heat in the box whatever the film. film: 1/m, see wave_numbers. taus: (T,) m2, diffusivity times times. even: (N,)
    bool, patches of one port. jumps: (N, 2, F, E) of the functions along a patch's axes, of which the first is even.
    terms: (P, X, 2), a pattern is the sum of X products of one function along either axis, -1 for none."""
    count, functions, patterns = len(face), jumps.shape[2], len(terms)
    # an even function jumps at the ends alone
    functions_of, ports = np.empty(count, np.int64), np.zeros(count + 1, np.int64)
    for n in range(count):
        functions_of[n] = 1 if even[n] else functions
        ports[n + 1] = ports[n] + (1 if even[n] else patterns)
    total = ports[count]
    slowest, held = 0.0, 1.0
    places = np.empty((count, len(nodes)))
    ends, step, inside = np.empty(2), np.array([[-1.0, 1.0]]), np.empty((1, MODES))
    point = np.ones((1, 1))
    overlap = np.zeros((3, count, functions, MODES))
    # of eigenfunctions at times, and from which time on they count for nothing
    room, fading, faded = np.empty(MODES), np.empty((MODES, len(taus))), np.empty(MODES, np.int64)
    table = np.empty((len(nodes), len(nodes)))
    half_done = np.empty(len(nodes))
    between = np.zeros((3, count, functions, count, functions, len(taus)))
    everywhere = np.ones((3, count, functions, len(taus)))
    # by axis: whether it lies in a patch, and which of the patch's two it is
    orders, which = np.ones((3, count), np.int64), np.zeros((3, count), np.int64)
    # the first patch whose functions are the same, and the first that is the same by itself
    alike, evenly = np.empty(count, np.int64), np.empty(count, np.int64)
    for axis in range(3):
        length = size[axis]
        waves = wave_numbers(length, film)
        begun, seen = 0, 1  # the first time that eigenfunctions serve, and how many are left by then
        while begun < len(taus) and taus[begun] <= SWITCH * length * length:
            begun += 1
        while begun < len(taus) and seen < MODES and _fading(waves[seen], taus[begun]) >= _FADED:
            seen += 1
        waves = waves[:seen]
        for w in range(seen):
            faded[w] = begun
            while faded[w] < len(taus):
                fading[w, faded[w]] = _fading(waves[w], taus[faded[w]])
                if fading[w, faded[w]] < _FADED:
                    break
                faded[w] += 1
        slowest += waves[0] ** 2
        ends[0], ends[1] = 0.0, length
        overlaps(ends, step, 1, length, waves, room, inside)
        held *= inside[0, 0]
        order = orders[axis]
        for n in range(count):
            alike[n] = n
            facing = face[n] // 2
            if facing == axis:
                order[n], evenly[n] = 0, n
                for m in range(n - 1, (start if n >= start else 0) - 1, -1):
                    if face[m] == face[n]:
                        alike[n] = m
                    if face[m] // 2 == axis:
                        evenly[n] = m  # by itself it is as one at the other end
                places[n, 0] = length * (face[n] % 2)
                overlaps(places[n, :1], point, 0, length, waves, room, overlap[axis, n])
                continue
            w = axis if axis < facing else axis - 1
            which[axis, n] = w
            if even[n]:
                places[n, 0] = centre[n, w] + half[n, w] * nodes[0]
                places[n, 1] = centre[n, w] + half[n, w] * nodes[-1]
            for k in range(0 if even[n] else len(nodes)):
                places[n, k] = centre[n, w] + half[n, w] * nodes[k]
            for m in range(start if n >= start else 0, n):
                if order[m] == 1 and even[m] == even[n] and alike[n] == n:
                    same = True
                    for k in range(2 if even[n] else len(nodes)):
                        same &= places[n, k] == places[m, k]
                        for f in range(0 if even[n] else functions):
                            same &= jumps[n, w, f, k] == jumps[m, which[axis, m], f, k]
                    if same:
                        alike[n] = m
            evenly[n] = alike[n]
            if alike[n] == n:
                a, by = _along(places[n], jumps[n, w], True, even[n], step, point)
                overlaps(a, by, 1, length, waves, room, overlap[axis, n])
                continue
            for f in range(functions_of[n]):
                for m in range(seen):
                    overlap[axis, n, f, m] = overlap[axis, alike[n], f, m]
        for n in range(start, count):
            across = order[n] == 1
            axis_functions = functions_of[n] if across else 1
            a, by = _along(places[n], jumps[n, which[axis, n]], across, even[n], step, point)
            for m in range(min(n + 1, wanted)):
                others = functions_of[m] if order[m] == 1 else 1
                b, beside = _along(places[m], jumps[m, which[axis, m]], order[m] == 1, even[m], step, point)
                first, last = _first_reached(size, face, n, m, taus), len(taus)
                one, other = (evenly[n], evenly[n]) if n == m else (alike[n], alike[m])
                if one < n or other < m:
                    # opposite fingertips often differ along one axis only
                    last = max(_first_reached(size, face, one, other, taus), first)
                for t in range(first, min(begun, last)):
                    if n == m and across:
                        for f in range(axis_functions):
                            for g in range(f + 1):
                                between[axis, n, f, m, g, t] = free[n, which[axis, n], f, g, t]
                        low_end, high_end = ends_reached(a, b, length, taus[t])
                        if not low_end and not high_end:
                            continue
                        for k in range(len(a)):
                            for q in range(len(b)):
                                table[k, q] = 0.0
                        add_images(a, 1, b, 1, True, length, film, taus[t], table)
                    else:
                        images(a, order[n], b, order[m], n == m, length, film, taus[t], table)
                    add_projected(by, table, beside, n == m, half_done[: len(b)], between[axis, n, :, m], t)
                for f in range(axis_functions):
                    for g in range(f + 1 if n == m else others):
                        along = between[axis, n, f, m, g]
                        for w in range(seen if last > begun else 0):
                            both = overlap[axis, n, f, w] * overlap[axis, m, g, w]
                            for t in range(max(begun, first), min(faded[w], last)):
                                along[t] += both * fading[w, t]
                        if last == len(taus):
                            continue
                        if other <= one:
                            known = between[axis, one, f, other, g]
                        else:
                            known = between[axis, other, g, one, f]
                        for t in range(last, len(taus)):
                            along[t] = known[t]
                for f in range(axis_functions if n == m else 0):
                    for g in range(f):
                        for t in range(len(taus)):
                            between[axis, n, g, n, f, t] = between[axis, n, f, n, g, t]
            for f in range(axis_functions if film > 0.0 else 0):
                along = everywhere[axis, n, f]
                if evenly[n] < n:
                    for t in range(len(taus)):
                        along[t] = everywhere[axis, evenly[n], f, t]
                    continue
                for t in range(len(taus)):
                    along[t] = 0.0
                for w in range(seen):
                    both = overlap[axis, n, f, w] * inside[0, w]
                    for t in range(begun, faded[w]):
                        along[t] += both * fading[w, t]
            for t in range(begun if film > 0.0 and evenly[n] == n else 0):
                if across:
                    left_inside(a, length, film, taus[t], half_done)
                    for f in range(axis_functions):
                        for k in range(len(a)):
                            everywhere[axis, n, f, t] += by[f, k] * half_done[k]
                    continue
                images(a, order[n], ends, 1, False, length, film, taus[t], table)
                everywhere[axis, n, 0, t] = table[0, 1] - table[0, 0]
    rows, columns, skipped = ports[wanted], total - ports[start], ports[start]
    kernel, whole, port = (
        np.zeros((len(taus), rows, columns)),
        np.zeros((len(taus), columns)),
        np.zeros(total),
    )
    # from integrals over patterns to means, and without the slowest eigenfunction, which is even where no film is
    slowest = slowest if film > 0.0 else 0.0
    held *= np.sqrt(heat_capacity)
    areas, left, sums = np.empty(count), np.empty(len(taus)), np.empty(len(taus))
    for t in range(len(taus)):
        left[t] = np.exp(-slowest * taus[t])
    for n in range(count):
        areas[n] = 4 * half[n, 0] * half[n, 1]
        for i in range(ports[n + 1] - ports[n]):
            at = ports[n] + i
            for x in range(terms.shape[1]):
                if terms[i, x, 0] < 0:
                    continue
                f0, f1, f2 = _functions(terms[i, x], orders, which, n)
                port[at] += overlap[0, n, f0, 0] * overlap[1, n, f1, 0] * overlap[2, n, f2, 0]
                if n < start or film == 0.0:
                    continue
                for t in range(len(taus)):
                    air = everywhere[0, n, f0, t] * everywhere[1, n, f1, t]
                    whole[t, at - skipped] += air * everywhere[2, n, f2, t]
            port[at] /= areas[n] * np.sqrt(heat_capacity)
            for t in range(len(taus) if n >= start else 0):
                whole[t, at - skipped] = whole[t, at - skipped] / areas[n] - left[t] * port[at] * held
            for m in range(min(n + 1, wanted) if n >= start else 0):
                scale = 1 / (areas[n] * areas[m] * heat_capacity)
                for j in range(ports[m + 1] - ports[m] if m < n else i + 1):
                    for t in range(len(taus)):
                        sums[t] = 0.0
                    for x in range(terms.shape[1]):
                        for y in range(terms.shape[1]):
                            if terms[i, x, 0] < 0 or terms[j, y, 0] < 0:
                                continue
                            f0, f1, f2 = _functions(terms[i, x], orders, which, n)
                            g0, g1, g2 = _functions(terms[j, y], orders, which, m)
                            first, second = between[0, n, f0, m, g0], between[1, n, f1, m, g1]
                            third = between[2, n, f2, m, g2]
                            for t in range(len(taus)):
                                sums[t] += first[t] * second[t] * third[t]
                    other = ports[m] + j
                    both = port[at] * port[other]
                    for t in range(len(taus)):
                        value = scale * sums[t] - both * left[t]
                        kernel[t, other, at - skipped] = value
                        if start == 0 and at < rows:
                            kernel[t, at, other] = value
    return kernel, slowest, port, held, whole


@njit(cache=True, inner=True, error_model="numpy")
def _along(places, jumps, across, even, step, point):
    """Where a patch's functions along an axis jump, and by how much (F, E)."""
    if not across:
        return places[:1], point
    return (places[:2], step) if even else (places, jumps)


@njit(cache=True, inner=True, error_model="numpy")
def _fading(wave, tau):
    return math.exp(-wave * wave * tau)


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _unreached(size, face, n, m, tau):
    """Whether patches n and m are on opposite faces, whose heat has not reached the other by then, to round-off."""
    axis = face[n] // 2
    return face[m] // 2 == axis and face[m] != face[n] and size[axis] * size[axis] > _UNREACHED * tau


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _first_reached(size, face, n, m, taus):
    """The number of the first time at which it has; len(taus) for never."""
    first = 0
    while first < len(taus) and _unreached(size, face, n, m, taus[first]):
        first += 1
    return first


@njit(cache=True, inner=True, borrows=True, error_model="numpy")
def _functions(term, orders, which, n):
    """The number of patch n's function along each of the box's axes."""
    f0 = term[which[0, n]] if orders[0, n] == 1 else 0
    f1 = term[which[1, n]] if orders[1, n] == 1 else 0
    f2 = term[which[2, n]] if orders[2, n] == 1 else 0
    return f0, f1, f2
